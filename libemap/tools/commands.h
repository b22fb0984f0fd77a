#pragma once

// The subcommands of `emap`, one .cpp each. Each adds itself to the program and, when it is the one that was called,
// stores in `action` what to do; main runs it and exits with the code that it returns (docs/operations.md).

#include <CLI/CLI.hpp>
#include <functional>

namespace emap {

using Action = std::function<int()>;

void add_encode_command(CLI::App& program, Action& action);
void add_decode_command(CLI::App& program, Action& action);
void add_info_command(CLI::App& program, Action& action);
void add_compare_command(CLI::App& program, Action& action);
void add_page_command(CLI::App& program, Action& action);
void add_partition_command(CLI::App& program, Action& action);
void add_render_command(CLI::App& program, Action& action);
void add_resample_command(CLI::App& program, Action& action);

}  // namespace emap
