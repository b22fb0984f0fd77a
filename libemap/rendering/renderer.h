#pragma once

// Draws a surface in the four modes of the thesis (5.2): one renderer for every driver with OpenGL 3.3, a context of
// which must be current as long as this lives.

#include <memory>
#include <optional>
#include <string>

#include "libemap/rendering/drawn_surface.h"
#include "libemap/rendering/frame.h"

namespace emap {

enum class Mode {
  mesh,
  splats,               // discs with a normal each
  splats_blended,       // overlapping discs' normals blended: visibility, accumulation, normalisation
  splats_interpolated,  // normals interpolated between the samples around each fragment, nothing blended
};

struct DrawOptions {
  Mode mode = Mode::mesh;
  Shading shading = Shading::lighting;
  // Of splats_interpolated: how often a fragment moves to where its ray meets the plane through the samples around it.
  // 0 is the thesis's direct interpolation, 1 its correct one; a second round finds the triangle beside it.
  int correction_rounds = 2;
  // Interpolates for every disc's fragments, as the thesis does, instead of once for each pixel from the nearest disc:
  // no other picture, save where discs meet seams, but much more work where discs are as small as pixels.
  bool in_one_pass = false;
  double radius_factor = 1;  // of splats' radii
};

class Renderer {
 public:
  // deep pictures are for Shading::normals. Errors: as Frame::create().
  static thin::Result<std::unique_ptr<Renderer>> create(int width, int height, bool deep);

  // One of the two, before anything is drawn. Error (input): nothing to be seen in it; (temporary): out of memory.
  thin::Result<void> load(const MapGeometry& geometry);
  thin::Result<void> load(const PlainGeometry& geometry);

  // What Shading::texture shows; 4 channels.
  void set_picture(const Image& picture);

  // Splats that face away are left out where the surface is closed, unless said otherwise.
  void set_one_sided(bool one_sided) { one_sided_ = one_sided; }

  // Returns when the picture is done. Errors (internal): shaders that this driver refuses.
  // REQUIRES: what was loaded was made for the mode; maps for splats_interpolated
  thin::Result<void> draw(const Camera& camera, const DrawOptions& options);

  Image image() const { return frame_->image(); }
  DeepImage deep_image() const { return frame_->deep_image(); }

 private:
  Renderer() = default;
  thin::Result<void> draw_interpolated(const DrawOptions& options, const View& view);
  thin::Result<void> draw_blended(const DrawOptions& options, const View& view);
  thin::Result<void> draw_quarter_of_patches(const View& view);

  std::optional<Frame> frame_;
  std::unique_ptr<ShaderSet> shaders_;
  std::unique_ptr<DrawnSurface> surface_;
  GlTexture environment_, picture_;
  GlVertexArray nothing_;
  bool one_sided_ = false;
  double spacing_ = 0;  // diagonals
};

}  // namespace emap
