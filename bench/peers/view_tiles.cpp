#include "bench/peers/view_tiles.h"

#include <algorithm>
#include <queue>
#include <tuple>

#include "base/error.h"

namespace cairn::bench {

using renderer::Box;
using renderer::child_of;
using renderer::may_hold;
using renderer::Tile;

namespace {

/// Margin of positions, as a share of the root cube's side: a few steps of a float, in which rays compute.
constexpr double place_margin = 0x1p-20;

/// Whether the child may hold something, by the mask of its parent and, if n = 8, by the oracle.
bool may_hold_child(renderer::Oracle& oracle, const glm::uvec2& mask, const Tile& parent, int n, int child) {
    return may_hold(mask, n, child) && !(n == 8 && oracle.is_empty(child_of(parent, n, child)));
}

}  // namespace

ViewTest::ViewTest(const interop::MarchView& view, const renderer::TreeShape& shape)
    : shape_(shape),
      cone_{glm::dvec3(view.eye), double(view.pixel_cone), false},
      forward_(view.forward),
      across_(glm::dvec3(view.right) / glm::dot(glm::dvec3(view.right), glm::dvec3(view.right))),
      up_(glm::dvec3(view.up) / glm::dot(glm::dvec3(view.up), glm::dvec3(view.up))) {
    if (view.skipped == 0.0F && !shape.has_windows()) return;
    throw Error(Fault::usage, "view", "its rays do not start at its eye",
                "bring the eye nearer to the scene");
}

Box ViewTest::box_of(const Tile& tile) const {
    const double side = voxel_side(tile) * shape_.m;
    const glm::dvec3 low = glm::dvec3(tile.position) * side;
    return {low, low + side};
}

double ViewTest::voxel_side(const Tile& tile) const {
    return double(shape_.tiles_across(shape_.max_level - tile.level));
}

bool ViewTest::in_frustum(const Box& box) const {
    const double slack = place_margin * shape_.resolution();
    const glm::dvec3 middle = 0.5 * (box.low + box.high) - cone_.eye;
    const glm::dvec3 half = 0.5 * (box.high - box.low) + slack;
    auto reaches = [&](const glm::dvec3& plane) {
        return glm::dot(middle, plane) + glm::dot(half, glm::abs(plane)) >= 0.0;
    };
    return reaches(forward_ + across_) && reaches(forward_ - across_) && reaches(forward_ + up_) &&
           reaches(forward_ - up_);
}

bool ViewTest::shows(const Tile& tile) const {
    return tile.level >= shape_.max_level ||
           voxel_side(tile) <= cone_.width * cone_.distance_to(box_of(tile));
}

std::vector<ViewTile> list_tiles(renderer::Tree& tree, renderer::Oracle& oracle, const ViewTest& test) {
    const int n = test.shape().n;
    std::vector<ViewTile> listed;
    std::vector<std::uint32_t> waiting;
    if (tree.node(0).child_mask != glm::uvec2(0) || test.shape().max_level == 0) waiting.push_back(0);
    while (!waiting.empty()) {
        const std::uint32_t entry = waiting.back();
        waiting.pop_back();
        const Tile tile = tree.tile(entry);
        const Box box = test.box_of(tile);
        if (!test.in_frustum(box)) continue;
        if (test.shows(tile)) {
            listed.push_back({entry, test.distance_to(box)});
            continue;
        }
        const std::optional<std::uint32_t> first = tree.add_children(entry);
        if (!first) {
            throw Error(Fault::usage, "node pool", "it does not hold all tiles in the frustum",
                        "choose fewer pixels");
        }
        const glm::uvec2 mask = tree.node(entry).child_mask;
        for (int child = 0; child < test.shape().child_count(); ++child) {
            if (!may_hold_child(oracle, mask, tile, n, child)) continue;
            const std::uint32_t child_entry = *first + std::uint32_t(child);
            tree.set_child_mask(child_entry, oracle.child_mask(child_of(tile, n, child)));
            waiting.push_back(child_entry);
        }
    }
    std::sort(listed.begin(), listed.end(), [](const ViewTile& a, const ViewTile& b) {
        return std::tuple(a.distance, a.entry) < std::tuple(b.distance, b.entry);
    });
    return listed;
}

std::optional<double> nearest_voxel_side(renderer::Oracle& oracle, const ViewTest& test) {
    using Waiting = std::pair<double, Tile>;
    auto is_farther = [](const Waiting& a, const Waiting& b) { return a.first > b.first; };
    std::priority_queue<Waiting, std::vector<Waiting>, decltype(is_farther)> waiting(is_farther);
    auto add = [&](const Tile& tile) {
        const Box box = test.box_of(tile);
        if (test.in_frustum(box)) waiting.emplace(test.distance_to(box), tile);
    };
    const int n = test.shape().n;
    add(Tile{});
    while (!waiting.empty()) {
        const Tile tile = waiting.top().second;
        waiting.pop();
        const glm::uvec2 mask = oracle.child_mask(tile);
        if (tile.level == 0 && test.shape().max_level > 0 && mask == glm::uvec2(0)) return std::nullopt;
        if (test.shows(tile)) return test.voxel_side(tile);
        for (int child = 0; child < test.shape().child_count(); ++child)
            if (may_hold_child(oracle, mask, tile, n, child)) add(child_of(tile, n, child));
    }
    return std::nullopt;
}

}  // namespace cairn::bench
