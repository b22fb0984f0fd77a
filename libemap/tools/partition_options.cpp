#include "libemap/tools/partition_options.h"

namespace emap {

PartitionOptions PartitionArguments::options() const {
  PartitionOptions options = as_given;
  options.strict = !lenient;
  return options;
}

void add_partition_options(CLI::App& command, PartitionArguments& arguments) {
  const std::map<std::string, PartitionMethod> methods = {{"gla", PartitionMethod::gla},
                                                          {"split-merge", PartitionMethod::split_merge}};
  PartitionOptions& options = arguments.as_given;
  command.add_option("--partition", options.method, "gla or split-merge [gla]")
      ->transform(CLI::CheckedTransformer(methods));
  command.add_option("--aperture", options.aperture_degrees, "Widest angle to a patch's plane, degrees [80]")
      ->check(CLI::Range(1.0, 89.0));
  command.add_option("--split", options.split_degrees, "split-merge: aperture of clusters before merging [40]")
      ->check(CLI::Range(1.0, 89.0));
  command.add_option("--patches", options.least_patches, "gla: at least so many patches [1]")
      ->check(CLI::PositiveNumber);
  command.add_option("--fold-tolerance", options.fold_tolerance, "Sheets nearer than so many diagonals are one [1e-4]")
      ->check(CLI::Range(0.0, 1.0));
  command
      .add_option("--scrap-error", options.scrap_error,
                  "RMS error that folds too small for patches may add, diagonals [8e-6]")
      ->check(CLI::Range(0.0, 1.0));
  command.add_option("--smoothing", options.smoothing_rounds, "Rounds of smoothing of the normals [2]")
      ->check(CLI::Range(0, 100));
  command.add_flag("--lenient", arguments.lenient, "Let patches have several sheets over one place");
}

}  // namespace emap
