// emap decode: an .emap file back to a mesh or points.

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>

#include "libemap/coding/stream.h"
#include "libemap/elevation/canonical_mesh.h"
#include "libemap/elevation/gap_filling.h"
#include "libemap/surface/model_file.h"
#include "libemap/tools/commands.h"
#include "libemap/tools/emap_file.h"
#include "libemap/tools/failure.h"
#include "libemap/tools/stopwatch.h"

namespace emap {
namespace {

struct Arguments {
  std::string input, output;
  bool as_points = false, as_mesh = false, with_times = false;
};

int decode(const Arguments& arguments) {
  Stopwatch watch;
  const thin::Result<DecodedStream> decoded = read_emap_file(arguments.input);
  if (!decoded) return fail(decoded.error());
  const double stream_seconds = watch.lap_seconds();
  const bool as_points = arguments.as_points || (decoded->header.from_points && !arguments.as_mesh);
  PointSet points;
  ClosedMesh closed;
  if (as_points)
    points = sample_points(decoded->maps);
  else
    closed = closed_mesh(decoded->maps);
  const double surface_seconds = watch.lap_seconds();
  const auto written = as_points ? write_ply(arguments.output, points) : write_ply(arguments.output, closed.mesh);
  if (!written) return fail(written.error());
  const double write_seconds = watch.lap_seconds();
  std::string text = as_points
                         ? fmt::format("{}: {} points\n", arguments.output, points.positions.size())
                         : fmt::format("{}: {} vertices, {} triangles, {} of them in gaps, {} open edges\n",
                                       arguments.output, closed.mesh.positions.size(), closed.mesh.triangles.size(),
                                       closed.filling.inserted, closed.filling.edges_left);
  if (arguments.with_times)
    text += fmt::format("stream {:.3f} s, surface {:.3f} s, writing {:.3f} s\n", stream_seconds, surface_seconds,
                        write_seconds);
  std::fputs(text.c_str(), stdout);
  return std::fflush(stdout) == 0 ? 0 : thin::exit_code(thin::ErrorKind::temporary);
}

}  // namespace

void add_decode_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand("decode", "decompress to a closed mesh or to points");
  command->add_option("input", arguments->input, "Compressed file")->required()->type_name("IN.emap");
  command->add_option("output", arguments->output, "Decoded model")->required()->type_name("OUT.ply");
  CLI::Option* points =
      command->add_flag("--points", arguments->as_points, "Points with normals [where points were encoded]");
  command->add_flag("--mesh", arguments->as_mesh, "A mesh, its gaps closed [where a mesh was encoded]")
      ->excludes(points);
  command->add_flag("--times", arguments->with_times, "Say how long each step took");
  command->callback([arguments, &action] { action = [arguments] { return decode(*arguments); }; });
}

}  // namespace emap
