#pragma once

#include <algorithm>
#include <vector>

namespace cairn::bench {

/// Of an even count, the upper one of the two in the middle. There must be one at least.
[[nodiscard]] inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

}  // namespace cairn::bench
