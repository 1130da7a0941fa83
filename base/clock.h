#pragma once

#include <algorithm>
#include <chrono>

#include "base/error.h"

namespace cairn {

using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

inline double milliseconds(Clock::duration time) {
    return Milliseconds(time).count();
}
inline double milliseconds_since(Clock::time_point start) {
    return milliseconds(Clock::now() - start);
}

/// The moment at which a budget that starts now is used up; at most a day from now.
/// @throws Error (Fault::usage) if the budget is negative or not a number.
inline Clock::time_point deadline_in(Milliseconds budget) {
    constexpr Milliseconds a_day{86.4e6};
    if (!(budget.count() >= 0.0))
        throw Error(Fault::usage, "frame budget", "it is negative or not a number", "give it milliseconds");
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::min(budget, a_day));
}

}  // namespace cairn
