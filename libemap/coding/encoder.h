#pragma once

// From a surface to a stream of a wanted size or quality (thesis, 4.2.1). The encoder chooses the resolution of the
// maps, the quantiser's step, and among a few partitions; what it steers by is the distance between the surface and
// what a decoder makes of the stream. The same bytes for any number of threads.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "libemap/coding/elevation_coder.h"
#include "libemap/coding/surface_to_encode.h"
#include "libthin/foundation/result.h"

namespace emap {

struct EncoderOptions {
  // At most so many bits for each point, every byte of the stream counted; or at least this PSNR. Exactly one of both.
  std::optional<double> bits_per_point;
  std::optional<double> psnr_db;

  const ElevationCoder* coder = &elevation_coders().front();
  BitDistribution distribution = BitDistribution::surface;  // of the baseline coder
  std::optional<std::uint32_t> samples_per_diagonal;        // unset: the encoder's choice
  // Whether other partitions than the surface's own may be tried: fewer patches where errors are large anyway.
  bool may_repartition = false;
  std::function<void(const std::string&)> progress;  // a line for people now and then
};

struct Encoded {
  std::vector<std::uint8_t> stream;
  double psnr_db = 0;  // of what a decoder makes of the stream, as the encoder measured it
  std::uint32_t samples_per_diagonal = 0;
  std::size_t patch_count = 0;
};

// Errors: configuration (a rate that not even planes and masks fit into, a quality that no resolution reaches); input
// (a surface without extent).
thin::Result<Encoded> encode_surface(const SurfaceToEncode& surface, const EncoderOptions& options);

}  // namespace emap
