#pragma once

// The command line's way to say how a surface is to be partitioned, the same for every command that does it.

#include <CLI/CLI.hpp>

#include "libemap/partition/partitioning.h"

namespace emap {

struct PartitionArguments {
  PartitionOptions as_given;
  bool lenient = false;

  PartitionOptions options() const;
};

// The arguments must live until the command line is parsed.
void add_partition_options(CLI::App& command, PartitionArguments& arguments);

}  // namespace emap
