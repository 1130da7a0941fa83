#pragma once

#include <cstdint>
#include <utility>

#include "base/clock.h"

namespace cairn::app {

/// Measures wall-clock time.
class Stopwatch {
public:
    /// Milliseconds since the construction, or since the last call.
    [[nodiscard]] double lap_ms() {
        const Clock::time_point now = Clock::now();
        return milliseconds(now - std::exchange(start_, now));
    }

private:
    Clock::time_point start_ = Clock::now();
};

/// The most memory that this program has held at once, in bytes. Not getrusage(): its figure outlives exec(),
/// so that it may be that of the program that started this one.
/// @return 0 if the system does not say (/proc/self/status)
[[nodiscard]] std::uint64_t peak_rss_bytes();

}  // namespace cairn::app
