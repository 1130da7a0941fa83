#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace cairn::scenes::gltf {

/// The elements of a primitive's mode, glTF's 0 to 6 (points, lines, loop, line strip, triangles, strip,
/// fan).
/// @return nothing if the mode is another number.
[[nodiscard]] std::optional<Topology> topology_of(int mode);

/// Turns strips, fans and loops into lists, keeping the winding (glTF 2.0, 3.7.2.1). Vertices at the end that
/// make no whole element are dropped, as the specification asks.
[[nodiscard]] std::vector<std::uint32_t> unroll(std::vector<std::uint32_t> indices, int mode);

/// Number of entries that unroll() returns.
[[nodiscard]] std::uint64_t unrolled_count(std::uint64_t index_count, int mode);

}  // namespace cairn::scenes::gltf
