#pragma once

#include <string>
#include <vector>

#include "app/verbs/verbs.h"

namespace cairn::app {

/// Adds the verb "bench" with its options. Null: the command has none, and what follows "bench" is left to
/// the program cairn-bench.
using AddBench = void (*)(CLI::App&, Work&);

/// Reads a command line and returns its work, which has not begun. "--help" and "--version" are work, too:
/// they print.
///
/// Folders and files that options name are checked while the line is read: a folder must exist, a file must
/// be writable.
/// @param arguments  without the program's name
/// @throws Error     Fault::usage: if the verb is missing or unknown, or an option is invalid.
[[nodiscard]] Work read_command_line(const std::vector<std::string>& arguments,
                                     AddBench add_bench_verb = nullptr);

/// All of a program's main(): secures its streams, does the work, and tells errors.
/// @return the exit code
[[nodiscard]] int run_command(int argc, char** argv, AddBench add_bench_verb = nullptr);

}  // namespace cairn::app
