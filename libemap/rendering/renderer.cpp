#include "libemap/rendering/renderer.h"

#include "libemap/rendering/cube_map.h"

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

void fill_face(GLenum target, const Image& image) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(target, 0, GL_RGBA8, image.width, image.height, 0, image.channels == 4 ? GL_RGBA : GL_RGB,
               GL_UNSIGNED_BYTE, image.values.data());
}

void filter_linearly(GLenum target, GLint minifying) {
  glTexParameteri(target, GL_TEXTURE_MIN_FILTER, minifying);
  glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

GlTexture environment_texture() {
  GlTexture texture = gl_texture(GL_TEXTURE_CUBE_MAP);
  const std::array<Image, 6> faces = GridCubeMap().faces();
  for (std::size_t face = 0; face < faces.size(); ++face)
    fill_face(GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face), faces[face]);
  filter_linearly(GL_TEXTURE_CUBE_MAP, GL_LINEAR);
  return texture;
}

// Squares of two greys, until a picture is given.
Image chequers() {
  constexpr int kSide = 512;
  Image image{kSide, kSide, 4, {}};
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const std::uint8_t grey = (x / 8 + y / 8) % 2 ? 230 : 120;
      image.values.insert(image.values.end(), {grey, grey, grey, 255});
    }
  return image;
}

}  // namespace

Result<std::unique_ptr<Renderer>> Renderer::create(int width, int height, bool deep) {
  Result<Frame> frame = Frame::create(width, height, deep);
  if (!frame) return frame.error();
  std::unique_ptr<Renderer> renderer(new Renderer);
  renderer->frame_.emplace(std::move(*frame));
  renderer->shaders_ = std::make_unique<ShaderSet>();
  glActiveTexture(GL_TEXTURE0 + kEnvironmentUnit);
  renderer->environment_ = environment_texture();
  renderer->nothing_ = gl_vertex_array();
  renderer->set_picture(chequers());
  glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  return renderer;
}

Result<void> Renderer::load(const MapGeometry& geometry) {
  if (geometry.strips.empty() && geometry.splats.empty())
    return Error{ErrorKind::input, "the model is empty: its maps hold no sample that could be drawn"};
  surface_ = drawn_maps(geometry);
  // A few open edges are flaws of the seams, not holes to look through.
  one_sided_ = geometry.open_edges * 1000 < geometry.edges;
  spacing_ = geometry.spacing;
  if (glGetError() != GL_NO_ERROR)
    return Error{ErrorKind::temporary, "the graphics card has no memory for the model: choose a coarser level"};
  return {};
}

Result<void> Renderer::load(const PlainGeometry& geometry) {
  if (geometry.vertices.empty() || (geometry.triangles.empty() && geometry.radii.empty()))
    return Error{ErrorKind::input, "the model is empty: it holds nothing that could be drawn"};
  surface_ = drawn_plain(geometry);
  one_sided_ = geometry.closed;
  spacing_ = geometry.spacing;
  if (glGetError() != GL_NO_ERROR) return Error{ErrorKind::temporary, "the graphics card has no memory for the model"};
  return {};
}

void Renderer::set_picture(const Image& picture) {
  glActiveTexture(GL_TEXTURE0 + kPictureUnit);
  picture_ = gl_texture(GL_TEXTURE_2D);
  fill_face(GL_TEXTURE_2D, picture);
  filter_linearly(GL_TEXTURE_2D, GL_LINEAR_MIPMAP_LINEAR);
  glGenerateMipmap(GL_TEXTURE_2D);
}

Result<void> Renderer::draw(const Camera& camera, const DrawOptions& options) {
  View view(camera, frame_->width(), frame_->height());
  view.widen_clipping(frame_->pixels_beyond());
  view.one_sided = one_sided_;
  view.radius_factor = options.radius_factor;
  view.behind = 1.5 * spacing_;
  frame_->begin();
  glActiveTexture(GL_TEXTURE0 + kEnvironmentUnit);
  glBindTexture(GL_TEXTURE_CUBE_MAP, environment_.get());
  glActiveTexture(GL_TEXTURE0 + kPictureUnit);
  glBindTexture(GL_TEXTURE_2D, picture_.get());
  const auto draw = [&](Pass pass) {
    return surface_->draw(pass, options.shading, pass == Pass::interpolated ? options.correction_rounds : 0, view,
                          *shaders_);
  };
  Result<void> drawn;
  if (options.mode == Mode::mesh)
    drawn = draw(Pass::mesh);
  else if (options.mode == Mode::splats || options.shading == Shading::patches)
    drawn = draw(Pass::splats);  // single discs do not blend
  else if (options.mode == Mode::splats_interpolated)
    drawn = options.in_one_pass ? draw(Pass::interpolated) : draw_interpolated(options, view);
  else
    drawn = draw_blended(options, view);
  // Single discs neither blend nor are interpolated, so the quarter that shows them is drawn again.
  if (drawn && options.shading == Shading::split && options.mode != Mode::mesh) drawn = draw_quarter_of_patches(view);
  glFinish();
  if (drawn && glGetError() != GL_NO_ERROR) return Error{ErrorKind::internal, "the driver refused to draw"};
  return drawn;
}

Result<void> Renderer::draw_interpolated(const DrawOptions& options, const View& view) {
  if (const Result<void> begun = frame_->begin_identities(); !begun) return begun;
  const Result<void> drawn = surface_->draw(Pass::identity, options.shading, 0, view, *shaders_);
  if (!drawn) return drawn;
  frame_->resume_with_identities();
  return surface_->draw(Pass::resolve, options.shading, options.correction_rounds, view, *shaders_);
}

Result<void> Renderer::draw_blended(const DrawOptions& options, const View& view) {
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  Result<void> drawn = surface_->draw(Pass::visibility, Shading::lighting, 0, view, *shaders_);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  if (!drawn) return drawn;
  if (const Result<void> begun = frame_->begin_sums(); !begun) return begun;
  drawn = surface_->draw(Pass::accumulation, Shading::lighting, 0, view, *shaders_);
  if (!drawn) return drawn;
  frame_->begin_resolve();
  const auto program = shaders_->use(Stage::normalisation, options.shading, 0, view);
  if (!program) return program.error();
  glBindVertexArray(nothing_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  return drawn;
}

Result<void> Renderer::draw_quarter_of_patches(const View& view) {
  frame_->resume();
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, view.width / 2, view.height / 2);
  glClearColor(1, 1, 1, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  Result<void> drawn = surface_->draw(Pass::splats, Shading::patches, 0, view, *shaders_);
  glDisable(GL_SCISSOR_TEST);
  return drawn;
}

}  // namespace emap
