#pragma once

// The .emap stream (docs/emap-format.md): header, planes, masks, elevations.

#include <cstdint>
#include <span>
#include <vector>

#include "libemap/coding/elevation_coder.h"
#include "libemap/coding/plane_coding.h"
#include "libthin/foundation/result.h"

namespace emap {

constexpr std::uint8_t kStreamVersion = 2;

struct StreamHeader {
  std::uint8_t coder = 0;
  bool from_points = false;  // what was encoded had no triangles
  StreamFrame frame;
  std::uint16_t step_code = 0;
  std::uint32_t patch_count = 0;

  // Of the elevations' quantiser, in model units: diagonal * 2^(-step_code / 64).
  double step() const;
};

// The code of the step nearest to `step`.
std::uint16_t step_code_of(double step, double diagonal);

// The frame of a surface with these bounds: its corners in single precision, rounded outwards.
StreamFrame stream_frame(const BoundingBox& box, std::uint32_t samples_per_diagonal);

// How many samples all maps together may span (columns * rows) in a stream of so many bytes: a bound on what a reader
// has to allocate. A writer adds zeros to the end of a stream of huge flat maps until it holds.
std::uint64_t most_samples_spanned(std::uint64_t stream_bytes);

// Bytes of each part, to about a byte; their sum is the stream's size.
struct StreamParts {
  std::size_t header = 0, planes = 0, masks = 0, elevations = 0;
};

struct DecodedStream {
  StreamHeader header;
  StreamParts parts;
  ElevationMaps maps;
};

// One surface, ready to be written at any step.
class StreamWriter {
 public:
  // planes: those over which `maps` were sampled; their columns and rows are set here from the maps.
  // REQUIRES: one plane for each map, the frame's spacing for all maps
  StreamWriter(const ElevationCoder& coder, const StreamFrame& frame, std::vector<CodedPlane> planes,
               ElevationMaps maps, bool from_points, BitDistribution distribution = BitDistribution::surface);
  StreamWriter(const StreamWriter&) = delete;

  std::vector<std::uint8_t> write(double step);

 private:
  const ElevationCoder& coder_;
  StreamHeader header_;
  std::vector<CodedPlane> planes_;
  ElevationMaps maps_;
  std::unique_ptr<ElevationWriter> elevations_;
};

// Errors: input (no .emap stream, another version, damaged), incomplete (cut).
thin::Result<DecodedStream> read_stream(std::span<const std::uint8_t> bytes);

// The header alone, without looking at the rest.
thin::Result<StreamHeader> read_stream_header(std::span<const std::uint8_t> bytes);

// Writes the check of all bytes of a stream to its place.
void set_stream_check(std::vector<std::uint8_t>& stream);

}  // namespace emap
