#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

namespace cairn::app {

/// While an object lives, the first Ctrl-C (SIGINT), SIGTERM or SIGHUP sets asked(), so that the work can
/// stop and leave nothing half written. Work that does not stop within a second or so is ended: the process
/// says that it was interrupted, removes its unfinished outputs, and exits with ExitCode::interrupted. A
/// second signal ends the process as usual.
class Interrupt {
public:
    Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;
    Interrupt(Interrupt&&) = delete;
    Interrupt& operator=(Interrupt&&) = delete;
    /// Signals end the process as usual from then on.
    ~Interrupt();

    [[nodiscard]] static bool asked();
    /// @throws Error (Fault::interrupted) if asked().
    static void check();

private:
    void watch();

    std::mutex mutex_;
    std::condition_variable over_;
    bool is_over_ = false;
    int listen_ = -1;  ///< the end of a pipe at which the watcher waits for a signal
    std::thread watcher_;
};

}  // namespace cairn::app
