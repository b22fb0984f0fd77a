#pragma once

// The surroundings that reflections show: a cube whose faces have a colour each and a grid of black lines, so that it
// shows how well normals are reconstructed (thesis, figure 5.11).

#include <Eigen/Geometry>
#include <array>

#include "libemap/rendering/image.h"

namespace emap {

struct GridCubeMap {
  int side_pixels = 512;
  int lines = 8;             // squares along a side of a face
  double line_width = 0.06;  // of a square's side

  // Faces in OpenGL's order (+x, -x, +y, -y, +z, -z) and orientation; 3 channels.
  std::array<Image, 6> faces() const;

  // What lies in this direction, without pixels: what faces() is a picture of. Components 0 to 1.
  Eigen::Vector3d colour(const Eigen::Vector3d& direction) const;
};

}  // namespace emap
