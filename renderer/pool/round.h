#pragma once

#include <compare>
#include <cstdint>

namespace cairn::renderer {

/// One pass of rays and the production that follows it: what the caches count ages in. A slot's or a block's
/// stamp is the last round that used it.
struct Round {
    std::uint32_t number = 0;  ///< passes count from 1; 0 is before the first

    auto operator<=>(const Round&) const = default;
    [[nodiscard]] Round next() const { return {number + 1}; }
    [[nodiscard]] Round before() const { return {number - 1}; }
};

}  // namespace cairn::renderer
