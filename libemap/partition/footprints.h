#pragma once

// Where an element lies over a plane: the cells of a square raster whose centre lines it meets, and at which height.

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "libemap/partition/element_graph.h"
#include "libemap/surface/surface.h"

namespace emap {

struct PlaneAxes {
  Eigen::Vector3d u, v, normal;  // orthonormal, right-handed
};

// The same axes for the same normal. REQUIRES: unit length
PlaneAxes axes_around(const Eigen::Vector3d& normal);

struct Cell {
  std::int32_t u, v;
  float height;
};

struct Slopes {
  float u = 0, v = 0;  // rise of the height along the axes
};

class Footprints {
 public:
  virtual ~Footprints() = default;

  // Appends the element's cells, and returns its slopes along u and v, or nothing where it stands upright; cell (i, j)
  // is centred at ((i + 0.5) * cell_size, (j + 0.5) * cell_size) in the axes' coordinates, relative to the origin of
  // the footprints (somewhere at the model).
  virtual std::optional<Slopes> append_cells(std::uint32_t element, const PlaneAxes& axes,
                                             std::vector<Cell>& cells) const = 0;

  // The cell in which the element's centre lies, with the height of the element's plane over the cell's centre: for
  // elements that meet no centre line.
  Cell centre_cell(std::uint32_t element, const PlaneAxes& axes, const Slopes& slopes) const;

  double cell_size() const { return cell_size_; }
  // Heights of one sheet may differ by this within a cell.
  double height_tolerance() const { return height_tolerance_; }

 protected:
  Footprints(const Eigen::Vector3d& origin, double cell_size, double height_tolerance)
      : origin_(origin), cell_size_(cell_size), height_tolerance_(height_tolerance) {}

  virtual Eigen::Vector3d centre_of(std::uint32_t element) const = 0;

  Eigen::Vector3d origin_;
  double cell_size_, height_tolerance_;
};

// Triangles, exactly.
class TriangleFootprints : public Footprints {
 public:
  // The mesh must outlive the footprints.
  TriangleFootprints(const Mesh& mesh, const Eigen::Vector3d& origin, double cell_size, double height_tolerance)
      : Footprints(origin, cell_size, height_tolerance), mesh_(mesh) {}
  std::optional<Slopes> append_cells(std::uint32_t element, const PlaneAxes& axes,
                                     std::vector<Cell>& cells) const override;

 private:
  Eigen::Vector3d centre_of(std::uint32_t element) const override;

  const Mesh& mesh_;
};

// Discs of the elements' areas around their centres: for points, and for groups of triangles.
class DiscFootprints : public Footprints {
 public:
  // The graph must outlive the footprints.
  DiscFootprints(const ElementGraph& graph, const Eigen::Vector3d& origin, double cell_size, double height_tolerance)
      : Footprints(origin, cell_size, height_tolerance), graph_(graph) {}
  std::optional<Slopes> append_cells(std::uint32_t element, const PlaneAxes& axes,
                                     std::vector<Cell>& cells) const override;

 private:
  Eigen::Vector3d centre_of(std::uint32_t element) const override { return graph_.centres[element]; }

  const ElementGraph& graph_;
};

}  // namespace emap
