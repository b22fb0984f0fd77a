#include "libemap/coding/mask_freedom.h"

#include <array>
#include <cmath>
#include <optional>

#include "libemap/elevation/map_grid.h"
#include "libemap/surface/triangle_raster.h"

namespace emap {
namespace {

using Eigen::Vector3d;

constexpr std::int32_t kFiner = 3;  // places a sample spacing along each axis

// Whether the patch is there, at kFiner places a sample and one sample beyond the map on all sides.
class FineCover {
 public:
  FineCover(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, const ElevationPatch& patch, double spacing)
      : columns_((static_cast<std::int32_t>(patch.columns) + 2) * kFiner),
        rows_((static_cast<std::int32_t>(patch.rows) + 2) * kFiner),
        covered_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
    for (const std::uint32_t triangle : triangles) {
      std::array<Vector3d, 3> corners;
      for (std::size_t i = 0; i < 3; ++i)
        corners[i] = over_plane(patch.plane, spacing / kFiner, mesh.positions[mesh.triangles[triangle][i]]) +
                     Vector3d(kFiner, kFiner, 0);
      rasterise_triangle(corners, [&](std::int32_t column, std::int32_t row, double) {
        if (column >= 0 && row >= 0 && column < columns_ && row < rows_) covered_[place(row, column)] = 1;
      });
    }
  }

  // How far inside a sample lies, from -1 to 1 spacings: by the share of what is covered within a spacing around it,
  // which is right at a straight boundary along an axis, and takes no notice of single triangles.
  double depth(std::int32_t row, std::int32_t column) const {
    const std::int32_t r = (row + 1) * kFiner, c = (column + 1) * kFiner;
    std::int32_t count = 0;
    for (std::int32_t y = r - kFiner; y <= r + kFiner; ++y)
      for (std::int32_t x = c - kFiner; x <= c + kFiner; ++x) count += covered_[place(y, x)];
    constexpr double kWindow = (2 * kFiner + 1) * (2 * kFiner + 1);
    return 2 * count / kWindow - 1;
  }

 private:
  std::size_t place(std::int32_t row, std::int32_t column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  std::int32_t columns_, rows_;
  std::vector<std::uint8_t> covered_;
};

class FreeSamples {
 public:
  FreeSamples(const Mesh& mesh, const TriangleTree& tree, const ElevationPatch& patch, double spacing,
              const MaskFreedomOptions& options)
      : mesh_(mesh), tree_(tree), patch_(patch), spacing_(spacing), options_(options) {}

  std::vector<FreeSample> run(const FineCover& cover) const {
    std::vector<FreeSample> found;
    for (std::int32_t row = 0; row < static_cast<std::int32_t>(patch_.rows); ++row)
      for (std::int32_t column = 0; column < static_cast<std::int32_t>(patch_.columns); ++column)
        if (const std::optional<FreeSample> sample = at(cover, row, column)) found.push_back(*sample);
    return found;
  }

 private:
  std::optional<FreeSample> at(const FineCover& cover, std::int32_t row, std::int32_t column) const {
    int inside = 0;
    double sum = 0;
    visit_around(row, column, [&](std::int32_t r, std::int32_t c) {
      ++inside;
      sum += elevation_at(r, c);
    });
    const bool is_there = supports(row, column);
    if (inside == 0 || (is_there && inside == 8)) return std::nullopt;
    const double depth = cover.depth(row, column);
    if (is_there ? depth > options_.farthest_dropped : -depth > options_.farthest_added) return std::nullopt;
    const std::optional<double> elevation =
        is_there ? elevation_at(row, column) : elevation_beside(row, column, sum / inside);
    if (!elevation) return std::nullopt;

    FreeSample sample{static_cast<std::uint32_t>(row),
                      static_cast<std::uint32_t>(column),
                      *elevation,
                      foot(row, column) + *elevation * patch_.plane.normal,
                      0,
                      0};
    const double moved = options_.bits_at_half * depth * depth / 0.25;
    (depth > 0 ? sample.bits_if_absent : sample.bits_if_present) += moved;
    const double bend = bend_at(row, column, *elevation);
    (is_there ? sample.bits_if_absent : sample.bits_if_present) += options_.bits_of_bend * bend * bend;
    return sample;
  }

