#include "renderer/pool/run_allocator.h"

#include <iterator>

namespace cairn::renderer {

RunAllocator::RunAllocator(std::uint32_t units) {
    if (units != 0) add(0, units);
}

void RunAllocator::add(std::uint32_t first, std::uint32_t units) {
    by_place_.emplace(first, units);
    by_length_.emplace(units, first);
    free_units_ += units;
}

void RunAllocator::remove(std::map<std::uint32_t, std::uint32_t>::iterator run) {
    by_length_.erase({run->second, run->first});
    free_units_ -= run->second;
    by_place_.erase(run);
}

std::optional<std::uint32_t> RunAllocator::take(std::uint32_t units) {
    const auto found = by_length_.lower_bound({units, 0});
    if (found == by_length_.end()) return std::nullopt;
    const auto [length, first] = *found;
    remove(by_place_.find(first));
    if (length > units) add(first + units, length - units);
    return first;
}

void RunAllocator::release(std::uint32_t first, std::uint32_t units) {
    const auto next = by_place_.lower_bound(first);
    if (next != by_place_.begin()) {
        const auto before = std::prev(next);
        if (before->first + before->second == first) {
            first = before->first;
            units += before->second;
            remove(before);
        }
    }
    if (next != by_place_.end() && first + units == next->first) {
        units += next->second;
        remove(next);
    }
    add(first, units);
}

}  // namespace cairn::renderer
