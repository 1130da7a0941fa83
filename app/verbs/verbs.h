#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/terminal/exit_code.h"

namespace cairn::app {

/// The work of a verb, once the command line has been read.
using Work = std::function<ExitCode()>;

/// Each function adds one verb to the command, and sets `chosen` if the command line names that verb.
void add_info(CLI::App& command, Work& chosen);
void add_voxelize(CLI::App& command, Work& chosen);
void add_check(CLI::App& command, Work& chosen);
void add_render(CLI::App& command, Work& chosen);
void add_view(CLI::App& command, Work& chosen);
void add_export(CLI::App& command, Work& chosen);
void add_shadow(CLI::App& command, Work& chosen);
/// Only in the program cairn-bench.
void add_bench(CLI::App& command, Work& chosen);
/// In the command: runs that program with the options, which are all words after "bench".
[[nodiscard]] Work bench_apart(const std::vector<std::string>& options);

inline constexpr const char* bench_description = "Measure speed and accuracy: a CSV and a picture";

/// Adds a verb whose options are an `Options`, and whose work is `run(options)`.
template <typename Options>
void add_verb(CLI::App& command, Work& chosen, const char* name, const char* description,
              void (*add_options)(CLI::App&, Options&), ExitCode (*run)(const Options&)) {
    CLI::App& verb = *command.add_subcommand(name, description);
    const auto options = std::make_shared<Options>();
    add_options(verb, *options);
    verb.callback([&chosen, options, run] { chosen = [options, run] { return run(*options); }; });
}

}  // namespace cairn::app
