#pragma once

// How far two surfaces are from each other (thesis, 3.2): equations 3.1, 3.2 and the PSNR.
//
// A mesh is compared as the surface of its triangles, a point set as its MLS surface. All cores; the same result for
// any number of them.

#include <cstdint>

#include "libemap/surface/model_file.h"
#include "libthin/foundation/result.h"

namespace emap {

struct OneSidedDistance {
  double root_mean_square = 0;  // d of equation 3.1, model units
  double maximum = 0;           // among the samples
};

struct SurfaceComparison {
  double diagonal = 0;               // of the first surface's bounding box
  OneSidedDistance first_to_second;  // over samples of the first surface: what the second lacks shows here
  OneSidedDistance second_to_first;  // over samples of the second: what it has too much

  double error() const;         // E_rms of equation 3.2, model units
  double error_in_1e4() const;  // in 1e-4 diagonals, as the thesis's tables have it
  double psnr_db() const;       // 20 log10(diagonal / E_rms); infinite where the surfaces are the same
};

struct ComparisonOptions {
  std::size_t samples = 200000;  // on each mesh; of a point set every point is one
  std::uint64_t seed = 1;
};

// Errors (input): a surface without an area, or without points.
thin::Result<SurfaceComparison> compare_surfaces(const Model& first, const Model& second,
                                                 const ComparisonOptions& options = {});

}  // namespace emap
