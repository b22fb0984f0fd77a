#pragma once

// The surface that a point set stands for: the moving-least-squares surface of Levin (thesis, 2.2 and 2.2.1).

#include <memory>

#include "libemap/surface/surface.h"

namespace emap {

struct MlsOptions {
  // h of the weights exp(-s²/h²); 0: `bandwidth_factor` times the local spacing of the points.
  double bandwidth = 0;
  double bandwidth_factor = 1.1;
};

struct MlsProjection {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // of unit length, either way round
  bool in_domain = true;  // false: the point was too far away, the projection is that of its nearest input point
};

class MlsSurface {
 public:
  // Copies the positions; normals are not used. REQUIRES: at least one point, all finite
  explicit MlsSurface(const std::vector<Eigen::Vector3d>& positions, const MlsOptions& options = {});
  ~MlsSurface();
  MlsSurface(MlsSurface&&) noexcept;

  // Psi of section 2.2: the reference plane by equation 2.1, its offset t bounded to [-h/2, h/2], then a quadratic over
  // it by equation 2.2 (a plane or the point itself, where neighbours are few). Never diverges: where no plane is found
  // within the bound, the nearest input point is projected instead. Const, for many threads; some microseconds.
  MlsProjection project(const Eigen::Vector3d& point) const;

  // The point of the surface closest to `point`: projections of feet on tangent planes until they stay.
  MlsProjection closest(const Eigen::Vector3d& point) const;

  // Index of the nearest input point, its distance, and the spacing of the points around it.
  struct Nearest {
    std::uint32_t index;
    double distance, spacing;
  };
  Nearest nearest(const Eigen::Vector3d& point) const;

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace emap
