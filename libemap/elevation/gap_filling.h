#pragma once

// Gaps between the patches of a mesh, closed by triangles between vertices that are there (thesis, 3.3.4): no vertex
// moves, no inserted triangle crosses one that exists, no edge gets a third triangle. What cannot be closed so stays
// open and is counted.

#include "libemap/elevation/elevation_map.h"
#include "libemap/surface/surface.h"

namespace emap {

struct GapFillingOptions {
  // Triangles reach over gaps of at most so many sample spacings, or sides of the edge they start from where it is
  // longer: wider holes belong to the surface.
  double reach = 6;
};

struct GapFilling {
  std::size_t edges_before = 0;  // edges with a triangle on one side only
  std::size_t edges_left = 0;
  std::size_t inserted = 0;  // triangles, at the end of the mesh's
};

// Greedily by the smallest and flattest triangle first. O(n) for the mesh, O(m log m) for its m boundary edges; the
// result depends on the mesh alone.
GapFilling fill_gaps(double spacing, Mesh& mesh, const GapFillingOptions& options = {});

struct ClosedMesh {
  Mesh mesh;
  GapFilling filling;
};

// The canonical mesh with its gaps filled.
ClosedMesh closed_mesh(const ElevationMaps& maps, const GapFillingOptions& options = {});

}  // namespace emap
