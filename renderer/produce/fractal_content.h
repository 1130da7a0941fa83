#pragma once

#include <cstddef>
#include <cstdint>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/shader_source.h"
#include "renderer/produce/content.h"

namespace cairn::renderer {

/// A cube without one of its eight octants, and each octant that is left likewise, without end: voxel (x, y,
/// z) of any power-of-two grid across the root cube is occupied if no bit is set in all three numbers.
///
/// Around its middle the set repeats itself, exactly, at each power of two: a trial for depth without limit.
/// The root cube is [0, 1]^3 of the world. Dimension log2(7).
namespace fractal {

/// Is the voxel, or the tile, at this position of a grid of 2^bits cubes across the root occupied?
[[nodiscard]] inline bool occupied(const glm::i64vec3& position, int bits) {
    const std::int64_t outside = position.x >> bits | position.y >> bits | position.z >> bits;
    return outside == 0 && (position.x & position.y & position.z) == 0;
}

}  // namespace fractal

/// Menger's sponge, the counterpart in space of Sierpinski's carpet: a cube of 27 cubes without the seven
/// that lie in the middle of at least two axes, and each of the 20 cubes that are left likewise, without end.
/// It is the procedural example of Crassin et al. 2008, section 7, where one brick serves all tiles.
///
/// The root cube is [0, 1]^3 of the world. For trees of N = 3. Dimension log(20) / log(3).
namespace sponge {

/// Is the voxel, or the tile, at this position of a grid of 3^level cubes across the root occupied?
[[nodiscard]] bool occupied(const glm::i64vec3& position, int level);

}  // namespace sponge

class FractalOracle final : public Oracle {
public:
    explicit FractalOracle(const TreeShape& shape) : shape_(shape) {}
    [[nodiscard]] glm::uvec2 child_mask(const Tile& tile) override;

private:
    TreeShape shape_;
};

/// Fills bricks from the positions of their voxels in the tile, and from which neighbours of the tile are
/// occupied, so that 32 bits are enough at any depth. The set inside a tile is the sponge if N = 3, else the
/// fractal.
class FractalProducer final : public Producer {
public:
    /// @param batch  bricks that are filled at a time, at least 1. No brick depends on it.
    FractalProducer(const TreeShape& shape, const gl::ShaderSource& shaders, std::size_t batch = 1024);
    std::vector<ProducedTile> produce(std::span<const BrickRequest> requests, BrickPool& pool) override;

private:
    TreeShape shape_;
    std::size_t batch_;
    gl::Program texels_;
    gl::Program masks_;
    gl::Buffer tiles_;
};

/// The sponge if the tree's N is 3, else the fractal.
class FractalContent final : public Content {
public:
    explicit FractalContent(const TreeShape& shape, const gl::ShaderSource& shaders = {});

    [[nodiscard]] const TreeShape& shape() const override { return shape_; }
    [[nodiscard]] Oracle& oracle() override { return oracle_; }
    [[nodiscard]] Producer& producer() override { return producer_; }
    [[nodiscard]] const voxelizer::Grid& grid() const override { return grid_; }
    [[nodiscard]] bool has_color() const override { return false; }
    [[nodiscard]] glm::vec3 uniform_color() const override { return {0.72F, 0.62F, 0.45F}; }

private:
    TreeShape shape_;
    voxelizer::Grid grid_;
    FractalOracle oracle_;
    FractalProducer producer_;
};

}  // namespace cairn::renderer
