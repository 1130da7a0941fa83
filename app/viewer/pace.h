#pragma once

#include <algorithm>

namespace cairn::app {

/// Predicts how many pixels can be marched in a given time, from the times that were measured.
class Pace {
public:
    /// @param aim_ms  milliseconds that a frame or a slice of it is to take, > 0
    /// @param pixels  first guess
    Pace(double aim_ms, double pixels) : aim_ms_(aim_ms), pixels_(pixels) {}

    [[nodiscard]] double pixels() const { return pixels_; }
    [[nodiscard]] double aim_ms() const { return aim_ms_; }

    /// Takes in a measurement. A single outlier changes the pace by no more than the factors below; it slows
    /// down faster than it recovers.
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
