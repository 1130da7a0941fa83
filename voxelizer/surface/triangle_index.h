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
    /// Levels from a cell to its children, 1 to 3. A cell has 2^level_step children along each axis.
    int level_step = 2;
    /// A cell's list also holds the triangles whose box comes as near to the cell as 2^-border_shift of its
    /// side. None: no border.
    std::optional<int> border_shift;
    /// Number of entries (4 bytes each) in all lists past which lists are dropped, and made anew when they
    /// are needed. It affects time only. None: 8 million, or four per triangle if that is more.
    std::optional<std::size_t> held_limit;
};

/// Finds the triangles of a surface that may touch a part of the root cube, by their bounding boxes, so that
/// the cost of a region deep in a large scene depends on the region's triangles alone. Lists are made on
/// demand, each from the list of the cell around it.
class TriangleIndex {
public:
    /// Copies a bounding box per triangle; the surface need not outlive the index.
    explicit TriangleIndex(const Surface& surface, const TriangleIndexOptions& options = {});

    struct Box {
        glm::ivec3 low;  ///< lattice units, closed
        glm::ivec3 high;
    };

    /// Global numbers, ascending, of the triangles whose box meets the closed cell and its border. Valid
    /// until the next call.
    /// @param cell  its level must be a multiple of level_step
    [[nodiscard]] std::span<const std::uint32_t> list(const Cell& cell);

    /// Global numbers, ascending, of the triangles whose box meets the closed region, without a border.
    [[nodiscard]] std::vector<std::uint32_t> triangles_in(const Region& region);

    /// Far triangles are not listed: they have no numbers, and every voxelization looks at all of them.
    struct FarBox {
        glm::i64vec3 low;
        glm::i64vec3 high;
    };
    [[nodiscard]] std::span<const FarBox> far_boxes() const { return far_boxes_; }

    [[nodiscard]] const Box& box(std::uint32_t triangle) const { return boxes_[triangle]; }
    [[nodiscard]] std::size_t triangle_count() const { return root_.triangles.size(); }

    /// Number of list entries that have been read since the index was built: the cost of its answers.
    [[nodiscard]] std::uint64_t entries_read() const { return entries_read_; }

private:
    struct Node {
        std::vector<std::uint32_t> triangles;
        bool is_split = false;  ///< all children that are not empty have nodes
    };
    /// A closed box in lattice units, and its part in the root cube, which the cells fill.
    struct Query {
        glm::i64vec3 low, high;
        glm::ivec3 low_inside, high_inside;
        int least_extent;
    };
    /// The node of a cell; null if the cell is empty.
    [[nodiscard]] Node* find(const Cell& cell);
    void split(const Cell& parent, Node& node);
    void gather(const Cell& cell, const Query& query, std::vector<std::uint32_t>& out);
    void gather_listed(const Cell& cell, const Node& node, const Query& query,
                       std::vector<std::uint32_t>& out);
    /// Drops lists if they pass held_limit. Called between two queries, so that no list goes while it is in
    /// use.
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
