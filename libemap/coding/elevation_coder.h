#pragma once

// The part of the stream that holds elevations can be coded in more than one way. A coder has a number in the stream, a
// name on the command line, a writer and a reader; masks and planes are the stream's own (coding/stream.h).

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "libemap/coding/range_coder.h"
#include "libemap/elevation/elevation_map.h"
#include "libthin/foundation/result.h"

namespace emap {

// How the bits are shared out among the maps (thesis, 4.2.1 and table 4.1), by coders that cut each map's code short.
enum class BitDistribution {
  even,    // as many for each sample of every map
  image,   // where they lessen the squared error of the elevations most
  surface  // where they lessen the squared distance to the surface most: elevations weighted by the maps' slopes
};

class ElevationWriter {
 public:
  virtual ~ElevationWriter() = default;

  // Writes the elevations of all maps so that they are as good, for their bits, as a uniform quantiser of this step
  // (model units) would make them. May be called again with another step; what it makes of that
  // one may depend on those before.
  virtual void write(double step, RangeEncoder& encoder) = 0;
};

struct ElevationCoder {
  std::uint8_t number;
  std::string name;
  std::string summary;
  bool leaves_finest_band_out;  // then maps may be finer for the same bits

  // The maps must outlive the writer.
  std::unique_ptr<ElevationWriter> (*writer)(const ElevationMaps& maps, BitDistribution distribution);

  // maps: with planes, sizes and masks; fills in elevations. step: as written, rounded as the header does.
  thin::Result<void> (*read)(RangeDecoder& decoder, double step, ElevationMaps& maps);
};

// All coders, the best one first.
std::span<const ElevationCoder> elevation_coders();

// nullptr where there is none of that number or name.
const ElevationCoder* find_elevation_coder(std::uint8_t number);
const ElevationCoder* find_elevation_coder(const std::string& name);

}  // namespace emap
