#pragma once

#include <cstdint>
#include <utility>

#include <sys/resource.h>

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

/// The most memory that this process has held at once, in bytes.
[[nodiscard]] inline std::uint64_t peak_rss_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return std::uint64_t(usage.ru_maxrss) * 1024;  // Linux counts it in KiB
}

}  // namespace cairn::app
