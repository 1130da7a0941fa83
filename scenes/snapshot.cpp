#include "scenes/snapshot.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <fmt/format.h>

#include "base/error.h"
#include "scenes/deform.h"
#include "scenes/memory_budget.h"
#include "scenes/pose.h"

namespace cairn::scenes {
namespace {

/// About what a triangle takes in the surface that is built of it.
constexpr std::uint64_t bytes_per_placed_triangle = 64;

/// Data that is computed once per primitive, however often it is placed.
struct Extent {
    std::vector<std::uint32_t> used;  ///< vertices that the indices name; empty = all
    /// Bounds of these vertices in mesh space, for positions as they are in the file.
    Bounds bounds;
};

Extent extent_of(const Primitive& primitive) {
    Extent extent;
    std::vector<bool> used(primitive.positions.size(), false);
    for (const std::uint32_t index : primitive.indices)
        used[index] = true;
    for (std::uint32_t i = 0; i < used.size(); ++i) {
        if (!used[i]) continue;
        extent.used.push_back(i);
        extent.bounds.add(primitive.positions[i]);
    }
    if (extent.used.size() == used.size()) extent.used.clear();
    return extent;
}

/// Whether the transformed box lies inside other bounds for certain, in spite of rounding. False when not
/// finite.
bool surely_inside(const Bounds& box, const glm::dmat4& matrix, const Bounds& outer) {
    const glm::dvec3 centre(matrix * glm::dvec4(0.5 * (box.low + box.high), 1.0));
    const glm::dmat3 size(glm::abs(glm::dvec3(matrix[0])), glm::abs(glm::dvec3(matrix[1])),
                          glm::abs(glm::dvec3(matrix[2])));
    const glm::dvec3 reach = size * (0.5 * (box.high - box.low));
    // Sums of four products round by less than this part of their largest terms.
    const glm::dvec3 largest = size * glm::max(glm::abs(box.low), glm::abs(box.high));
    const glm::dvec3 slack = 1e-14 * (largest + glm::abs(glm::dvec3(matrix[3])));
    const glm::dvec3 low = centre - reach - slack;
    const glm::dvec3 high = centre + reach + slack;
    return low.x >= outer.low.x && low.y >= outer.low.y && low.z >= outer.low.z && high.x <= outer.high.x &&
           high.y <= outer.high.y && high.z <= outer.high.z;
}

class SnapshotTaker {
public:
    SnapshotTaker(const Scene& scene, const Pose& pose) : scene_(scene), pose_(pose) {}

    Snapshot take(const SceneRoots& roots) {
        const std::vector<std::size_t> nodes = nodes_in_order(roots);
        result_.items.reserve(count_items(nodes));
        for (const std::size_t index : nodes) {
            const Node& node = scene_.nodes[index];
            const glm::dmat4& world = pose_.world_from_node[index];
            if (node.mesh >= 0) place_mesh(index);
            if (node.light >= 0)
                result_.lights.push_back({scene_.lights[static_cast<std::size_t>(node.light)], world});
            if (node.camera >= 0)
                result_.cameras.push_back({scene_.cameras[static_cast<std::size_t>(node.camera)], world});
        }
        return std::move(result_);
    }

private:
    /// The visible nodes, depth first, each before its children.
    [[nodiscard]] std::vector<std::size_t> nodes_in_order(const SceneRoots& roots) const {
        std::vector<std::size_t> order;
        std::vector<int> open(roots.nodes.rbegin(), roots.nodes.rend());
        while (!open.empty()) {
            const auto index = static_cast<std::size_t>(open.back());
            open.pop_back();
            if (!scene_.nodes[index].visible) continue;
            order.push_back(index);
            const auto& children = scene_.nodes[index].children;
            open.insert(open.end(), children.rbegin(), children.rend());
        }
        return order;
    }

