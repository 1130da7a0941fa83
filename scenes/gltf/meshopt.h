#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace cairn::scenes::gltf {

/// A buffer view compressed by EXT_meshopt_compression.
struct MeshoptStream {
    std::span<const std::uint8_t> bytes;
    std::uint64_t count = 0;
    std::uint64_t stride = 0;  ///< bytes of one unpacked element
    std::string mode;          ///< ATTRIBUTES, TRIANGLES or INDICES
    std::string filter;        ///< NONE or empty, OCTAHEDRAL, QUATERNION, EXPONENTIAL
};

/// @return        count * stride bytes, for which the caller has charged the Budget.
/// @throws Error  if the stream breaks the extension's rules, or is damaged.
[[nodiscard]] std::vector<std::uint8_t> decode_meshopt(const std::string& where, const MeshoptStream& stream);

}  // namespace cairn::scenes::gltf
