#include "app/terminal/terminal.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

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

void secure_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
        // It takes the least free number, which is this one, because those before it are open. In the mode
        // that the stream is not used in, so that its use fails as that of a closed one.
        (void)open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    }
    // A limit of file sizes (ulimit -f) is then told by the write that meets it, as a full disk is.
    (void)std::signal(SIGXFSZ, SIG_IGN);
}

void tell(std::string_view text) {
    (void)std::fwrite(text.data(), 1, text.size(), stderr);
    (void)std::fflush(stderr);
}

void warn(std::string_view what) {
    tell(fmt::format("warning: {}\n", printable(what)));
}

void print_error(std::string_view what, std::string_view way_out) {
    std::string text = fmt::format("error: {}\n", printable(what));
    if (!way_out.empty()) text += fmt::format("  {}\n", printable(way_out));
    tell(text);
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
        const auto* const system = dynamic_cast<const std::system_error*>(&error);
        if (system != nullptr && system->code() == std::errc::resource_unavailable_try_again) {
            print_error("no further thread can be started", "allow more threads, or more memory");
            return ExitCode::memory;
        }
        print_error(fmt::format("a fault of cairn itself: {}", error.what()),
                    "please report it, with the command line and the scene");
        return ExitCode::internal;
    }
}

}  // namespace cairn::app
