#pragma once

// What all shaders know of one picture.

#include "libemap/rendering/camera.h"

namespace emap {

struct View {
  View(const Camera& camera, int width, int height);

  // Clips so many pixels beyond the picture on all sides, for a viewport as much wider: OpenGL draws no point whose
  // centre is clipped, though it may reach into the picture.
  void widen_clipping(int pixels);

  int width, height;
  Eigen::Matrix4d eye_from_model, clip_from_eye;
  Eigen::Matrix3d model_from_eye;  // the turn alone
  Eigen::Vector3d eye_in_model;    // diagonals
  // The ray through a pixel's centre (x, y) from the lower left: (x, y, 0) * scale + offset, and -1 along z.
  Eigen::Vector2d ray_scale, ray_offset;
  // Depth in the picture: x - y / distance along the view.
  Eigen::Vector2d depth_line;
  double pixels;  // a diagonal at a distance of one diagonal, pixels

  bool one_sided = false;  // splats that face away are left out
  double radius_factor = 1;
  double behind = 0;  // how far splats that blend may lie behind each other, diagonals
};

}  // namespace emap
