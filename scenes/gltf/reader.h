#pragma once

#include <string>
#include <vector>

#include "scenes/gltf/accessors.h"
#include "scenes/gltf/buffers.h"
#include "scenes/gltf/limits.h"
#include "scenes/gltf/source.h"
#include "scenes/scene.h"

namespace cairn::scenes::gltf {

/// The data that the steps of one conversion share. The steps are the functions below, and run in this order.
struct Reader {
    Reader(Source read, const LoadOptions& options);
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;
    Reader(Reader&&) = delete;
    Reader& operator=(Reader&&) = delete;
    ~Reader() = default;

    Source source;
    MemoryBudget memory;
    Budget budget;
    Budget picture_budget;
    Buffers buffers{source, budget};
    Accessors accessors{source, buffers, budget};
    Scene scene;
    /// Per material, the number of the set of coordinates that its base colour texture uses; -1: no texture.
    std::vector<int> texcoord_sets;
    /// Per mesh, one more than the largest joint that it names.
    std::vector<std::uint32_t> joints_needed;

    /// Adds a warning, unless it is there already.
    void warn(const std::string& text);
    /// Adds a warning that what is voxelized or shown is not what the file means.
    /// @throws Error (Fault::input) instead, if the file is read strictly.
    void alter(const std::string& where, const std::string& what, const std::string& way_out);
    /// Whether a node has the mesh.
    [[nodiscard]] bool is_placed(std::size_t mesh) const { return placed_[mesh]; }
    /// What placing the scene may take, once it is read.
    [[nodiscard]] PlacingLimits placing_limits() const;

private:
    void add_warning(Warning warning);

    std::vector<bool> placed_;  ///< per mesh
};

/// @throws Error  if extensionsRequired names an extension that is not supported. Optional ones become
/// warnings.
void check_extensions(Reader& reader);
/// Fills Scene::materials, and those textures and images that base colours use.
void read_materials(Reader& reader);
void read_meshes(Reader& reader);
/// Fills Scene::nodes, scenes, cameras, lights and skins.
void read_nodes(Reader& reader);
/// @throws Error  if the nodes are not a forest, or a scene lists a node that is no root.
void check_forest(Reader& reader);
void read_skins(Reader& reader);
void read_animations(Reader& reader);

}  // namespace cairn::scenes::gltf
