#pragma once

// Programs, compiled when they are first asked for, with what they all share set.

#include <map>
#include <tuple>

#include "libemap/rendering/gl_objects.h"
#include "libemap/rendering/shaders.h"
#include "libemap/rendering/view.h"

namespace emap {

// Texture units by what the shaders call them.
enum Unit {
  kElevationsUnit,
  kNormalsUnit,
  kRowsUnit,
  kFramesUnit,
  kEnvironmentUnit,
  kPictureUnit,
  kSumsUnit,
  kDepthsUnit,
  kIdentitiesUnit
};

class ShaderSet {
 public:
  ShaderSet();

  // In use, with the view's uniforms set; valid as long as this lives. Error (internal): what the compiler says.
  thin::Result<const GlProgram*> use(Stage stage, Shading shading, int rounds, const View& view);

 private:
  std::map<std::tuple<Stage, Shading, int>, GlProgram> programs_;
  double largest_square_pixels_ = 1;  // of a point
};

}  // namespace emap
