#include "scenes/memory_budget.h"

#include <fmt/format.h>

#include "base/error.h"

namespace cairn::scenes {

void MemoryBudget::charge(const std::string& where, std::string_view what, std::uint64_t count,
                          std::uint64_t each_bytes) {
    if (each_bytes != 0 && count > left_ / each_bytes) {
        constexpr double mib = 1 << 20;
        throw Error(
            Fault::memory, where,
            fmt::format("{} take {:.0f} MiB, and {:.0f} of {:.0f} MiB are left for it", what,
                        double(count) * double(each_bytes) / mib, double(left_) / mib, double(limit_) / mib),
            "if the file is genuine and there is so much memory, allow more by LoadOptions::memory_bytes");
    }
    left_ -= count * each_bytes;
}

}  // namespace cairn::scenes
