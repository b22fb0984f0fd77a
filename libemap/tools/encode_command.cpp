// emap encode: a model file to an .emap file of a wanted rate or quality.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "libemap/coding/encoder.h"
#include "libemap/surface/model_file.h"
#include "libemap/tools/commands.h"
#include "libemap/tools/failure.h"
#include "libemap/tools/partition_options.h"
#include "libthin/foundation/file_bytes.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

constexpr double kDefaultPsnr_db = 80;

struct Arguments {
  std::string input, output;
  std::string coder = elevation_coders().front().name;
  std::optional<double> bits_per_point, psnr_db;
  std::optional<std::uint32_t> samples_per_diagonal;
  PartitionArguments partition;
  BitDistribution distribution = BitDistribution::surface;
  bool as_points = false, quiet = false, one_partition = false;
  int threads = 0;
};

thin::Result<Encoded> encoded(const SurfaceToEncode& surface, const Arguments& arguments) {
  EncoderOptions options;
  options.bits_per_point = arguments.bits_per_point;
  options.psnr_db = arguments.psnr_db;
  if (!options.bits_per_point && !options.psnr_db) options.psnr_db = kDefaultPsnr_db;
  options.coder = find_elevation_coder(arguments.coder);
  options.distribution = arguments.distribution;
  options.samples_per_diagonal = arguments.samples_per_diagonal;
  options.may_repartition = !arguments.one_partition && arguments.partition.options() == PartitionOptions();
  if (!arguments.quiet) options.progress = [](const std::string& line) { spdlog::info("{}", line); };
  return encode_surface(surface, options);
}

int encode(const Arguments& arguments) {
  const thin::ThreadLimit limit(arguments.threads);
  thin::Result<Model> model = read_model(arguments.input);
  if (!model) return fail(model.error());
  const bool as_points = arguments.as_points || !model->is_mesh();
  const std::size_t count = model->positions.size();
  const PartitionOptions partition = arguments.partition.options();
  if (!arguments.quiet) spdlog::info("{}: {} {}", arguments.input, count, as_points ? "points" : "vertices");

  const auto surface = as_points ? points_to_encode(points_of(std::move(*model)), partition)
                                 : mesh_to_encode(mesh_of(std::move(*model)), partition);
  if (!surface) return fail(surface.error());
  if (!arguments.quiet) spdlog::info("{} patches", (*surface)->planes().size());
  const thin::Result<Encoded> result = encoded(**surface, arguments);
  if (!result) return fail(result.error());
  if (const auto written = thin::write_file_bytes(arguments.output, result->stream); !written)
    return fail(written.error());
  std::fputs(
      fmt::format("{}: {} bytes, {:.3f} bits per {}, {:.2f} dB, {} patches, {} samples to the diagonal\n",
                  arguments.output, result->stream.size(),
                  8 * static_cast<double>(result->stream.size()) / static_cast<double>(count),
                  as_points ? "point" : "vertex", result->psnr_db, result->patch_count, result->samples_per_diagonal)
          .c_str(),
      stdout);
  return std::fflush(stdout) == 0 ? 0 : thin::exit_code(thin::ErrorKind::temporary);
}

std::string coder_help() {
  std::string text = "How elevations are coded: ";
  for (const ElevationCoder& coder : elevation_coders())
    text += fmt::format("{}{} ({})", coder.number == elevation_coders().front().number ? "" : "; ", coder.name,
                        coder.summary);
  return text + fmt::format(" [{}]", elevation_coders().front().name);
}

std::vector<std::string> coder_names() {
  std::vector<std::string> names;
  for (const ElevationCoder& coder : elevation_coders()) names.push_back(coder.name);
  return names;
}

}  // namespace

void add_encode_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand("encode", "compress a model to a wanted rate or quality");
  command->add_option("input", arguments->input, "Model to encode")->required()->type_name("FILE");
  command->add_option("output", arguments->output, "Compressed file")->required()->type_name("OUT.emap");
  CLI::Option* rate =
      command->add_option("--bpp", arguments->bits_per_point, "At most so many bits for each point or vertex")
          ->check(CLI::PositiveNumber);
  command->add_option("--psnr", arguments->psnr_db, "At least this quality, dB [80, where there is no --bpp]")
      ->check(CLI::Range(20.0, 150.0))
      ->excludes(rate);
  command->add_flag("--points", arguments->as_points, "Take a mesh's vertices without its triangles");
  command->add_option("--coder", arguments->coder, coder_help())->check(CLI::IsMember(coder_names()));
  const std::map<std::string, BitDistribution> distributions = {
      {"even", BitDistribution::even}, {"image", BitDistribution::image}, {"surface", BitDistribution::surface}};
  command
      ->add_option("--distribution", arguments->distribution,
                   "baseline: bits shared out among patches even, image or surface [surface]")
      ->transform(CLI::CheckedTransformer(distributions));
  command
      ->add_option("--resolution", arguments->samples_per_diagonal,
                   "Samples to the bounding box's diagonal [the encoder's choice]")
      ->check(CLI::Range(16, 20000));
  add_partition_options(*command, arguments->partition);
  command->add_flag("--one-partition", arguments->one_partition,
                    "Try no other partitions [where an option says how to cut]");
  command->add_option("--threads", arguments->threads, "Threads at most [all cores]")->check(CLI::NonNegativeNumber);
  command->add_flag("--quiet", arguments->quiet, "No progress on standard error");
  command->callback([arguments, &action] { action = [arguments] { return encode(*arguments); }; });
}

}  // namespace emap
