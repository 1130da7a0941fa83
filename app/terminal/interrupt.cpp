#include "app/terminal/interrupt.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include "app/terminal/exit_code.h"
#include "app/terminal/terminal.h"
#include "base/error.h"
#include "base/output_file.h"

namespace cairn::app {
namespace {

/// Long enough for work that looks at asked(), and short enough for somebody who waits.
constexpr auto grace = std::chrono::milliseconds(1500);

constexpr const char* interrupted = "interrupted; nothing was left half written";

// A handler may touch nothing else.
volatile std::sig_atomic_t stop = 0;
volatile std::sig_atomic_t bell = -1;  // the end of a pipe that wakes the watcher

constexpr int signals[] = {SIGINT, SIGTERM, SIGHUP};

void ring() {
    const char byte = 0;
    if (write(bell, &byte, 1) < 0) return;  // it has rung already
}

void ask_to_stop(int /*signal*/) {
    const int code = errno;
    stop = 1;
    ring();
    errno = code;
}

/// Removes the files that an OutputFile of this process would remove. Their names are those of open files.
void remove_unfinished_outputs() {
    std::error_code failed;
    for (std::filesystem::directory_iterator entry("/proc/self/fd", failed), end; !failed && entry != end;
         entry.increment(failed)) {
        std::error_code closed;
        const std::filesystem::path path = std::filesystem::read_symlink(entry->path(), closed);
        if (!closed && is_unfinished_output(path.filename().string())) unlink(path.c_str());
    }
}

}  // namespace

Interrupt::Interrupt() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0)
        throw Error(Fault::memory, "", "the system has no pipe left", "close other programs");
    bell = ends[1];
    listen_ = ends[0];
    try {
        watcher_ = std::thread([this] { watch(); });
    } catch (const std::system_error&) {
        return;  // no memory for a thread: signals end the process as usual
    }
    struct sigaction action {};
    action.sa_handler = ask_to_stop;
    action.sa_flags = SA_RESETHAND | SA_RESTART;
    for (const int signal : signals) {
        // A signal that the parent process ignores (nohup, a shell's background job) stays ignored.
        struct sigaction before {};
        sigaction(signal, nullptr, &before);
        if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
    }
}

/// Waits for a signal, then for the end of the work, and ends the process if that takes too long.
void Interrupt::watch() {
    pollfd wait{listen_, POLLIN, 0};
    while (poll(&wait, 1, -1) < 0) {
    }
    std::unique_lock lock(mutex_);
    if (over_.wait_for(lock, grace, [this] { return is_over_; })) return;
    remove_unfinished_outputs();
    if (isatty(STDERR_FILENO) == 1) tell("\r\033[K");  // over a line of progress
    print_error(interrupted);
    _exit(int(ExitCode::interrupted));
}

Interrupt::~Interrupt() {
    for (const int signal : signals) {
        struct sigaction now {};
        sigaction(signal, nullptr, &now);
        if (now.sa_handler == ask_to_stop) std::signal(signal, SIG_DFL);
    }
    {
        const std::lock_guard lock(mutex_);
        is_over_ = true;
    }
    over_.notify_one();
    ring();  // the watcher may still wait for a signal
    if (watcher_.joinable()) watcher_.join();
    close(listen_);
    close(bell);
    bell = -1;
}

bool Interrupt::asked() {
    return stop != 0;
}

void Interrupt::check() {
    if (asked()) throw Error(Fault::interrupted, "", interrupted);
}

}  // namespace cairn::app
