#include "libemap/surface/boundary_edges.h"

#include <gtest/gtest.h>

#include "tests/support/surfaces.h"

namespace emap {
namespace {

TEST(BoundaryEdges, ClosedSurfacesHaveNoneAndOpenOnesTheirRim) {
  EXPECT_TRUE(boundary_edges(test::sphere(8)).empty());
  EXPECT_TRUE(boundary_edges(test::torus(8)).empty());
  EXPECT_EQ(boundary_edges(test::waves(7)).size(), 4U * 7);
  EXPECT_TRUE(boundary_edges(Mesh{}).empty());
}

TEST(BoundaryEdges, RunInTheDirectionOfTheirTriangle) {
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{2, 0, 1}}};
  for (const BoundaryEdge& edge : boundary_edges(mesh)) {
    EXPECT_EQ((edge.to + 3 - edge.from) % 3, 1U);
    EXPECT_EQ(edge.opposite, 3 - edge.from - edge.to);
  }
}

TEST(BoundaryEdges, AnEdgeOfThreeTrianglesIsNone) {
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
  EXPECT_EQ(boundary_edges(mesh).size(), 6U);
  EXPECT_EQ(edge_pairs(mesh).size(), 2U);  // a chain over the three
}

TEST(BoundaryEdges, TrianglesThatRepeatAVertexAreBorne) {
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 1, 2}, {1, 1, 1}}};
  EXPECT_LE(boundary_edges(mesh).size(), 3U);
}

}  // namespace
}  // namespace emap
