#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace cairn::renderer {

/// Gives out runs of consecutive units of a store: each time the shortest free run that suffices, the first
/// of several.
class RunAllocator {
public:
    explicit RunAllocator(std::uint32_t units);

    /// @return  the run's first unit; none if no free run is long enough.
    [[nodiscard]] std::optional<std::uint32_t> take(std::uint32_t units);
    /// Takes a run back. It must have been taken with this length.
    void release(std::uint32_t first, std::uint32_t units);

    [[nodiscard]] std::uint32_t free_units() const { return free_units_; }
    [[nodiscard]] std::uint32_t longest_free_run() const {
        return by_length_.empty() ? 0 : by_length_.rbegin()->first;
    }

private:
    void add(std::uint32_t first, std::uint32_t units);
    void remove(std::map<std::uint32_t, std::uint32_t>::iterator run);

    std::map<std::uint32_t, std::uint32_t> by_place_;              // first unit and length of the free runs
    std::set<std::pair<std::uint32_t, std::uint32_t>> by_length_;  // the same, length first
    std::uint32_t free_units_ = 0;
};

}  // namespace cairn::renderer
