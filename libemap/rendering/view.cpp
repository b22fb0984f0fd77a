#include "libemap/rendering/view.h"

#include <cmath>
#include <numbers>

namespace emap {

View::View(const Camera& camera, int width_pixels, int height_pixels) : width(width_pixels), height(height_pixels) {
  const Eigen::Isometry3d place = emap::eye_from_model(camera);
  eye_from_model = place.matrix();
  clip_from_eye = emap::clip_from_eye(camera, static_cast<double>(width) / height);
  model_from_eye = place.rotation().transpose();
  eye_in_model = place.inverse().translation();
  const double half_angle = camera.field_of_view_degrees * std::numbers::pi / 360;
  const double scale = 2 * std::tan(half_angle) / height;
  ray_scale = {scale, scale};
  ray_offset = {-0.5 * scale * width, -0.5 * scale * height};
  const auto [nearest, farthest] = depth_range(camera);
  const double range = farthest - nearest;
  depth_line = {0.5 * (farthest + nearest) / range + 0.5, farthest * nearest / range};
  pixels = 1 / scale;
}

void View::widen_clipping(int pixels_beyond) {
  clip_from_eye.row(0) *= static_cast<double>(width) / (width + 2 * pixels_beyond);
  clip_from_eye.row(1) *= static_cast<double>(height) / (height + 2 * pixels_beyond);
}

}  // namespace emap