    /// Counts what these nodes place before any of it is made.
    /// @return        how many items that gives at most
    /// @throws Error  if the scene's limits do not allow it.
    [[nodiscard]] std::size_t count_items(const std::vector<std::size_t>& nodes) const {
        std::uint64_t items = 0;
        std::uint64_t triangles = 0;
        MemoryBudget posed(scene_.placing.bytes);
        for (const std::size_t index : nodes) {
            const Node& node = scene_.nodes[index];
            if (node.mesh < 0) continue;
            const std::uint64_t places = std::max<std::size_t>(node.instances.size(), 1);
            for (const Primitive& primitive : scene_.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
                items += places;
                triangles += places * primitive.element_count();
                const std::uint64_t each = node.skin >= 0                    ? sizeof(glm::dvec3)
                                           : primitive.morph_targets.empty() ? 0
                                                                             : sizeof(glm::vec3);
                posed.charge(scene_.name, "the posed copies of its meshes",
                             primitive.positions.size() + primitive.normals.size(), each);
            }
        }
        if (items > scene_.placing.primitives)
            throw Error(
                Fault::input, scene_.name,
                fmt::format("it places {} primitives, which passes the limit \"primitives\"", items),
                fmt::format("if the file is genuine, allow it by LoadOptions::limits primitives={}", items));
        MemoryBudget(scene_.placing.bytes)
            .charge(scene_.name, fmt::format("the {} triangles that it places", triangles), triangles,
                    bytes_per_placed_triangle);
        return items;
    }

    void place_mesh(std::size_t index) {
        const Node& node = scene_.nodes[index];
        const Mesh& mesh = scene_.meshes[static_cast<std::size_t>(node.mesh)];
        const std::span<const float> weights = morph_weights_of(scene_, pose_, index);
        const std::vector<glm::dmat4>& joints = joint_matrices(node);
        for (const Primitive& primitive : mesh.primitives) {
            const bool skinned = !joints.empty() && !primitive.skin.empty();
            Item item{&primitive,
                      primitive.positions,
                      primitive.normals,
                      pose_.world_from_node[index],
                      int(index),
                      -1,
                      skinned};
            if (skinned || !primitive.morph_targets.empty())
                deform(item, weights, skinned ? &joints : nullptr);
            // A skin has put its vertices into the world: glTF lets it pass over the node, and so over
            // instances.
            if (skinned || node.instances.empty()) {
                add(item, index);
                continue;
            }
            for (int instance = 0; instance < int(node.instances.size()); ++instance) {
                Item copy = item;
                copy.instance = instance;
                copy.world_from_mesh = world_from_instance(node, item.world_from_mesh, instance);
                add(copy, index);
            }
        }
    }

    /// Empty if the node has no skin. Computed once per skin, however many nodes share it.
    [[nodiscard]] const std::vector<glm::dmat4>& joint_matrices(const Node& node) {
        static const std::vector<glm::dmat4> none;
        if (node.skin < 0) return none;
        const auto [found, is_new] = matrices_of_skins_.try_emplace(node.skin);
        std::vector<glm::dmat4>& matrices = found->second;
        if (!is_new) return matrices;
        const Skin& skin = scene_.skins[static_cast<std::size_t>(node.skin)];
        matrices.reserve(skin.joints.size());
        for (std::size_t j = 0; j < skin.joints.size(); ++j)
            matrices.push_back(world_by_joint(skin, pose_, j));
        return matrices;
    }

    void deform(Item& item, std::span<const float> weights, const std::vector<glm::dmat4>* joints) {
        DeformedVertices vertices = morph(*item.primitive, weights);
        if (joints != nullptr) {
            result_.placed.push_back(skin(*item.primitive, *joints, vertices));
            item.placed = result_.placed.back();
            item.positions = {};
            item.world_from_mesh = glm::dmat4(1.0);
        } else {
            result_.deformed.push_back(std::move(vertices.positions));
            item.positions = result_.deformed.back();
        }
        if (vertices.normals.empty()) return;
        result_.deformed.push_back(std::move(vertices.normals));
        item.normals = result_.deformed.back();
    }

