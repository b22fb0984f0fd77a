#pragma once

// A surface on the graphics card, in one of its two forms: elevation maps, or vertices as they come.

#include <memory>

#include "libemap/rendering/map_geometry.h"
#include "libemap/rendering/plain_geometry.h"
#include "libemap/rendering/shader_set.h"

namespace emap {

enum class Pass {
  mesh,
  splats,        // discs, shaded
  interpolated,  // discs whose fragments look up their neighbours; of maps only
  identity,      // which disc is nearest; of maps only
  resolve,       // the interpolation from that, over the whole picture, and seams
  visibility,    // discs' depth alone, a little behind them
  accumulation,  // discs' normals, weighted
};

class DrawnSurface {
 public:
  virtual ~DrawnSurface() = default;
  // rounds: of the correction, for Pass::interpolated and Pass::resolve. REQUIRES: what the pass draws was loaded
  virtual thin::Result<void> draw(Pass pass, Shading shading, int rounds, const View& view, ShaderSet& shaders) = 0;
};

std::unique_ptr<DrawnSurface> drawn_maps(const MapGeometry& geometry);
std::unique_ptr<DrawnSurface> drawn_plain(const PlainGeometry& geometry);

// A colour of its own for each patch, in lively order.
Eigen::Vector3d patch_colour(std::uint32_t patch);

}  // namespace emap
