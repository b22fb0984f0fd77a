#pragma once

// One try of the encoder: a surface cut in one way and sampled at one resolution, written at the step that comes to a
// wanted rate or quality. Tries know nothing of each other and may run at the same time.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "libemap/coding/elevation_coder.h"
#include "libemap/coding/surface_to_encode.h"

namespace emap {

// Beyond, partitions and tries take seconds each: fewer are made, and other cuts only for large errors; beyond five
// times as many, only where the first does not lead to the rate.
constexpr std::size_t kManyPoints = 200000;

// What is wanted, and what all tries share.
struct EncodingTarget {
  double diagonal = 0;       // model units, of the stream's frame
  double most_bytes = 0;     // 0: a quality is wanted
  double largest_error = 0;  // model units; 0: a rate is wanted
  const ElevationCoder* coder = nullptr;
  BitDistribution distribution = BitDistribution::surface;
  bool may_smooth_seams = true;

  bool is_quality() const { return largest_error > 0; }
  double psnr_db(double error) const;
};

// How much a try does for cheap masks. On large models with fine maps nothing: looking for what gap filling misses
// takes longer than all the rest there, and masks are a small share of the bits.
MaskEffort mask_effort(const EncodingTarget& target, const SurfaceToEncode& surface,
                       std::uint32_t samples_per_diagonal);

struct EncodingTrial {
  std::shared_ptr<const SurfaceToEncode> surface;
  std::vector<std::uint8_t> stream;
  double step = 0;
  double error = std::numeric_limits<double>::infinity();  // model units, measured; infinite where there is no stream
  std::uint32_t samples_per_diagonal = 0;
  bool meets_target = false;
};

using SharedSurface = std::shared_ptr<const SurfaceToEncode>;

// The best that this cut and resolution allow. first_step: 0 where nothing is known yet. To a rate: the largest stream
// that fits, or nearly; to a quality: the smallest that is good enough, or nearly.
EncodingTrial try_to_meet(const EncodingTarget& target, const SharedSurface& surface,
                          std::uint32_t samples_per_diagonal, double first_step);

// Written once, at this very step, and measured by fewer samples: a quick look at how well a cut does.
EncodingTrial try_step(const EncodingTarget& target, const SharedSurface& surface, std::uint32_t samples_per_diagonal,
                       double step);

bool is_better(const EncodingTarget& target, const EncodingTrial& a, const EncodingTrial& b);

// Natural logarithm of the bytes that a try would have taken at a common quality, but for a constant: lower is better.
// For tries whose errors are nearly the same.
double cost_at_equal_quality(const EncodingTarget& target, const EncodingTrial& trial);

}  // namespace emap
