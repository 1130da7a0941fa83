#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "scenes/scene.h"

namespace cairn::scenes {

/// An axis-aligned box in world space; empty when low > high.
struct Bounds {
    glm::dvec3 low{1e300};
    glm::dvec3 high{-1e300};

    void add(const glm::dvec3& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    [[nodiscard]] bool empty() const { return low.x > high.x; }
};

/// One mesh primitive at one place. What is shared stays shared: the spans point into the Scene, or into the
/// Snapshot where a skin or morph targets moved the vertices.
struct Item {
    const Primitive* primitive = nullptr;
    std::span<const glm::vec3> positions;  ///< mesh space; one per vertex
    std::span<const glm::vec3> normals;    ///< mesh space; empty when the file has none
    glm::dmat4 world_from_mesh{1.0};
    int node = -1;         ///< into Scene::nodes
    int instance = -1;     ///< into the node's instances; -1: in place
    bool skinned = false;  ///< the node's skin moved `positions`, into the world
};

struct PlacedLight {
    Light light;
    glm::dmat4 world_from_light{1.0};
};
struct PlacedCamera {
    Camera camera;
    glm::dmat4 world_from_camera{1.0};
};

struct When {
    double seconds = 0.0;            ///< clamped to each channel's keys, as glTF asks
    std::optional<int> animation;    ///< none: the rest pose
    std::optional<int> scene_index;  ///< none: the file's default scene
};

/// One scene of a file at one moment: what stands where.
struct Snapshot {
    std::vector<Item> items;
    std::vector<PlacedLight> lights;
    std::vector<PlacedCamera> cameras;
    /// Exact bounds of all vertices that a primitive uses, in world space.
    Bounds bounds;
    std::uint64_t triangle_count = 0;
    std::uint64_t line_count = 0;
    std::uint64_t point_count = 0;

    /// Vertices that skins or morph targets moved; `items` point in here.
    std::vector<std::vector<glm::vec3>> deformed;
};

/// Evaluates animation, morph targets and skins at one moment. The scene must outlive the snapshot.
///
/// @throws Error  Fault::usage when the animation or the scene index does not exist; Fault::input when a
/// transform
///                gives a vertex that is not finite.
[[nodiscard]] Snapshot take_snapshot(const Scene& scene, const When& when = {});

/// The animation that a moment names; null: none. @throws Error  Fault::usage when it does not exist.
[[nodiscard]] const Animation* animation_of(const Scene& scene, const When& when);

/// The moments of an animation's frames: 0, 1 / rate, ... and its end, in seconds. Just 0 without an
/// animation.
/// @throws Error  Fault::usage when the animation does not exist, the rate is not positive, or there would be
///                more than a million frames.
[[nodiscard]] std::vector<double> frame_times(const Scene& scene, const When& when, double frames_per_second);

/// Encloses the scene at every frame (of frame_times), so that one grid serves them all. Between two frames
/// a vertex may swing past it by a little; grid_around leaves a voxel for that.
/// @throws Error  as take_snapshot and frame_times do.
[[nodiscard]] Bounds bounds_over_animation(const Scene& scene, const When& when, double frames_per_second);

}  // namespace cairn::scenes
