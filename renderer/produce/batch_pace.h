#pragma once

#include <algorithm>
#include <cstddef>

namespace cairn::renderer {

/// How many tile queries are answered at once in a frame within a budget. It learns the time per query, so
/// that a frame overruns its budget by no more than a few milliseconds, or by the least batch.
class BatchPace {
public:
    static constexpr std::size_t least = 4;  ///< enough to keep the driver's threads busy
    static constexpr std::size_t most = 64;
    static constexpr double overrun_ms = 4.0;

    [[nodiscard]] std::size_t batch(double ms_left) const {
        const double fitting = std::max(ms_left, overrun_ms) / ms_per_query_;
        return std::size_t(std::clamp(fitting, double(least), double(most)));
    }

    /// Slows down at once, because the next batch may be the one that overruns; recovers by halves.
    void learn(double ms, std::size_t queries) {
        if (queries == 0) return;
        const double measured = ms / double(queries);
        ms_per_query_ = std::max({measured, 0.5 * (ms_per_query_ + measured), 1e-4});
    }

private:
    double ms_per_query_ = 1.0;
};

}  // namespace cairn::renderer
