#include "libemap/partition/normal_cone.h"

#include <CGAL/Min_sphere_of_points_d_traits_3.h>
#include <CGAL/Min_sphere_of_spheres_d.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>

namespace emap {

NormalCone normal_cone(const std::vector<Eigen::Vector3d>& normals) {
  using Kernel = CGAL::Simple_cartesian<double>;
  using Traits = CGAL::Min_sphere_of_points_d_traits_3<Kernel, double>;
  std::vector<Kernel::Point_3> points;
  points.reserve(normals.size());
  for (const Eigen::Vector3d& normal : normals)
    if (!normal.isZero(0)) points.emplace_back(normal.x(), normal.y(), normal.z());
  NormalCone cone;
  if (points.empty()) return cone;
  CGAL::Min_sphere_of_spheres_d<Traits> ball(points.begin(), points.end());
  const auto* const centre = ball.center_cartesian_begin();
  const Eigen::Vector3d axis(centre[0], centre[1], centre[2]);
  if (axis.norm() > 1e-9) cone.axis = axis.normalized();
  for (const Eigen::Vector3d& normal : normals)
    if (!normal.isZero(0)) cone.aperture_cosine = std::min(cone.aperture_cosine, cone.axis.dot(normal));
  return cone;
}

}  // namespace emap
