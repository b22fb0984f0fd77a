#include "libemap/surface/mls_surface.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "libemap/surface/point_neighbours.h"
#include "libthin/foundation/kd_tree.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

constexpr std::size_t kSpacingNeighbours = 12;
constexpr double kSupport = 2.6;  // weights beyond so many h are below 0.0012: left out
constexpr int kPlaneIterations = 12;
constexpr std::size_t kLeastNeighbours = 3;
constexpr std::size_t kQuadraticNeighbours = 8;

struct Plane {
  Eigen::Vector3d origin, normal;
};

// The points around a place, with the bandwidth there.
struct Neighbourhood {
  std::vector<Eigen::Vector3d> points;
  double bandwidth = 0;

  double weight(const Eigen::Vector3d& point, const Eigen::Vector3d& origin) const {
    return std::exp(-(point - origin).squaredNorm() / (bandwidth * bandwidth));
  }
};

// n of the plane through `origin` that minimises equation 2.1; about the centroid, for the first guess.
Eigen::Vector3d best_normal(const Neighbourhood& around, const Eigen::Vector3d& origin, bool about_centroid) {
  Eigen::Vector3d centre = origin;
  if (about_centroid) {
    double total = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& point : around.points) {
      const double weight = around.weight(point, origin);
      total += weight;
      sum += weight * (point - origin);
    }
    if (total > 0) centre += sum / total;
  }
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : around.points)
    covariance += around.weight(point, origin) * (point - centre) * (point - centre).transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().col(0);
}

// Mean signed distance of the neighbours to the plane, weighted around its origin.
double mean_offset(const Neighbourhood& around, const Plane& plane) {
  double total = 0, sum = 0;
  for (const Eigen::Vector3d& point : around.points) {
    const double weight = around.weight(point, plane.origin);
    total += weight;
    sum += weight * plane.normal.dot(point - plane.origin);
  }
  return total > 0 ? sum / total : 0;
}

// Alternates along t and over n (2.2.1). Nothing where t leaves [-h/2, h/2].
std::optional<Plane> reference_plane(const Neighbourhood& around, const Eigen::Vector3d& point) {
  Plane plane{point, best_normal(around, point, true)};
  double t = 0;
  for (int iteration = 0; iteration < kPlaneIterations; ++iteration) {
    const double step = mean_offset(around, plane);
    t += step;
    if (!(std::abs(t) <= around.bandwidth / 2)) return std::nullopt;
    plane.origin = point + t * plane.normal;
    if (std::abs(step) < 1e-5 * around.bandwidth) break;
    const Eigen::Vector3d normal = best_normal(around, plane.origin, false);
    plane.normal = normal.dot(plane.normal) < 0 ? Eigen::Vector3d(-normal) : normal;
    plane.origin = point + t * plane.normal;
  }
  return plane;
}

// Equation 2.2 with g quadratic: its value and slope above the plane's origin.
MlsProjection fit_above(const Neighbourhood& around, const Plane& plane) {
  MlsProjection projection{plane.origin, plane.normal, true};
  if (around.points.size() < kQuadraticNeighbours) return projection;
  Eigen::Index least = 0;
  plane.normal.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d u = Eigen::Vector3d::Unit(least).cross(plane.normal).normalized(), v = plane.normal.cross(u);
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
  Vector6 right = Vector6::Zero();
  for (const Eigen::Vector3d& point : around.points) {
    const Eigen::Vector3d offset = (point - plane.origin) / around.bandwidth;
    const double x = u.dot(offset), y = v.dot(offset);
    const Vector6 terms = (Vector6() << 1, x, y, x * x, x * y, y * y).finished();
    const double weight = around.weight(point, plane.origin);
    matrix.selfadjointView<Eigen::Lower>().rankUpdate(terms, weight);
    right += weight * plane.normal.dot(offset) * terms;
  }
  // Points on one line or at one place determine no quadratic: the plane stands.
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(matrix);
  if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-8)) return projection;
  const Vector6 g = solver.solve(right);
  if (!g.allFinite() || std::abs(g[0]) > 1) return projection;
  projection.position = plane.origin + g[0] * around.bandwidth * plane.normal;
  projection.normal = (plane.normal - g[1] * u - g[2] * v).normalized();
  return projection;
}

}  // namespace

