#pragma once

#include <compare>
#include <cstdint>

namespace cairn::renderer {

/// One pass of rays and the production that follows it. Caches count ages in rounds: the stamp of a slot or
/// of a block is the last round that used it.
struct Round {
    std::uint32_t number = 0;  ///< passes count from 1; 0 is before the first

    auto operator<=>(const Round&) const = default;
    [[nodiscard]] Round next() const { return {number + 1}; }
    [[nodiscard]] Round before() const { return {number - 1}; }
};

}  // namespace cairn::renderer
