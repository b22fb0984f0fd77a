#include "libemap/rendering/cube_map.h"

#include <cmath>

namespace emap {
namespace {

const std::array<Eigen::Vector3d, 6> kFaceColours = {{{0.95, 0.55, 0.45},
                                                      {0.50, 0.80, 0.95},
                                                      {0.98, 0.98, 0.90},
                                                      {0.55, 0.50, 0.45},
                                                      {0.70, 0.90, 0.50},
                                                      {0.95, 0.80, 0.40}}};

// Direction to the place (s, t) of a face, both -1 to 1, t downwards (OpenGL 3.3, table 3.20).
Eigen::Vector3d direction_of(std::size_t face, double s, double t) {
  switch (face) {
    case 0:
      return {1, -t, -s};
    case 1:
      return {-1, -t, s};
    case 2:
      return {s, 1, t};
    case 3:
      return {s, -1, -t};
    case 4:
      return {s, -t, 1};
    default:
      return {-s, -t, -1};
  }
}

}  // namespace

Eigen::Vector3d GridCubeMap::colour(const Eigen::Vector3d& direction) const {
  Eigen::Index axis = 0;
  const double largest = direction.cwiseAbs().maxCoeff(&axis);
  const auto face = static_cast<std::size_t>(2 * axis + (direction[axis] < 0 ? 1 : 0));
  for (Eigen::Index other = 0; other < 3; ++other) {
    if (other == axis) continue;
    const double squares = 0.5 * lines * (direction[other] / largest + 1);
    if (std::abs(squares - std::round(squares)) < 0.5 * line_width) return Eigen::Vector3d::Zero();
  }
  return kFaceColours[face];
}

std::array<Image, 6> GridCubeMap::faces() const {
  std::array<Image, 6> faces;
  for (std::size_t face = 0; face < faces.size(); ++face) {
    faces[face] = {side_pixels, side_pixels, 3, {}};
    for (int y = 0; y < side_pixels; ++y)
      for (int x = 0; x < side_pixels; ++x) {
        // The mean of 4 x 4 places in the pixel: lines with soft edges.
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (int i = 0; i < 16; ++i)
          sum += colour(direction_of(face, 2 * (x + 0.125 + 0.25 * (i % 4)) / side_pixels - 1,
                                     2 * (y + 0.125 + 0.25 * (i / 4)) / side_pixels - 1));
        for (int channel = 0; channel < 3; ++channel)
          faces[face].values.push_back(static_cast<std::uint8_t>(std::lround(255 * sum[channel] / 16)));
      }
  }
  return faces;
}

}  // namespace emap
