#pragma once

// The layouts of netCDF files, one .h-less .cpp each behind this interface: what the content must have to be one, how
// it is read, and which of its parts make up an output.

#include <cstdint>
#include <span>
#include <string>

#include "libthin/formats/netcdf_file.h"
#include "libthin/formats/netcdf_rewrite.h"
#include "libthin/formats/observation_file.h"

namespace thin {

class NetcdfLayout {
 public:
  virtual ~NetcdfLayout() = default;
  virtual const char* name() const = 0;  // "ioda", as ReadObservations::layout says
  virtual bool recognises(const NetcdfFile& file) const = 0;
  // How many there are, as far as a glance tells. REQUIRES: recognises(file)
  virtual std::size_t locations(const NetcdfFile& file) const = 0;
  // source.subset of an observation is its location: from 0, in the file's order.
  virtual Result<ReadObservations> read(const NetcdfFile& file, const InputOptions& options) const = 0;
  // What an output with these locations (ascending) differs in from the file: the others left out, or flagged.
  virtual Result<NetcdfEdit> subset(const NetcdfFile& file, std::span<const std::uint32_t> retained,
                                    const OutputOptions& options) const = 0;
  virtual Result<NetcdfEdit> flag(const NetcdfFile& file, std::span<const std::uint32_t> retained,
                                  const OutputOptions& options) const = 0;
};

const NetcdfLayout& ioda_layout();
const NetcdfLayout& gsi_layout();
const NetcdfLayout& feedback_layout();
const NetcdfLayout& cf_layout();

// As read_observations, from the file's bytes. Error input, for netCDF or HDF5 in none of the layouts.
Result<ReadObservations> read_netcdf(std::span<const std::uint8_t> bytes, const std::string& name,
                                     const InputOptions& options);

// As extract_observations, from the original's bytes. A subset of everything is the original, byte for byte.
Result<ExtractionSummary> extract_netcdf(std::span<const std::uint8_t> bytes, const std::string& name,
                                         std::span<const SourceReference> retained, const std::string& output_path,
                                         const OutputOptions& options);

}  // namespace thin
