#pragma once

#include <algorithm>

namespace cairn::app {

/// How many pixels can be marched in a given time: it learns from each time that was measured.
class Pace {
public:
    /// @param aim_ms  how long a frame or a slice of it is to take, > 0
    /// @param pixels  a guess for the first one
    Pace(double aim_ms, double pixels) : aim_ms_(aim_ms), pixels_(pixels) {}

    [[nodiscard]] double pixels() const { return pixels_; }
    [[nodiscard]] double aim_ms() const { return aim_ms_; }

    /// A single outlier moves the pace by no more than these factors; it slows down faster than it recovers.
    void learn(double ms, double pixels) {
        const double wanted = pixels * aim_ms_ / std::max(ms, 1e-3);
        pixels_ = std::max(std::clamp(wanted, slowest * pixels_, fastest * pixels_), least_pixels);
    }

    static constexpr double least_pixels = 4096.0;

private:
    static constexpr double slowest = 0.5;
    static constexpr double fastest = 1.4;
    double aim_ms_;
    double pixels_;
};

}  // namespace cairn::app
