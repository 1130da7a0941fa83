#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "renderer/pool/brick_pool.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/produce/surface_producer.h"
#include "voxelizer/bit_grid.h"
#include "voxelizer/surface/surface.h"

/// Bricks, read back as the marcher sees them.
namespace cairn::test {

/// The content of one slot of the pool. Places run from -1 to M, the border included.
struct ProducedBrick {
    int m = 0;
    /// RGBA8; coverage alone if the pool has no colour.
    std::vector<std::uint32_t> color;
    /// Normals as shaders/pool/brick_normals.glsl packs them.
    std::vector<std::uint32_t> normal;
    /// The summary of the masks, then their blocks.
    std::vector<std::uint64_t> masks;

    [[nodiscard]] std::size_t index(const glm::ivec3& place) const {
        const glm::ivec3 p = place + 1;
        return std::size_t(p.x + (m + 2) * (p.y + (m + 2) * p.z));
    }
    /// Red, green and blue (square roots, times the coverage), and the coverage: 0 to 255.
    [[nodiscard]] glm::ivec4 color_at(const glm::ivec3& place) const;
    /// The first of the voxel's two normals; 0 if it has none.
    [[nodiscard]] glm::vec3 normal_at(const glm::ivec3& place) const;
    [[nodiscard]] glm::vec3 second_normal_at(const glm::ivec3& place) const;
    [[nodiscard]] float second_share_at(const glm::ivec3& place) const;
    /// Whether the masks mark the voxel. Not for the border.
    [[nodiscard]] bool occupied(const glm::ivec3& place) const;
    [[nodiscard]] bool summary_at(const glm::ivec3& block) const;
    [[nodiscard]] bool operator==(const ProducedBrick&) const = default;
};

/// Two planes: dot(normal, p) is between `low` and `high`, p in sides of the voxel from its centre.
struct ProducedSlab {
    glm::dvec3 normal{0.0};  ///< unit
    double low = 0.0;
    double high = 0.0;

    /// The share of the 4^2 columns, along the axis that the normal is nearest to, which meet the slab.
    [[nodiscard]] double coverage() const;
};
/// The slab that comes with a voxel's normal; none if there are two normals.
[[nodiscard]] std::optional<ProducedSlab> slab_of(std::uint32_t normal);

/// One mip of a slot.
struct ProducedMip {
    int side = 0;  ///< voxels per side, border included
    std::vector<std::uint32_t> color;
    std::vector<std::uint32_t> normal;
    std::vector<bool> occupied;  ///< by the masks, without the border
    /// The 4^3 finer voxels of each voxel, for the voxels whose marks a packed brick keeps.
    std::vector<std::optional<std::uint64_t>> marks;

    /// Places run from -1.
    [[nodiscard]] std::size_t index(const glm::ivec3& place) const {
        const glm::ivec3 p = place + 1;
        return std::size_t(p.x + side * (p.y + side * p.z));
    }
    [[nodiscard]] bool occupied_at(const glm::ivec3& place) const {
        const int m = side - 2;
        return occupied[std::size_t(place.x + m * (place.y + m * place.z))];
    }
};
[[nodiscard]] ProducedMip read_mip(const renderer::BrickPool& pool, const renderer::TreeShape& shape,
                                   int slot, int mip);

[[nodiscard]] ProducedBrick read_brick(const renderer::BrickPool& pool, const renderer::TreeShape& shape,
                                       int slot);

/// All bytes of a slot: layer by layer, then its masks; or the words of its packed brick.
[[nodiscard]] std::vector<std::uint8_t> slot_content(const renderer::BrickPool& pool, int slot);

/// Bytes of the driver's memory that the pool's stores take.
struct PoolTextures {
    glm::ivec3 color_size{0};
    glm::ivec3 normal_size{0};
    std::size_t bytes = 0;
};
[[nodiscard]] PoolTextures textures_of(const renderer::BrickPool& pool);

/// Occupancy by the masks; and by the coverage, border included, so one voxel larger on every side.
[[nodiscard]] voxelizer::BitGrid mask_bits(const ProducedBrick& brick);
[[nodiscard]] voxelizer::BitGrid coverage_bits(const ProducedBrick& brick);

/// A surface, and everything that its bricks are produced with.
class BrickMaker {
public:
    BrickMaker(const renderer::TreeShape& shape, const voxelizer::Surface& surface, int slots);

    /// Produces these tiles into the first slots, in one call.
    [[nodiscard]] std::vector<ProducedBrick> produce(const std::vector<renderer::Tile>& tiles);
    [[nodiscard]] ProducedBrick produce_one(const renderer::Tile& tile) { return produce({tile}).front(); }
    [[nodiscard]] const renderer::BrickPool& pool() const { return pool_; }

private:
    renderer::TreeShape shape_;
    voxelizer::GpuSurface surface_;
    voxelizer::TriangleIndex lists_;
    renderer::SurfaceProducer producer_;
    renderer::BrickPool pool_;
};

/// Bytes of one slot of dense bricks, as BrickPool counts them.
[[nodiscard]] std::size_t slot_bytes(int m, bool has_color);

}  // namespace cairn::test
