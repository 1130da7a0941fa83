#pragma once

#include <string>
#include <vector>

#include "app/verbs/verbs.h"

namespace cairn::app {

/// Reads a command line and returns its work, which has not begun. "--help" and "--version" are work, too:
/// they print.
///
/// Folders and files that options name are checked while the line is read: a folder must exist, a file must
/// be writable.
/// @param arguments  without the program's name.
/// @throws Error     Fault::usage: if the verb is missing or unknown, or an option is invalid.
[[nodiscard]] Work read_command_line(const std::vector<std::string>& arguments);

}  // namespace cairn::app
