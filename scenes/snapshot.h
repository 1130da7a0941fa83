#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "scenes/scene.h"

namespace cairn::scenes {

/// An axis-aligned box in world space; empty if low > high.
struct Bounds {
    glm::dvec3 low{1e300};
    glm::dvec3 high{-1e300};

    void add(const glm::dvec3& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    [[nodiscard]] bool empty() const { return low.x > high.x; }
};

/// An affine matrix times a point. The order of the operations is part of the contract, because
/// shaders/voxelize/deform.comp.glsl follows it to the same bits: (x + y) + (z + translation), nothing fused.
[[nodiscard]] inline glm::dvec3 transform_point(const glm::dmat4& matrix, const glm::dvec3& point) {
    return (glm::dvec3(matrix[0]) * point.x + glm::dvec3(matrix[1]) * point.y) +
           (glm::dvec3(matrix[2]) * point.z + glm::dvec3(matrix[3]));
}

/// One mesh primitive at one place. The spans point into the Scene or, if a skin or morph targets moved the
/// vertices, into the Snapshot.
struct Item {
    const Primitive* primitive = nullptr;
    /// Mesh space; one per vertex. Empty if a skin placed the vertices.
    std::span<const glm::vec3> positions;
    std::span<const glm::vec3> normals;  ///< mesh space; empty if the file has none
    glm::dmat4 world_from_mesh{1.0};     ///< the identity if a skin placed the vertices
    int node = -1;                       ///< index into Scene::nodes
    int instance = -1;                   ///< index into the node's instances; -1: the node has none
    bool skinned = false;                ///< whether the node's skin placed the vertices
    /// World space, one per vertex, if the node's skin placed them. As doubles: far from the origin floats
    /// are coarser than voxels.
    std::span<const glm::dvec3> placed = {};

    [[nodiscard]] std::size_t vertex_count() const { return skinned ? placed.size() : positions.size(); }
    /// A vertex in the world.
    [[nodiscard]] glm::dvec3 world(std::size_t vertex) const {
        return skinned ? placed[vertex] : transform_point(world_from_mesh, positions[vertex]);
    }
};

struct PlacedLight {
    Light light;
    glm::dmat4 world_from_light{1.0};
};
struct PlacedCamera {
    Camera camera;
    glm::dmat4 world_from_camera{1.0};
};

/// A moment of a scene of the file.
struct When {
    double seconds = 0.0;            ///< clamped to the keys of each channel, as glTF asks
    std::optional<int> animation;    ///< none: the rest pose
    std::optional<int> scene_index;  ///< none: the file's default scene
};

/// One scene of a file at one moment: its primitives, lights and cameras, with their places.
struct Snapshot {
    std::vector<Item> items;
    std::vector<PlacedLight> lights;
    std::vector<PlacedCamera> cameras;
    /// Exact bounds of all vertices that a primitive uses, in world space.
    Bounds bounds;
    std::uint64_t triangle_count = 0;
    std::uint64_t line_count = 0;
    std::uint64_t point_count = 0;

    /// Vertices that morph targets moved, those that skins placed, and their normals; spans of `items` point
    /// into these.
    std::vector<std::vector<glm::vec3>> deformed;
    std::vector<std::vector<glm::dvec3>> placed;
};

/// Evaluates animation, morph targets and skins at one moment. The scene must outlive the snapshot.
///
/// @throws Error  Fault::usage if the animation or the scene index does not exist; Fault::input if a
///                transform gives a vertex that is not finite, or too many primitives are placed;
///                Fault::memory if what is placed would take more than Scene::placing allows, which is
///                counted before anything is made.
[[nodiscard]] Snapshot take_snapshot(const Scene& scene, const When& when = {});

/// The animation that a moment names; null if it names none.
/// @throws Error  Fault::usage if the animation does not exist.
[[nodiscard]] const Animation* animation_of(const Scene& scene, const When& when);

/// The moments of an animation's frames, in seconds: 0, 1 / rate, ... and the animation's end. Only 0 if
/// `when` names no animation.
/// @throws Error  Fault::usage if the animation does not exist, the rate is not positive, or there would be
///                more than a million frames.
[[nodiscard]] std::vector<double> frame_times(const Scene& scene, const When& when, double frames_per_second);

/// Bounds of the scene over all frames of frame_times, so that one grid serves them all. Between two frames a
/// vertex may swing a little out of the bounds; grid_around leaves a voxel for that.
/// @throws Error  as take_snapshot and frame_times do.
[[nodiscard]] Bounds bounds_over_animation(const Scene& scene, const When& when, double frames_per_second);

/// One flag per node of Scene::nodes.
using NodeSelection = std::vector<bool>;

/// The nodes that `wanted` names, with their descendants. A text that is a name selects all nodes of that
/// name; else a whole number is an index into Scene::nodes.
/// @throws Error  Fault::usage if a text is neither; the way out lists the nodes.
[[nodiscard]] NodeSelection select_nodes(const Scene& scene, std::span<const std::string> wanted);

/// All nodes that are not selected.
[[nodiscard]] NodeSelection other_nodes(const NodeSelection& selection);

/// The items of the selected nodes, with their bounds and counts, without lights and cameras. The whole
/// snapshot must outlive the part, whose items point into the same vertices.
[[nodiscard]] Snapshot part_of(const Snapshot& whole, const NodeSelection& selection);

}  // namespace cairn::scenes
