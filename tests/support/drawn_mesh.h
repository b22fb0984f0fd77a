#pragma once

// A slow, obvious drawing of a mesh: every triangle at every one of its pixels, sixteen places to a pixel, nearest
// wins.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "libemap/surface/bounding_box.h"
#include "libemap/surface/surface.h"

namespace emap::test {

// The model's box centred and scaled to a diagonal of 1; the camera looks at its centre from (cos el sin az, sin el,
// cos el cos az) * distance, up being +y; 30 degrees from the lowest to the highest line of pixels.
struct View {
  double azimuth_degrees, elevation_degrees, distance;
  int width, height;
};

// Pixels row by row from the top.
struct DrawnPixel {
  double grey = 0;     // 0 black to 1, white, which is the background
  double covered = 0;  // share of the pixel
};
using DrawnPicture = std::vector<DrawnPixel>;

namespace drawing {

constexpr int kPlaces = 4;  // along each side of a pixel

struct Corner {
  double x, y;  // in places, from the upper left corner of the picture
  double depth;
  Eigen::Vector3d position, normal;
};

inline Corner seen(const Eigen::Vector3d& position, const Eigen::Vector3d& normal, const View& view) {
  const double azimuth = view.azimuth_degrees * std::numbers::pi / 180;
  const double elevation = view.elevation_degrees * std::numbers::pi / 180;
  const Eigen::Vector3d back(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                             std::cos(elevation) * std::cos(azimuth));
  const Eigen::Vector3d right = Eigen::Vector3d::UnitY().cross(back).normalized(), up = back.cross(right);
  const double depth = view.distance - position.dot(back);
  const double half_height = depth * std::tan(15 * std::numbers::pi / 180);
  const double half_width = half_height * view.width / view.height;
  return {(1 + position.dot(right) / half_width) / 2 * view.width * kPlaces,
          (1 - position.dot(up) / half_height) / 2 * view.height * kPlaces, depth, position, normal};
}

// A light at the eye on grey 0.8.
inline double shade(const Eigen::Vector3d& position, const Eigen::Vector3d& normal, const Eigen::Vector3d& eye) {
  return 0.8 * (0.15 + 0.85 * std::abs(normal.normalized().dot((eye - position).normalized())));
}

inline double turn(const Corner& a, const Corner& b, double x, double y) {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

}  // namespace drawing

// normals: one for each vertex. box: of the original surface.
inline DrawnPicture drawn_mesh(const Mesh& mesh, const std::vector<Eigen::Vector3d>& normals, const BoundingBox& box,
                               const View& view) {
  using drawing::Corner;
  const int columns = view.width * drawing::kPlaces, rows = view.height * drawing::kPlaces;
  std::vector<double> nearest(static_cast<std::size_t>(columns) * rows, std::numeric_limits<double>::infinity());
  std::vector<double> grey(nearest.size(), 1);
  const double azimuth = view.azimuth_degrees * std::numbers::pi / 180;
  const double elevation = view.elevation_degrees * std::numbers::pi / 180;
  const Eigen::Vector3d eye =
      view.distance * Eigen::Vector3d(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                      std::cos(elevation) * std::cos(azimuth));
  const Eigen::Vector3d centre = (box.minimum + box.maximum) / 2;
  for (const auto& triangle : mesh.triangles) {
    std::array<Corner, 3> corner;
    for (std::size_t i = 0; i < 3; ++i)
      corner[i] = drawing::seen((mesh.positions[triangle[i]] - centre) / box.diagonal(), normals[triangle[i]], view);
    const double area = drawing::turn(corner[0], corner[1], corner[2].x, corner[2].y);
    if (area == 0) continue;
    const auto [left, right] = std::minmax({corner[0].x, corner[1].x, corner[2].x});
    const auto [top, bottom] = std::minmax({corner[0].y, corner[1].y, corner[2].y});
    for (int row = std::max(0, static_cast<int>(top)); row <= std::min(rows - 1, static_cast<int>(bottom)); ++row)
      for (int column = std::max(0, static_cast<int>(left)); column <= std::min(columns - 1, static_cast<int>(right));
           ++column) {
        std::array<double, 3> share{};
        double inverse_depth = 0;
        for (std::size_t i = 0; i < 3; ++i) {
          share[i] = drawing::turn(corner[(i + 1) % 3], corner[(i + 2) % 3], column + 0.5, row + 0.5) / area;
          inverse_depth += share[i] / corner[i].depth;
        }
        const std::size_t place = static_cast<std::size_t>(row) * columns + column;
        const bool is_inside = share[0] >= 0 && share[1] >= 0 && share[2] >= 0;
        if (!is_inside || 1 / inverse_depth >= nearest[place]) continue;
        nearest[place] = 1 / inverse_depth;
        Eigen::Vector3d position = Eigen::Vector3d::Zero(), normal = position;
        for (std::size_t i = 0; i < 3; ++i) {
          const double true_share = share[i] / corner[i].depth / inverse_depth;
          position += true_share * corner[i].position;
          normal += true_share * corner[i].normal;
        }
        grey[place] = drawing::shade(position, normal, eye);
      }
  }
  DrawnPicture picture(static_cast<std::size_t>(view.width) * view.height);
  constexpr double kShare = 1.0 / (drawing::kPlaces * drawing::kPlaces);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const std::size_t place = static_cast<std::size_t>(row) * columns + column;
      DrawnPixel& pixel =
          picture[static_cast<std::size_t>(row / drawing::kPlaces) * view.width + column / drawing::kPlaces];
      pixel.grey += kShare * grey[place];
      pixel.covered += std::isfinite(nearest[place]) ? kShare : 0;
    }
  return picture;
}

}  // namespace emap::test
