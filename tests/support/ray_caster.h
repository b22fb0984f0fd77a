#pragma once

// A picture of normals by casting a ray through every pixel's centre, with CGAL's AABB tree: what the renderer's
// pictures are held against.

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <limits>
#include <vector>

#include "libemap/rendering/image.h"
#include "libemap/rendering/smooth_normals.h"
#include "libemap/rendering/view.h"
#include "libemap/surface/bounding_box.h"
#include "libemap/surface/surface.h"

namespace emap::test {

struct TracedPixel {
  bool hit = false;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();    // of unit length: vertices' normals interpolated
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // model space, centred, in diagonals
};

class RayCaster {
 public:
  // box: of the model, centred and scaled by it.
  RayCaster(Mesh mesh, const BoundingBox& box) : mesh_(std::move(mesh)) {
    for (Eigen::Vector3d& position : mesh_.positions)
      position = (position - (box.minimum + box.maximum) / 2) / box.diagonal();
    normals_ = smooth_normals(mesh_);
    for (const auto& triangle : mesh_.triangles) {
      const auto corner = [&](std::size_t i) {
        const Eigen::Vector3d& p = mesh_.positions[triangle[i]];
        return Kernel::Point_3(p.x(), p.y(), p.z());
      };
      triangles_.emplace_back(corner(0), corner(1), corner(2));
    }
    tree_.insert(triangles_.begin(), triangles_.end());
    tree_.build();
  }

  // Rows from the top.
  std::vector<TracedPixel> trace(const View& view) const {
    std::vector<TracedPixel> pixels;
    for (int y = view.height - 1; y >= 0; --y)
      for (int x = 0; x < view.width; ++x) {
        const Eigen::Vector3d ray(view.ray_scale.x() * (x + 0.5) + view.ray_offset.x(),
                                  view.ray_scale.y() * (y + 0.5) + view.ray_offset.y(), -1);
        pixels.push_back(cast(view.eye_in_model, view.model_from_eye * ray));
      }
    return pixels;
  }

 private:
  using Kernel = CGAL::Simple_cartesian<double>;
  using Triangles = std::vector<Kernel::Triangle_3>;
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
  using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

  TracedPixel cast(const Eigen::Vector3d& eye, const Eigen::Vector3d& direction) const {
    const Kernel::Ray_3 ray(Kernel::Point_3(eye.x(), eye.y(), eye.z()),
                            Kernel::Vector_3(direction.x(), direction.y(), direction.z()));
    const auto hit = tree_.first_intersected_primitive(ray);
    if (!hit) return {};
    const auto& triangle = mesh_.triangles[static_cast<std::size_t>(*hit - triangles_.begin())];
    const Eigen::Vector3d& a = mesh_.positions[triangle[0]];
    const Eigen::Vector3d b = mesh_.positions[triangle[1]] - a, c = mesh_.positions[triangle[2]] - a;
    const Eigen::Vector3d normal = b.cross(c);
    const double along = normal.dot(a - eye) / normal.dot(direction);
    const Eigen::Vector3d position = eye + along * direction, p = position - a;
    const double weight_b = p.cross(c).dot(normal) / normal.squaredNorm();
    const double weight_c = b.cross(p).dot(normal) / normal.squaredNorm();
    const Eigen::Vector3d mean = (1 - weight_b - weight_c) * normals_[triangle[0]] + weight_b * normals_[triangle[1]] +
                                 weight_c * normals_[triangle[2]];
    return {true, mean.normalized(), position};
  }

  Mesh mesh_;
  std::vector<Eigen::Vector3d> normals_;
  Triangles triangles_;
  Tree tree_;
};

// As Shading::normals writes it.
inline DeepImage normals_picture(const std::vector<TracedPixel>& pixels, int width, int height) {
  DeepImage image{width, height, 4, {}};
  for (const TracedPixel& pixel : pixels) {
    for (int axis = 0; axis < 3; ++axis)
      image.values.push_back(
          pixel.hit ? static_cast<std::uint16_t>(std::lround(65535 * (0.5 + 0.5 * pixel.normal[axis]))) : 0);
    image.values.push_back(pixel.hit ? 65535 : 0);
  }
  return image;
}

}  // namespace emap::test
