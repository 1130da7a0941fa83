#pragma once

#include <algorithm>
#include <chrono>

#include "base/error.h"

namespace cairn::renderer {

using Clock = std::chrono::steady_clock;

inline double milliseconds(Clock::duration time) {
    return std::chrono::duration<double, std::milli>(time).count();
}
inline double milliseconds_since(Clock::time_point start) {
    return milliseconds(Clock::now() - start);
}

/// @throws Error (Fault::usage) for a budget that is no time.
inline Clock::time_point deadline_in(double budget_ms) {
    constexpr double a_day = 86.4e6;
    if (!(budget_ms >= 0.0))
        throw Error(Fault::usage, "frame budget", "it is negative or not a number", "give it milliseconds");
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(
                              std::chrono::duration<double, std::milli>(std::min(budget_ms, a_day)));
}

}  // namespace cairn::renderer
