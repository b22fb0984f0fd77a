#pragma once

// Gaps between the patches of a mesh, closed by triangles between vertices that are there (thesis, 3.3.4): no vertex
// moves, no inserted triangle crosses one that exists, no edge gets a third triangle. What cannot be closed so stays
// open and is counted.

#include <span>

#include "libemap/elevation/elevation_map.h"
#include "libemap/surface/surface.h"

namespace emap {

struct GapFillingOptions {
  // Inserted sides that join two patches are at most so many sample spacings long, or half sides of the edge that they
  // start from where that is longer (on steep slopes), which counts as four spacings at most: wider holes belong to the
  // surface.
  double reach = 2.5;
  // The same for sides within a patch: it has its own triangles wherever it is sampled without a hole.
  double reach_within = 1.6;
  // Holes that are left with at most so many edges are closed by sides of any kind up to another reach.
  std::size_t small_hole_edges = 12;
  double small_hole_reach = 4;
};

struct GapFilling {
  std::size_t edges_before = 0;  // edges with a triangle on one side only
  std::size_t edges_left = 0;
  std::size_t inserted = 0;  // triangles, at the end of the mesh's
};

// patch_of_vertex: one for each vertex, or empty where each is a patch of its own.
// Greedily by the smallest and flattest triangle first. O(n) for the mesh, O(m log m) for its m boundary edges; the
// result depends on the mesh alone.
GapFilling fill_gaps(double spacing, std::span<const std::uint32_t> patch_of_vertex, Mesh& mesh,
                     const GapFillingOptions& options = {});

struct ClosedMesh {
  Mesh mesh;
  GapFilling filling;
};

// The canonical mesh with its gaps filled.
ClosedMesh closed_mesh(const ElevationMaps& maps, const GapFillingOptions& options = {});

}  // namespace emap
