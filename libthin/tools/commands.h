#pragma once

// The subcommands of `thin`, one .cpp each. Each adds itself to the program and, when it is the one that was called,
// stores in `action` what to do; main runs it and exits with the code that it returns (docs/operations.md).

#include <CLI/CLI.hpp>
#include <functional>

namespace thin {

using Action = std::function<int()>;

void add_run_command(CLI::App& program, Action& action);
void add_info_command(CLI::App& program, Action& action);
void add_methods_command(CLI::App& program, Action& action);
void add_synth_command(CLI::App& program, Action& action);
void add_evaluate_command(CLI::App& program, Action& action);
void add_twin_command(CLI::App& program, Action& action);

// For the daemon: one step of the way as one process, its outcome as one JSON object on standard output.
void add_check_command(CLI::App& program, Action& action);
void add_ingest_command(CLI::App& program, Action& action);
void add_window_command(CLI::App& program, Action& action);

}  // namespace thin