  bool supports(std::int32_t row, std::int32_t column) const {
    return row >= 0 && column >= 0 && row < static_cast<std::int32_t>(patch_.rows) &&
           column < static_cast<std::int32_t>(patch_.columns) && patch_.mask[place(row, column)];
  }
  double elevation_at(std::int32_t row, std::int32_t column) const { return patch_.elevation[place(row, column)]; }
  std::size_t place(std::int32_t row, std::int32_t column) const {
    return static_cast<std::size_t>(row) * patch_.columns + static_cast<std::size_t>(column);
  }
  Vector3d foot(double row, double column) const {
    return patch_.plane.origin + column * spacing_ * patch_.plane.axis_u + row * spacing_ * patch_.plane.axis_v;
  }

  // The supported ones of the eight samples around.
  template <class Visitor>
  void visit_around(std::int32_t row, std::int32_t column, const Visitor& visit) const {
    for (std::int32_t r = row - 1; r <= row + 1; ++r)
      for (std::int32_t c = column - 1; c <= column + 1; ++c)
        if ((r != row || c != column) && supports(r, c)) visit(r, c);
  }

  // Of the mesh beside the patch, near `guess`: through the planes of closest triangles, as Newton would.
  std::optional<double> elevation_beside(std::int32_t row, std::int32_t column, double guess) const {
    constexpr double kFarthest = 2, kExact = 0.02, kAside = 0.1;  // spacings
    constexpr double kSteepest = 0.1;                             // cosine
    const Vector3d& up = patch_.plane.normal;
    double elevation = guess;
    for (int round = 0; round < 4; ++round) {
      const Vector3d at = foot(row, column) + elevation * up;
      const TriangleTree::Closest closest = tree_.closest(at, std::pow(1.5 * kFarthest * spacing_, 2));
      if (closest.triangle >= mesh_.triangles.size()) return std::nullopt;
      const auto& [a, b, c] = mesh_.triangles[closest.triangle];
      const Vector3d& corner = mesh_.positions[a];
      const Vector3d normal = (mesh_.positions[b] - corner).cross(mesh_.positions[c] - corner);
      const double along = normal.dot(up);
      if (!(along > kSteepest * normal.norm())) return std::nullopt;
      const double rise = normal.dot(closest.point - at) / along;
      elevation += rise;
      if (!(std::abs(elevation - guess) < kFarthest * spacing_)) return std::nullopt;
      if (std::abs(rise) > kExact * spacing_) continue;
      const Vector3d off = closest.point - (foot(row, column) + elevation * up);
      if ((off - off.dot(up) * up).norm() > kAside * spacing_) return std::nullopt;
      return elevation;
    }
    return std::nullopt;
  }

  // How far the surface is from going straight on here, in spacings: half the distance to it from where the line from
  // the samples around, carried on beyond this one by a spacing, ends. Large at creases, and where the surface ends.
  double bend_at(std::int32_t row, std::int32_t column, double elevation) const {
    Vector3d mean = Vector3d::Zero();  // columns, rows, elevation
    int count = 0;
    visit_around(row, column, [&](std::int32_t r, std::int32_t c) {
      mean += Vector3d(c - column, r - row, elevation_at(r, c) - elevation);
      ++count;
    });
    mean /= count;
    const double length = std::hypot(mean.x(), mean.y());
    if (length < 0.05) return 0;
    const Vector3d step = -mean / length;
    const Vector3d ahead = foot(row + step.y(), column + step.x()) + (elevation + step.z()) * patch_.plane.normal;
    return std::sqrt(tree_.closest(ahead).distance_squared) / (2 * spacing_);
  }

  const Mesh& mesh_;
  const TriangleTree& tree_;
  const ElevationPatch& patch_;
  double spacing_;
  const MaskFreedomOptions& options_;
};

}  // namespace

std::vector<FreeSample> free_samples(const Mesh& mesh, const std::vector<std::uint32_t>& triangles,
                                     const TriangleTree& tree, const ElevationPatch& patch, double spacing,
                                     const MaskFreedomOptions& options) {
  return FreeSamples(mesh, tree, patch, spacing, options).run(FineCover(mesh, triangles, patch, spacing));
}

}  // namespace emap