struct MlsSurface::Content {
  std::vector<Eigen::Vector3d> positions;
  thin::KdTree tree;
  std::vector<double> spacings;  // of each point, averaged over its neighbours
  MlsOptions options;

  double bandwidth_at(std::uint32_t nearest) const {
    return options.bandwidth > 0 ? options.bandwidth : options.bandwidth_factor * spacings[nearest];
  }

  Neighbourhood around(const Eigen::Vector3d& place, double bandwidth, std::vector<thin::Neighbour>& found) const {
    tree.radius_search({place.data(), 3}, kSupport * bandwidth, found);
    Neighbourhood result;
    result.bandwidth = bandwidth;
    result.points.reserve(found.size());
    for (const thin::Neighbour& neighbour : found) result.points.push_back(positions[neighbour.index]);
    return result;
  }

  std::optional<MlsProjection> try_project(const Eigen::Vector3d& point, double bandwidth,
                                           std::vector<thin::Neighbour>& found) const {
    if (!(bandwidth > 0)) return std::nullopt;
    const Neighbourhood neighbourhood = around(point, bandwidth, found);
    if (neighbourhood.points.size() < kLeastNeighbours) return std::nullopt;
    const std::optional<Plane> plane = reference_plane(neighbourhood, point);
    if (!plane) return std::nullopt;
    return fit_above(neighbourhood, *plane);
  }
};

MlsSurface::MlsSurface(const std::vector<Eigen::Vector3d>& positions, const MlsOptions& options)
    : content_(std::make_unique<Content>(Content{positions, tree_of(positions), {}, options})) {
  const PointNeighbours neighbours(positions, content_->tree, kSpacingNeighbours);
  content_->spacings.resize(positions.size());
  thin::parallel_ranges(positions.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (auto point = static_cast<std::uint32_t>(begin); point < end; ++point) {
      double sum = neighbours.spacing(point);
      for (const std::uint32_t neighbour : neighbours.of(point)) sum += neighbours.spacing(neighbour);
      content_->spacings[point] = sum / static_cast<double>(neighbours.of(point).size() + 1);
    }
  });
}

MlsSurface::~MlsSurface() = default;
MlsSurface::MlsSurface(MlsSurface&&) noexcept = default;

MlsSurface::Nearest MlsSurface::nearest(const Eigen::Vector3d& point) const {
  std::vector<thin::Neighbour> found;
  content_->tree.nearest({point.data(), 3}, 1, found);
  return {found[0].index, std::sqrt(found[0].distance_squared), content_->spacings[found[0].index]};
}

MlsProjection MlsSurface::project(const Eigen::Vector3d& point) const {
  std::vector<thin::Neighbour> found;
  content_->tree.nearest({point.data(), 3}, 1, found);
  const std::uint32_t nearest = found[0].index;
  const double bandwidth = content_->bandwidth_at(nearest);
  if (const auto projection = content_->try_project(point, bandwidth, found)) return *projection;
  const Eigen::Vector3d& input = content_->positions[nearest];
  MlsProjection fallback =
      content_->try_project(input, bandwidth, found).value_or(MlsProjection{input, (point - input).normalized()});
  if (!(fallback.normal.norm() > 0.5)) fallback.normal = Eigen::Vector3d::UnitZ();
  fallback.in_domain = false;
  return fallback;
}

MlsProjection MlsSurface::closest(const Eigen::Vector3d& point) const {
  MlsProjection best = project(point);
  for (int iteration = 0; iteration < 4; ++iteration) {
    const Eigen::Vector3d foot = point - best.normal.dot(point - best.position) * best.normal;
    const MlsProjection next = project(foot);
    if (!((next.position - point).squaredNorm() < (best.position - point).squaredNorm() * (1 - 1e-6))) break;
    best = next;
  }
  return best;
}

}  // namespace emap
