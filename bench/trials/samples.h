#pragma once

#include <algorithm>
#include <vector>

namespace cairn::bench {

/// The median; of an even number of values the greater of the two in the middle. `values` must not be empty.
[[nodiscard]] inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

}  // namespace cairn::bench
