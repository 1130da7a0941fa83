#pragma once

#include <algorithm>
#include <cstddef>

namespace cairn::renderer {

/// How many tile queries may be answered at once, for a frame that must not take long: it learns what one
/// costs, so that a frame overruns its time by no more than a few milliseconds, or by the least batch.
class BatchPace {
public:
    static constexpr std::size_t least = 4;  ///< together they keep the driver's threads busy
    static constexpr std::size_t most = 64;
    static constexpr double overrun_ms = 4.0;

    [[nodiscard]] std::size_t batch(double ms_left) const {
        const double fitting = std::max(ms_left, overrun_ms) / ms_a_query_;
        return std::size_t(std::clamp(fitting, double(least), double(most)));
    }

    /// Slows down at once, for the next batch may be the one that overruns; recovers by halves.
    void learn(double ms, std::size_t queries) {
        if (queries == 0) return;
        const double measured = ms / double(queries);
        ms_a_query_ = std::max({measured, 0.5 * (ms_a_query_ + measured), 1e-4});
    }

private:
    double ms_a_query_ = 1.0;
};

}  // namespace cairn::renderer
