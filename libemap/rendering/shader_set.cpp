#include "libemap/rendering/shader_set.h"

#include <array>

namespace emap {

ShaderSet::ShaderSet() {
  std::array<float, 2> range = {1, 1};
  glGetFloatv(GL_POINT_SIZE_RANGE, range.data());
  largest_square_pixels_ = range[1];
}

thin::Result<const GlProgram*> ShaderSet::use(Stage stage, Shading shading, int rounds, const View& view) {
  const auto key = std::make_tuple(stage, shading, rounds);
  auto entry = programs_.find(key);
  if (entry == programs_.end()) {
    const ShaderSources sources = shader_sources(stage, shading, rounds);
    thin::Result<GlProgram> program = GlProgram::create(sources.vertex, sources.fragment);
    if (!program) return program.error();
    entry = programs_.emplace(key, std::move(*program)).first;
  }
  const GlProgram& program = entry->second;
  program.use();
  program.set("elevations", kElevationsUnit);
  program.set("normals", kNormalsUnit);
  program.set("rows", kRowsUnit);
  program.set("frames", kFramesUnit);
  program.set("environment", kEnvironmentUnit);
  program.set("picture", kPictureUnit);
  program.set("sums", kSumsUnit);
  program.set("depths", kDepthsUnit);
  program.set("identities", kIdentitiesUnit);
  program.set("clip_from_eye", view.clip_from_eye);
  program.set("model_from_eye", view.model_from_eye);
  program.set("eye_in_model", view.eye_in_model);
  program.set("ray_scale", view.ray_scale);
  program.set("ray_offset", view.ray_offset);
  program.set("depth_line", view.depth_line);
  program.set("picture_centre", Eigen::Vector2d(0.5 * view.width, 0.5 * view.height));
  program.set("pixels", view.pixels);
  program.set("radius_factor", view.radius_factor);
  program.set("largest_square", largest_square_pixels_);
  program.set("one_sided", view.one_sided ? 1 : 0);
  program.set("behind", view.behind);
  program.set("forward", view.behind);
  return &program;
}

}  // namespace emap
