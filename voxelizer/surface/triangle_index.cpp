#include "voxelizer/surface/triangle_index.h"

#include <algorithm>

#include "shaders/interop/grid.h"
#include "shaders/interop/surface.h"

namespace cairn::voxelizer {
namespace {

/// Size of a node of the map and of the vector in it, in units of list entries.
constexpr std::size_t node_cost = 24;
/// Length up to which a list is read whole instead of refined.
constexpr std::size_t short_list = 64;

std::uint64_t key_of(const Cell& cell) {
    const auto p = glm::u64vec3(cell.position);
    return std::uint64_t(cell.level) << 58U | p.x << 38U | p.y << 19U | p.z;
}

int shift_of(const Cell& cell) {
    return LATTICE_BITS - cell.level;
}

}  // namespace

TriangleIndex::TriangleIndex(const Surface& surface, const TriangleIndexOptions& options)
    : options_(options) {
    boxes_.reserve(surface.triangle_count);
    root_.triangles.reserve(surface.triangle_count);
    std::uint32_t chunk_first = 0;
    for (const SurfaceChunk& chunk : surface.chunks) {
        // Numbers leave a gap after a chunk that is not full; boxes_ has it too.
        boxes_.resize(chunk_first, Box{glm::ivec3(1), glm::ivec3(0)});
        auto corner = [&](std::uint32_t v) {
            const auto& p = chunk.positions[v];
            return glm::ivec3(p[0], p[1], p[2]);
        };
        for (const interop::SurfaceTriangle& triangle : chunk.triangles) {
            const glm::ivec3 a = corner(triangle.vertices.x);
            const glm::ivec3 b = corner(triangle.vertices.y);
            const glm::ivec3 c = corner(triangle.vertices.z);
            root_.triangles.push_back(std::uint32_t(boxes_.size()));
            boxes_.push_back({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))});
        }
        chunk_first += surface.chunk_triangles;
    }
    for (const FarTriangle& triangle : surface.far_triangles) {
        const auto& [a, b, c] = triangle.positions;
        far_boxes_.push_back({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))});
    }
    if (!options_.held_limit)
        options_.held_limit = std::max(std::size_t(8) << 20U, 4 * root_.triangles.size());
}

void TriangleIndex::drop_if_too_many() {
    if (held_ <= *options_.held_limit) return;
    nodes_.clear();
    root_.is_split = false;
    held_ = 0;
}

std::span<const std::uint32_t> TriangleIndex::list(const Cell& cell) {
    drop_if_too_many();
    const Node* const node = find(cell);
    if (node == nullptr) return {};
    entries_read_ += node->triangles.size();
    return node->triangles;
}

TriangleIndex::Node* TriangleIndex::find(const Cell& cell) {
    if (cell.level == 0) return &root_;
    if (const auto found = nodes_.find(key_of(cell)); found != nodes_.end()) return &found->second;
    const Cell parent{cell.level - options_.level_step, cell.position >> options_.level_step};
    Node* const node = find(parent);
    if (node == nullptr || node->is_split) return nullptr;
    split(parent, *node);
    const auto found = nodes_.find(key_of(cell));
    return found != nodes_.end() ? &found->second : nullptr;
}

void TriangleIndex::split(const Cell& parent, Node& node) {
    const int n = 1 << options_.level_step;
    std::vector<std::vector<std::uint32_t>> children(std::size_t(n) * std::size_t(n) * std::size_t(n));
    const int child_shift = shift_of(parent) - options_.level_step;
    const int border = options_.border_shift ? (1 << child_shift) >> *options_.border_shift : 0;
    const glm::ivec3 low = parent.position << shift_of(parent);
    entries_read_ += node.triangles.size();
    for (const std::uint32_t triangle : node.triangles) {
        // Child c is touched when [c side - border, (c + 1) side + border] meets the box; all closed.
        const Box& box = boxes_[triangle];
        const glm::ivec3 last = (box.high - low + border) >> child_shift;
        const glm::ivec3 first = -((-(box.low - low - border)) >> child_shift) - 1;
        const glm::ivec3 from = glm::max(first, glm::ivec3(0));
        const glm::ivec3 to = glm::min(last, glm::ivec3(n - 1));
        for (int z = from.z; z <= to.z; ++z) {
            for (int y = from.y; y <= to.y; ++y) {
                for (int x = from.x; x <= to.x; ++x) {
                    const int child = x + n * (y + n * z);
                    children[std::size_t(child)].push_back(triangle);
                }
            }
        }
    }
    node.is_split = true;
    for (int child = 0; child < n * n * n; ++child) {
        std::vector<std::uint32_t>& list = children[std::size_t(child)];
        if (list.empty()) continue;
        held_ += list.size() + node_cost;
        list.shrink_to_fit();
        const Cell cell{parent.level + options_.level_step,
                        parent.position * n + glm::ivec3(child % n, child / n % n, child / (n * n))};
        nodes_[key_of(cell)] = {std::move(list), false};
    }
}

