// trace_normals IN.emap OUT.png WIDTHxHEIGHT CAMERA LEVEL: the picture that `emap render --shading normals` should
// give, by casting rays at the closed mesh of the maps.

#include <cstdio>
#include <cstdlib>

#include "libemap/coding/stream.h"
#include "libemap/elevation/gap_filling.h"
#include "libemap/rendering/level_of_detail.h"
#include "libthin/foundation/file_bytes.h"
#include "tests/support/ray_caster.h"

int main(int argc, char** argv) {
  int width = 0, height = 0;
  if (argc != 6 || std::sscanf(argv[3], "%9dx%9d", &width, &height) != 2) {
    std::fprintf(stderr, "usage: trace_normals IN.emap OUT.png WIDTHxHEIGHT CAMERA LEVEL\n");
    return 2;
  }
  const auto fail = [](const thin::Error& error) {
    std::fprintf(stderr, "trace_normals: %s\n", error.message.c_str());
    return 1;
  };
  const auto camera = emap::parse_camera(argv[4]);
  if (!camera) return fail(camera.error());
  const auto bytes = thin::read_file_bytes(argv[1]);
  if (!bytes) return fail(bytes.error());
  const auto decoded = emap::read_stream(*bytes);
  if (!decoded) return fail(decoded.error());
  const int level = std::atoi(argv[5]);
  const emap::ElevationMaps maps = emap::coarser_maps(decoded->maps, level);
  const emap::Mesh mesh = emap::closed_mesh(maps, emap::filling_at_level(level)).mesh;
  const emap::test::RayCaster caster(mesh, decoded->header.frame.box);
  const emap::View view(*camera, width, height);
  const auto written = emap::write_png(argv[2], emap::test::normals_picture(caster.trace(view), width, height));
  return written ? 0 : fail(written.error());
}
