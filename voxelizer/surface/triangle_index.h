#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include <glm/glm.hpp>

#include "voxelizer/grid.h"
#include "voxelizer/surface/surface.h"

namespace cairn::voxelizer {

/// A cube of the regular subdivision of a root cube: level l has 2^l cells across it.
struct Cell {
    int level = 0;           ///< at most MAX_CELL_LEVEL
    glm::ivec3 position{0};  ///< in units of its level's cells

    [[nodiscard]] bool operator==(const Cell&) const = default;
};
constexpr int MAX_CELL_LEVEL = 19;

struct TriangleIndexOptions {
    /// Levels from a cell to its children: 2^level_step of them along each axis. 1 to 3.
    int level_step = 2;
    /// A cell's list also holds what comes as near as 2^-border_shift of the cell's side. None: no border.
    std::optional<int> border_shift;
    /// Numbers held (4 bytes each) before the lists are made anew, which costs time, never correctness. None:
    /// 8 million, or four per triangle if that is more.
    std::optional<std::size_t> held_limit;
};

/// Which triangles of a surface may touch a part of the root cube, so that a region deep in a large scene
/// costs what its own triangles cost. Lists are refined on demand, each from that of the cell around it; the
/// bounding boxes of the triangles decide.
class TriangleIndex {
public:
    /// Keeps a copy of what it needs of the surface: a bounding box per triangle.
    explicit TriangleIndex(const Surface& surface, const TriangleIndexOptions& options = {});

    struct Box {
        glm::ivec3 low;  ///< lattice units, closed
        glm::ivec3 high;
    };

    /// Those whose box meets the closed cell and its border: global triangle numbers, ascending. Valid until
    /// the next call.
    /// @param cell  its level is a multiple of level_step
    [[nodiscard]] std::span<const std::uint32_t> list(const Cell& cell);

    /// Those whose box meets the closed region, without a border: global triangle numbers, ascending.
    [[nodiscard]] std::vector<std::uint32_t> triangles_in(const Region& region);

    /// Far triangles are not listed: they have no numbers, and every voxelization looks at all of them.
    struct FarBox {
        glm::i64vec3 low;
        glm::i64vec3 high;
    };
    [[nodiscard]] std::span<const FarBox> far_boxes() const { return far_boxes_; }

    [[nodiscard]] const Box& box(std::uint32_t triangle) const { return boxes_[triangle]; }
    [[nodiscard]] std::size_t triangle_count() const { return root_.triangles.size(); }

    /// Entries of lists read since the start: what the answers have cost.
    [[nodiscard]] std::uint64_t entries_read() const { return entries_read_; }

private:
    struct Node {
        std::vector<std::uint32_t> triangles;
        bool is_split = false;  ///< all children that are not empty have nodes
    };
    /// A closed box in lattice units, and its part in the root cube, where cells are.
    struct Query {
        glm::i64vec3 low, high;
        glm::ivec3 low_inside, high_inside;
        int least_extent;
    };
    /// Null for an empty cell.
    [[nodiscard]] Node* find(const Cell& cell);
    void split(const Cell& parent, Node& node);
    void gather(const Cell& cell, const Query& query, std::vector<std::uint32_t>& out);
    void gather_listed(const Cell& cell, const Node& node, const Query& query,
                       std::vector<std::uint32_t>& out);
    /// Between two questions, so that what an answer refers to stays while it is worked out.
    void drop_if_too_many();

    TriangleIndexOptions options_;
    std::vector<Box> boxes_;
    std::vector<FarBox> far_boxes_;
    Node root_;
    std::unordered_map<std::uint64_t, Node> nodes_;
    std::size_t held_ = 0;
    std::uint64_t entries_read_ = 0;
};

}  // namespace cairn::voxelizer