std::vector<std::uint32_t> TriangleIndex::triangles_in(const Region& region) {
    drop_if_too_many();
    const std::int64_t side = region.voxel_side();
    Query query;
    query.low = glm::i64vec3(region.origin) * side;
    query.high = glm::i64vec3(region.origin + region.size) * side;
    constexpr std::int64_t root_side = std::int64_t(1) << LATTICE_BITS;
    query.low_inside = glm::ivec3(glm::clamp(query.low, std::int64_t(0), root_side));
    query.high_inside = glm::ivec3(glm::clamp(query.high, std::int64_t(0), root_side));
    const glm::i64vec3 extent = query.high - query.low;
    query.least_extent = int(std::min({extent.x, extent.y, extent.z, root_side}));
    std::vector<std::uint32_t> out;
    gather({}, query, out);
    std::ranges::sort(out);
    return out;
}

void TriangleIndex::gather(const Cell& cell, const Query& query, std::vector<std::uint32_t>& out) {
    const Node* const node = find(cell);
    if (node == nullptr) return;
    const glm::ivec3 low = cell.position << shift_of(cell);
    const glm::ivec3 high = low + (1 << shift_of(cell));
    const bool covered = glm::all(glm::lessThanEqual(query.low_inside, low)) &&
                         glm::all(glm::greaterThanEqual(query.high_inside, high));
    if (covered || node->triangles.size() <= short_list || 1 << shift_of(cell) <= query.least_extent ||
        cell.level + options_.level_step > MAX_CELL_LEVEL) {
        gather_listed(cell, *node, query, out);
        return;
    }
    const int child_shift = shift_of(cell) - options_.level_step;
    // Children whose closed cube meets the query.
    const glm::ivec3 from = glm::max(-((low - query.low_inside) >> child_shift) - 1, glm::ivec3(0));
    const glm::ivec3 to =
        glm::min((query.high_inside - low) >> child_shift, glm::ivec3((1 << options_.level_step) - 1));
    std::vector<Cell> children;
    std::size_t entries = 0;
    for (int z = from.z; z <= to.z; ++z) {
        for (int y = from.y; y <= to.y; ++y) {
            for (int x = from.x; x <= to.x; ++x) {
                const Cell child{cell.level + options_.level_step,
                                 (cell.position << options_.level_step) + glm::ivec3(x, y, z)};
                const Node* const found = find(child);
                if (found == nullptr) continue;
                entries += found->triangles.size();
                children.push_back(child);
            }
        }
    }
    // Large triangles stand in all of them: then this one list is shorter.
    if (entries >= node->triangles.size()) {
        gather_listed(cell, *node, query, out);
        return;
    }
    for (const Cell& child : children)
        gather(child, query, out);
}

/// A triangle may stand in the lists of many cells. It is taken from the one that holds the low corner of the
/// part that its box and the query share.
void TriangleIndex::gather_listed(const Cell& cell, const Node& node, const Query& query,
                                  std::vector<std::uint32_t>& out) {
    entries_read_ += node.triangles.size();
    for (const std::uint32_t triangle : node.triangles) {
        const Box& box = boxes_[triangle];
        if (glm::any(glm::greaterThan(glm::i64vec3(box.low), query.high)) ||
            glm::any(glm::lessThan(glm::i64vec3(box.high), query.low))) {
            continue;
        }
        const glm::ivec3 shared = glm::clamp(glm::max(box.low, query.low_inside), 0, (1 << LATTICE_BITS) - 1);
        if ((shared >> shift_of(cell)) == cell.position) out.push_back(triangle);
    }
}

}  // namespace cairn::voxelizer
