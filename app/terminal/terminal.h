#pragma once

#include <exception>
#include <string>
#include <string_view>

#include "app/terminal/exit_code.h"

namespace cairn::app {

/// The text without control characters other than line breaks: names come from files, and a file must not
/// drive the user's terminal.
[[nodiscard]] std::string printable(std::string_view text);

/// Opens /dev/null in place of each of stdin, stdout and stderr that is closed: else the next file that is
/// opened would take its number, and what is meant for the terminal would be written into that file. Call it
/// before anything else. A limit of file sizes becomes an error of the write that meets it, not a signal.
void secure_standard_streams();

/// Writes to stderr. Whether that can be written makes no difference: what the command has done counts.
void tell(std::string_view text);

/// Prints "warning: WHAT" on stderr.
void warn(std::string_view what);

/// Prints "error: WHERE: WHAT" on stderr, and the way out on an indented second line.
void print_error(std::string_view what, std::string_view way_out = {});

/// Prints the exception that is being handled. @return its exit code.
[[nodiscard]] ExitCode report_current_exception();

}  // namespace cairn::app
