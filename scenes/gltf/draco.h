#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "scenes/gltf/accessors.h"

namespace cairn::scenes::gltf {

/// A mesh unpacked from a Draco stream (KHR_draco_mesh_compression): always a list of triangles.
struct DracoMesh {
    std::vector<std::uint32_t> indices;
    std::map<std::string, Elements> attributes;  ///< "POSITION", ...
};

/// @param wanted  the shape of each attribute (from its accessor) and the attribute's id in the stream.
/// @throws Error  if the stream is damaged, or its counts differ from the accessors'.
[[nodiscard]] DracoMesh decode_draco(const std::string& where, std::span<const std::uint8_t> stream,
                                     const std::map<std::string, std::pair<Elements, int>>& wanted,
                                     Budget& budget);

}  // namespace cairn::scenes::gltf
