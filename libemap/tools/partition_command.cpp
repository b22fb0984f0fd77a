// emap partition: a surface coloured by its patches, and what they are like.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <numbers>
#include <string>

#include "libemap/partition/partitioning.h"
#include "libemap/surface/model_file.h"
#include "libemap/surface/point_normals.h"
#include "libemap/tools/commands.h"
#include "libemap/tools/failure.h"
#include "libemap/tools/partition_options.h"
#include "libemap/tools/stopwatch.h"

namespace emap {
namespace {

struct Arguments {
  std::string input, output;
  PartitionArguments partition;
  bool every_patch = false, as_points = false;
};

// Neighbouring numbers get colours far apart: steps of the golden ratio around the colour wheel.
Colour colour_of(std::uint32_t patch) {
  const double hue = std::fmod(patch * (std::numbers::phi - 1), 1.0) * 6;
  const double lightness = 0.55 + 0.45 * ((patch / 3) % 2);
  Colour colour;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const double distance = std::abs(std::fmod(hue + 6 - 2.0 * static_cast<double>(channel), 6.0) - 3);
    colour[channel] = static_cast<std::uint8_t>(255 * lightness * std::clamp(distance - 0.75, 0.15, 1.0));
  }
  return colour;
}

std::vector<Colour> colours_of(const Partition& partition) {
  std::vector<Colour> colours;
  colours.reserve(partition.patch_of.size());
  for (const std::uint32_t patch : partition.patch_of) colours.push_back(colour_of(patch));
  return colours;
}

double degrees(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

std::string table_of(const Partition& partition, bool every_patch) {
  constexpr std::size_t kShown = 20;
  std::vector<std::uint32_t> order(partition.patches.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return partition.patches[a].area > partition.patches[b].area;
  });
  double area = 0, widest = 1;
  for (const Patch& patch : partition.patches) {
    area += patch.area;
    widest = std::min(widest, patch.aperture_cosine);
  }
  std::string text =
      fmt::format("  {:>7}  {:>9}  {:>8}  {:>6}  {:>9}\n", "patch", "elements", "area %", "J", "aperture");
  for (std::size_t i = 0; i < order.size() && (every_patch || i < kShown); ++i) {
    const Patch& patch = partition.patches[order[i]];
    text += fmt::format("  {:>7}  {:>9}  {:>8.3f}  {:>6.3f}  {:>9.1f}\n", order[i], patch.element_count,
                        100 * patch.area / area, patch.area > 0 ? patch.distortion / patch.area : 0,
                        degrees(patch.aperture_cosine));
  }
  if (!every_patch && order.size() > kShown) text += fmt::format("  and {} smaller ones\n", order.size() - kShown);
  return text + fmt::format("{} patches, J {:.3f}, aperture {:.1f} degrees\n", partition.patches.size(),
                            partition.mean_distortion(), degrees(widest));
}

int show(const thin::Result<Partition>& partition, const Arguments& arguments, double seconds,
         const std::function<thin::Result<void>(const std::vector<Colour>&)>& write) {
  if (!partition) return fail(partition.error());
  if (const thin::Result<void> written = write(colours_of(*partition)); !written) return fail(written.error());
  std::fputs(table_of(*partition, arguments.every_patch).c_str(), stdout);
  std::fputs(fmt::format("{:.2f} s\n", seconds).c_str(), stdout);
  return std::fflush(stdout) == 0 ? 0 : thin::exit_code(thin::ErrorKind::temporary);
}

int partition_as_mesh(const Arguments& arguments) {
  const thin::Result<Mesh> mesh = read_mesh(arguments.input);
  if (!mesh) return fail(mesh.error());
  Stopwatch watch;
  const thin::Result<Partition> partition = partition_mesh(*mesh, arguments.partition.options());
  return show(partition, arguments, watch.lap_seconds(), [&](const std::vector<Colour>& colours) {
    return write_ply(arguments.output, *mesh, {.triangle_colours = colours});
  });
}

int partition_as_points(const Arguments& arguments) {
  thin::Result<PointSet> points = read_points(arguments.input);
  if (!points) return fail(points.error());
  Stopwatch watch;
  ensure_normals(*points);
  const thin::Result<Partition> partition = partition_points(*points, arguments.partition.options());
  return show(partition, arguments, watch.lap_seconds(), [&](const std::vector<Colour>& colours) {
    return write_ply(arguments.output, *points, {.vertex_colours = colours});
  });
}

int partition(const Arguments& arguments) {
  return arguments.as_points ? partition_as_points(arguments) : partition_as_mesh(arguments);
}

}  // namespace

void add_partition_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand("partition", "cut a surface into patches, and colour it by them");
  command->add_option("input", arguments->input, "Model to cut")->required()->type_name("FILE");
  command->add_option("output", arguments->output, "Coloured model")->required()->type_name("OUT.ply");
  add_partition_options(*command, arguments->partition);
  command->add_flag("--points", arguments->as_points, "Take the vertices alone");
  command->add_flag("--all", arguments->every_patch, "List every patch");
  command->callback([arguments, &action] { action = [arguments] { return partition(*arguments); }; });
}

}  // namespace emap
