// simplify_mesh IN OUT.ply VERTICES: Lindstrom and Turk's edge collapse, by CGAL. The rival of
// docs/results/compression.md is this followed by Draco.

#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <cstdio>
#include <cstdlib>

#include "libemap/surface/model_file.h"

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;

SurfaceMesh manifold_mesh_of(const emap::Mesh& mesh) {
  namespace processing = CGAL::Polygon_mesh_processing;
  std::vector<Kernel::Point_3> points;
  for (const Eigen::Vector3d& p : mesh.positions) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::vector<std::size_t>> polygons;
  for (const auto& [a, b, c] : mesh.triangles) polygons.push_back({a, b, c});
  processing::repair_polygon_soup(points, polygons);
  processing::orient_polygon_soup(points, polygons);
  SurfaceMesh result;
  processing::polygon_soup_to_polygon_mesh(points, polygons, result);
  return result;
}

emap::Mesh plain_mesh_of(const SurfaceMesh& mesh) {
  emap::Mesh result;
  std::vector<std::uint32_t> number(mesh.number_of_vertices() + mesh.number_of_removed_vertices());
  for (const auto vertex : mesh.vertices()) {
    number[vertex] = static_cast<std::uint32_t>(result.positions.size());
    const Kernel::Point_3& p = mesh.point(vertex);
    result.positions.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto face : mesh.faces()) {
    std::array<std::uint32_t, 3> triangle{};
    std::size_t corner = 0;
    for (const auto vertex : vertices_around_face(mesh.halfedge(face), mesh)) triangle[corner++] = number[vertex];
    result.triangles.push_back(triangle);
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: simplify_mesh IN OUT.ply VERTICES\n", stderr);
    return 2;
  }
  const thin::Result<emap::Mesh> mesh = emap::read_mesh(argv[1]);
  if (!mesh) {
    std::fprintf(stderr, "simplify_mesh: %s\n", mesh.error().message.c_str());
    return 1;
  }
  SurfaceMesh simplified = manifold_mesh_of(*mesh);
  // A closed mesh has about three edges to a vertex.
  namespace simplification = CGAL::Surface_mesh_simplification;
  const simplification::Count_stop_predicate<SurfaceMesh> stop(3 * std::strtoul(argv[3], nullptr, 10));
  simplification::edge_collapse(simplified, stop);
  return emap::write_ply(argv[2], plain_mesh_of(simplified)) ? 0 : 1;
}
