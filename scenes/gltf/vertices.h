#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scenes/gltf/reader.h"

namespace cairn::scenes::gltf {

/// Where the vertices of one primitive come from.
struct VertexSource {
    Reader& reader;
    const std::string& where;
    const std::map<std::string, int>& attributes;  ///< accessor per attribute
    /// Attributes from a Draco stream, which are used instead of their accessors.
    const std::map<std::string, Elements>& unpacked;
    Elements positions;               ///< the positions of all vertices of the file
    std::vector<std::uint32_t> kept;  ///< the vertices to read; empty = all
    std::size_t count = 0;            ///< number of vertices to read

    [[nodiscard]] bool has(const std::string& name) const { return attributes.contains(name); }
    [[nodiscard]] Elements elements(const std::string& name) const;
};

/// Reads positions and the attributes that the scene uses.
/// @throws Error  if counts differ, types do not fit, a position is not finite.
void read_vertices(const VertexSource& source, Primitive& result);

void read_morph_targets(const VertexSource& source, const std::vector<std::map<std::string, int>>& targets,
                        Primitive& result);

/// The morph weights of a mesh or node, one per target; empty if the file gives none. Weights that are not
/// finite count as 0, and so do those that the file lacks, with a warning.
[[nodiscard]] std::vector<float> read_morph_weights(Reader& reader, const std::string& where,
                                                    const std::vector<double>& weights,
                                                    std::size_t target_count);

/// One more than the largest joint that a vertex of the mesh names; 0 if the mesh has no skin.
[[nodiscard]] std::uint32_t joints_needed_by(const Mesh& mesh);

}  // namespace cairn::scenes::gltf
