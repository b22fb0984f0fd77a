// emap resample: a surface through its elevation maps and back, nothing coded: what the maps alone cost
// (thesis, 3.4.2).

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <string>

#include "libemap/elevation/base_plane.h"
#include "libemap/elevation/canonical_mesh.h"
#include "libemap/elevation/gap_filling.h"
#include "libemap/elevation/resampling.h"
#include "libemap/partition/partitioning.h"
#include "libemap/surface/model_file.h"
#include "libemap/tools/commands.h"
#include "libemap/tools/failure.h"
#include "libemap/tools/partition_options.h"

namespace emap {
namespace {

struct ResampleArguments {
  std::string input, output;
  PartitionArguments partition;
  double mu = 1;
  bool open = false;
  GapFillingOptions filling;
};

class Stopwatch {
 public:
  void say(const char* step) {
    const auto now = std::chrono::steady_clock::now();
    std::fputs(fmt::format("  {:<12} {:7.2f} s\n", step, std::chrono::duration<double>(now - last_).count()).c_str(),
               stdout);
    last_ = now;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

int resample(const ResampleArguments& arguments) {
  Stopwatch watch;
  const thin::Result<Mesh> mesh = read_mesh(arguments.input);
  if (!mesh) return fail(mesh.error());
  watch.say("read");
  const thin::Result<Partition> partition = partition_mesh(*mesh, arguments.partition.options());
  if (!partition) return fail(partition.error());
  watch.say("partition");
  const std::vector<BasePlane> planes = base_planes(*mesh, *partition);
  const double spacing = spacing_for_resolution(*mesh, *partition, planes, arguments.mu);
  const ElevationMaps maps = resample_mesh(*mesh, *partition, planes, spacing);
  watch.say("resample");
  const ClosedMesh closed =
      arguments.open ? ClosedMesh{canonical_mesh(maps), {}} : closed_mesh(maps, arguments.filling);
  const Mesh& resampled = closed.mesh;
  watch.say("mesh");
  if (const thin::Result<void> written = write_ply(arguments.output, resampled); !written) return fail(written.error());
  std::fputs(fmt::format("{} patches, spacing {:.6g}, {} samples, {} triangles\n", maps.patches.size(), spacing,
                         resampled.positions.size(), resampled.triangles.size())
                 .c_str(),
             stdout);
  if (!arguments.open)
    std::fputs(fmt::format("{} triangles inserted; boundary edges {} before, {} left\n", closed.filling.inserted,
                           closed.filling.edges_before, closed.filling.edges_left)
                   .c_str(),
               stdout);
  return 0;
}

}  // namespace

void add_resample_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<ResampleArguments>();
  CLI::App* command = program.add_subcommand("resample", "a mesh through its elevation maps and back, nothing coded");
  command->add_option("input", arguments->input, "Mesh to sample")->required()->type_name("FILE");
  command->add_option("output", arguments->output, "Mesh of the samples")->required()->type_name("OUT.ply");
  command->add_option("--mu", arguments->mu, "Sampling interval; 1: as many samples as there are vertices [1]")
      ->check(CLI::PositiveNumber);
  command->add_option("--reach", arguments->filling.reach, "Widest gap to close, in sampling intervals [3]")
      ->check(CLI::PositiveNumber);
  command->add_flag("--open", arguments->open, "Leave the gaps between patches open");
  add_partition_options(*command, arguments->partition);
  command->callback([arguments, &action] { action = [arguments] { return resample(*arguments); }; });
}

}  // namespace emap
