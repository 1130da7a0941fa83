#pragma once

#include <chrono>
#include <utility>
#include <vector>

#include <sys/resource.h>

#include "bench/trials/samples.h"

namespace cairn::bench {

/// Time by the wall clock, and processor time of all threads of this process. Processor time varies less on a
/// machine that is shared.
struct Cost {
    double wall_ms = 0.0;
    double processor_ms = 0.0;
    Cost operator+(const Cost& other) const {
        return {wall_ms + other.wall_ms, processor_ms + other.processor_ms};
    }
};

[[nodiscard]] inline double processor_ms() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto ms = [](const timeval& t) { return double(t.tv_sec) * 1e3 + double(t.tv_usec) / 1e3; };
    return ms(usage.ru_utime) + ms(usage.ru_stime);
}

template <typename Work>
[[nodiscard]] Cost cost_of(const Work& work) {
    const double processor = processor_ms();
    const auto start = std::chrono::steady_clock::now();
    work();
    const auto stop = std::chrono::steady_clock::now();
    return {std::chrono::duration<double, std::milli>(stop - start).count(), processor_ms() - processor};
}

/// Costs of a contender, frame by frame. The medians need at least one frame.
struct Costs {
    std::vector<Cost> frames;
    [[nodiscard]] double wall_ms() const { return median_of(&Cost::wall_ms); }
    [[nodiscard]] double processor_ms() const { return median_of(&Cost::processor_ms); }

private:
    [[nodiscard]] double median_of(double Cost::*part) const {
        std::vector<double> values;
        for (const Cost& cost : frames)
            values.push_back(cost.*part);
        return median(std::move(values));
    }
};

}  // namespace cairn::bench
