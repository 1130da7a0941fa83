#include "app/terminal/terminal.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <new>
#include <stdexcept>

#include <fmt/format.h>

#include "app/terminal/option_names.h"
#include "base/error.h"

namespace cairn::app {

std::string printable(std::string_view text) {
    std::string out(text);
    std::replace_if(
        out.begin(), out.end(),
        [](unsigned char c) { return (c < 0x20 && c != '\n' && c != '\t') || c == 0x7F; }, '?');
    return out;
}

void warn(std::string_view what) {
    fmt::print(stderr, "warning: {}\n", printable(what));
}

void print_error(std::string_view what, std::string_view way_out) {
    fmt::print(stderr, "error: {}\n", printable(what));
    if (!way_out.empty()) fmt::print(stderr, "  {}\n", printable(way_out));
}

ExitCode report_current_exception() {
    try {
        throw;
    } catch (const Error& error) {
        print_error(error.what(), with_option_names(error.way_out()));
        return exit_code(error.fault());
    } catch (const std::bad_alloc&) {
        print_error("out of memory", "choose a lower resolution, or a machine with more memory");
        return ExitCode::memory;
    } catch (const std::length_error&) {  // a container larger than any memory
        print_error("out of memory", "choose a lower resolution, or a machine with more memory");
        return ExitCode::memory;
    } catch (const std::filesystem::filesystem_error& error) {
        print_error(error.what());
        return ExitCode::usage;
    } catch (const std::exception& error) {
        print_error(fmt::format("a fault of cairn itself: {}", error.what()),
                    "please report it, with the command line and the scene");
        return ExitCode::internal;
    }
}

}  // namespace cairn::app
