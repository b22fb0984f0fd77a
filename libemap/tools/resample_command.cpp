// emap resample: a surface through its elevation maps and back, nothing coded: what the maps alone cost
// (thesis, 3.4.2).

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>

#include "libemap/elevation/base_plane.h"
#include "libemap/elevation/canonical_mesh.h"
#include "libemap/elevation/gap_filling.h"
#include "libemap/elevation/least_squares.h"
#include "libemap/elevation/resampling.h"
#include "libemap/partition/partitioning.h"
#include "libemap/surface/model_file.h"
#include "libemap/surface/point_normals.h"
#include "libemap/tools/commands.h"
#include "libemap/tools/failure.h"
#include "libemap/tools/partition_options.h"
#include "libemap/tools/stopwatch.h"

namespace emap {
namespace {

struct ResampleArguments {
  std::string input, output;
  PartitionArguments partition;
  double mu = 1;
  bool open = false, as_points = false, fit = false;
  GapFillingOptions filling;
};

void say_step(const char* step, Stopwatch& watch) {
  std::fputs(fmt::format("  {:<12} {:7.2f} s\n", step, watch.lap_seconds()).c_str(), stdout);
}

int say_maps(const ElevationMaps& maps, std::size_t samples) {
  std::fputs(
      fmt::format("{} patches, spacing {:.6g}, {} samples\n", maps.patches.size(), maps.spacing, samples).c_str(),
      stdout);
  return std::fflush(stdout) == 0 ? 0 : thin::exit_code(thin::ErrorKind::temporary);
}

int resample_as_mesh(const ResampleArguments& arguments) {
  Stopwatch watch;
  const thin::Result<Mesh> mesh = read_mesh(arguments.input);
  if (!mesh) return fail(mesh.error());
  say_step("read", watch);
  const thin::Result<Partition> partition = partition_mesh(*mesh, arguments.partition.options());
  if (!partition) return fail(partition.error());
  say_step("partition", watch);
  const std::vector<BasePlane> planes = base_planes(*mesh, *partition);
  const double spacing = spacing_for_resolution(*mesh, *partition, planes, arguments.mu);
  ElevationMaps maps = resample_mesh(*mesh, *partition, planes, spacing);
  say_step("resample", watch);
  if (arguments.fit) {
    fit_elevations(resample_mesh(*mesh, *partition, planes, fitting_spacing(spacing)), maps);
    say_step("fit", watch);
  }
  const ClosedMesh closed =
      arguments.open ? ClosedMesh{canonical_mesh(maps), {}} : closed_mesh(maps, arguments.filling);
  say_step("mesh", watch);
  if (const thin::Result<void> written = write_ply(arguments.output, closed.mesh); !written)
    return fail(written.error());
  if (!arguments.open)
    std::fputs(fmt::format("{} triangles inserted; boundary edges {} before, {} left\n", closed.filling.inserted,
                           closed.filling.edges_before, closed.filling.edges_left)
                   .c_str(),
               stdout);
  return say_maps(maps, closed.mesh.positions.size());
}

int resample_as_points(const ResampleArguments& arguments) {
  Stopwatch watch;
  thin::Result<PointSet> points = read_points(arguments.input);
  if (!points) return fail(points.error());
  say_step("read", watch);
  ensure_normals(*points);
  say_step("normals", watch);
  const thin::Result<Partition> partition = partition_points(*points, arguments.partition.options());
  if (!partition) return fail(partition.error());
  say_step("partition", watch);
  const std::vector<BasePlane> planes = base_planes(*points, *partition);
  const double spacing = spacing_for_resolution(*points, *partition, planes, arguments.mu);
  const MlsSurface surface(points->positions);
  const ElevationMaps maps = resample_points(*points, surface, *partition, planes, spacing);
  say_step("resample", watch);
  const PointSet samples = sample_points(maps);
  if (const thin::Result<void> written = write_ply(arguments.output, samples); !written) return fail(written.error());
  return say_maps(maps, samples.positions.size());
}

int resample(const ResampleArguments& arguments) {
  return arguments.as_points ? resample_as_points(arguments) : resample_as_mesh(arguments);
}

}  // namespace

void add_resample_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<ResampleArguments>();
  CLI::App* command =
      program.add_subcommand("resample", "a surface through its elevation maps and back, nothing coded");
  command->add_option("input", arguments->input, "Surface to sample")->required()->type_name("FILE");
  command->add_option("output", arguments->output, "Surface of the samples")->required()->type_name("OUT.ply");
  command->add_option("--mu", arguments->mu, "Sampling interval; 1: as many samples as there are vertices [1]")
      ->check(CLI::PositiveNumber);
  command->add_option("--reach", arguments->filling.reach, "Widest gap to close, in sampling intervals [2.5]")
      ->check(CLI::PositiveNumber);
  command->add_flag("--points", arguments->as_points, "Take the vertices alone, and write samples");
  command->add_flag("--fit", arguments->fit, "Fit the elevations by least squares");
  command->add_flag("--open", arguments->open, "Leave the gaps between patches open");
  add_partition_options(*command, arguments->partition);
  command->callback([arguments, &action] { action = [arguments] { return resample(*arguments); }; });
}

}  // namespace emap
