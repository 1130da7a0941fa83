#pragma once

#include <string>
#include <vector>

#include "app/verbs/verbs.h"

namespace cairn::app {

/// Reads a command line, and does none of its work yet. "--help" and "--version" are work, too: they print.
///
/// What an option names is looked at while the line is read: a folder must exist, a file must be writable.
/// @param arguments  without the program's name.
/// @throws Error     Fault::usage: the verb is missing or unknown, or an option is not as it must be.
[[nodiscard]] Work read_command_line(const std::vector<std::string>& arguments);

}  // namespace cairn::app