    void add(const Item& item, std::size_t node) {
        const std::uint64_t count = item.primitive->element_count();
        switch (item.primitive->topology) {
            case Topology::triangles:
                result_.triangle_count += count;
                break;
            case Topology::lines:
                result_.line_count += count;
                break;
            case Topology::points:
                result_.point_count += count;
                break;
        }
        result_.items.push_back(item);
        if (count == 0) return;
        const auto [found, is_new] = extents_.try_emplace(item.primitive);
        if (is_new) found->second = extent_of(*item.primitive);
        const Extent& extent = found->second;
        const bool deformed = item.positions.data() != item.primitive->positions.data();
        if (deformed || !surely_inside(extent.bounds, item.world_from_mesh, result_.bounds))
            add_vertices(item, extent.used, node);
    }

    /// Grows the bounds vertex by vertex.
    void add_vertices(const Item& item, const std::vector<std::uint32_t>& used, std::size_t node) {
        const std::size_t vertex_count = used.empty() ? item.vertex_count() : used.size();
        double finite_sum = 0.0;  // a single infinity or NaN stays in a sum for ever
        for (std::size_t i = 0; i < vertex_count; ++i) {
            const glm::dvec3 world = item.world(used.empty() ? i : used[i]);
            result_.bounds.add(world);
            finite_sum += 0.0 * (world.x + world.y + world.z);
        }
        if (!std::isfinite(finite_sum))
            throw Error(Fault::input,
                        fmt::format("{}: node {} \"{}\"", scene_.name, node, scene_.nodes[node].name),
                        "its transform, skin or morph targets move a vertex to infinity",
                        "the file is damaged; export it again");
    }

    const Scene& scene_;
    const Pose& pose_;
    std::unordered_map<const Primitive*, Extent> extents_;
    std::unordered_map<int, std::vector<glm::dmat4>> matrices_of_skins_;
    Snapshot result_;
};

std::size_t checked(const char* what, int index, std::size_t count, const std::string& scene) {
    if (index >= 0 && static_cast<std::size_t>(index) < count) return static_cast<std::size_t>(index);
    throw Error(Fault::usage, scene, fmt::format("there is no {} {}; it has {}", what, index, count),
                count == 0 ? "leave the option out" : fmt::format("choose 0 to {}", count - 1));
}

}  // namespace

const Animation* animation_of(const Scene& scene, const When& when) {
    if (!when.animation) return nullptr;
    return &scene.animations[checked("animation", *when.animation, scene.animations.size(), scene.name)];
}

Snapshot take_snapshot(const Scene& scene, const When& when) {
    const Animation* const animation = animation_of(scene, when);
    const std::size_t root =
        checked("scene", when.scene_index.value_or(scene.default_scene), scene.scenes.size(), scene.name);
    const Pose pose = take_pose(scene, animation, when.seconds);
    return SnapshotTaker(scene, pose).take(scene.scenes[root]);
}

std::vector<double> frame_times(const Scene& scene, const When& when, double frames_per_second) {
    constexpr double most_frames = 1e6;
    const Animation* const animation = animation_of(scene, when);
    const double duration = animation != nullptr ? animation->duration : 0.0;
    if (!(frames_per_second > 0.0) || !(duration * frames_per_second <= most_frames)) {
        throw Error(
            Fault::usage, scene.name,
            fmt::format("{} frames a second over {} seconds are out of range", frames_per_second, duration),
            fmt::format("choose a rate above 0 that makes at most {} frames", most_frames));
    }
    std::vector<double> times;
    for (std::size_t frame = 0; double(frame) / frames_per_second < duration; ++frame)
        times.push_back(double(frame) / frames_per_second);
    times.push_back(duration);
    return times;
}

Bounds bounds_over_animation(const Scene& scene, const When& when, double frames_per_second) {
    Bounds bounds;
    for (const double seconds : frame_times(scene, when, frames_per_second)) {
        const Bounds frame = take_snapshot(scene, {seconds, when.animation, when.scene_index}).bounds;
        if (frame.empty()) continue;
        bounds.add(frame.low);
        bounds.add(frame.high);
    }
    return bounds;
}

}  // namespace cairn::scenes
