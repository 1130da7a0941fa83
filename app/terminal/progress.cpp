#include "app/terminal/progress.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "app/terminal/terminal.h"
#include "base/clock.h"

namespace cairn::app {
namespace {

constexpr auto patience = std::chrono::seconds(1);
constexpr auto redraw_every = std::chrono::milliseconds(200);
constexpr int bar_width = 40;

}  // namespace

Progress::Progress(std::string what, bool quiet) : what_(std::move(what)) {
    if (!quiet && isatty(STDERR_FILENO) == 1) drawer_ = std::thread([this] { draw_until_done(); });
}

Progress::~Progress() {
    if (!drawer_.joinable()) return;
    {
        const std::lock_guard lock(mutex_);
        done_ = true;
    }
    wake_.notify_one();
    drawer_.join();
}

void Progress::draw_until_done() {
    const Clock::time_point start = Clock::now();
    std::unique_lock lock(mutex_);
    if (wake_.wait_for(lock, patience, [this] { return done_; })) return;
    do {
        const double share = share_.load();
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        if (share < 0.0) {
            tell(fmt::format("\r{}: {:.0f} s\033[K", what_, seconds));
        } else {
            const int filled = int(std::clamp(share, 0.0, 1.0) * bar_width);
            tell(fmt::format("\r{} [{:=<{}}{: <{}}] {:.0f}%\033[K", what_, "", filled, "", bar_width - filled,
                             share * 100.0));
        }
    } while (!wake_.wait_for(lock, redraw_every, [this] { return done_; }));
    tell("\r\033[K");
}

}  // namespace cairn::app
