// The oracle's masks against the exact reference at the children's own level.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/produce/surface_oracle.h"
#include "renderer/produce/tile_lists.h"
#include "shaders/interop/grid.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "voxelizer/methods/conservative_voxelizer.h"

namespace cairn::renderer {
namespace {

using namespace cairn::test;

struct Shape {
    int n, max_resolution;
};

class SurfaceOracleTest : public GlTest, public ::testing::WithParamInterface<Shape> {};

voxelizer::Surface random_surface(std::uint32_t seed) {
    Random random(seed);
    std::vector<LatticeTriangle> triangles;
    for (int i = 0; i < 200; ++i)
        triangles.push_back(random_triangle(random, lattice_side >> random.between(4, 16)));
    return lattice_surface(triangles, 4096);
}

glm::uvec2 true_mask(const TreeShape& shape, const voxelizer::Surface& surface, const Tile& tile) {
    const voxelizer::BitGrid bits = reference::exact_voxels(
        surface,
        {shape.n_shift() * (tile.level + 1), glm::ivec3(tile.position) * shape.n, glm::ivec3(shape.n)});
    glm::uvec2 mask(0);
    for (int child = 0; child < shape.child_count(); ++child) {
        if (bits.at({child % shape.n, child / shape.n % shape.n, child / (shape.n * shape.n)}))
            mask[child / 32] |= 1U << (child % 32);
    }
    return mask;
}

/// A tile at, or one beside, a point of the lattice.
Tile tile_near(Random& random, const TreeShape& shape, const glm::i64vec3& point, int level) {
    const int last = (1 << (shape.n_shift() * level)) - 1;
    const glm::ivec3 place = glm::ivec3(point >> std::int64_t(LATTICE_BITS - shape.n_shift() * level));
    return {level, glm::clamp(place + glm::ivec3(random.point(-1, 1)), 0, last)};
}

std::string to_string(const Tile& tile) {
    return fmt::format("level {}, tile ({} {} {})", tile.level, tile.position.x, tile.position.y,
                       tile.position.z);
}

TEST_P(SurfaceOracleTest, MaskIsWhatADirectVoxelizationOfTheChildrenSays) {
    const TreeShape shape = make_tree_shape_within(GetParam().n, 16, GetParam().max_resolution);
    const voxelizer::Surface surface = random_surface(21);
    const voxelizer::GpuSurface uploaded = upload(surface);
    voxelizer::TriangleIndex lists = tile_lists(shape, surface);
    voxelizer::ConservativeVoxelizer voxelizer;
    SurfaceOracle oracle(shape, uploaded, voxelizer, lists);
    Random random(22);
    int part_full = 0;
    for (int level = 0; level < shape.max_level; ++level) {
        for (int i = 0; i < 12; ++i) {
            const auto& positions = surface.chunks[0].positions;
            const auto& p = positions[std::size_t(random.between(0, std::int64_t(positions.size()) - 1))];
            const Tile tile = tile_near(random, shape, {p[0], p[1], p[2]}, level);
            const glm::uvec2 truth = true_mask(shape, surface, tile);
            ASSERT_EQ(oracle.child_mask(tile), truth) << "seeds 21 and 22, " << to_string(tile);
            part_full += truth != glm::uvec2(0) ? 1 : 0;
        }
    }
    EXPECT_GT(part_full, 5 * shape.max_level) << "too many of the tiles were empty to prove anything";
}

TEST_P(SurfaceOracleTest, TileIsEmptyExactlyWhenAllItsChildrenAre) {
    // The levels include those where one pyramid ends and the next begins.
    const TreeShape shape = make_tree_shape_within(GetParam().n, 16, GetParam().max_resolution);
    const voxelizer::Surface surface = random_surface(23);
    const voxelizer::GpuSurface uploaded = upload(surface);
    voxelizer::TriangleIndex lists = tile_lists(shape, surface);
    voxelizer::ConservativeVoxelizer voxelizer;
    SurfaceOracle oracle(shape, uploaded, voxelizer, lists);
    Random random(24);
    for (int walk = 0; walk < 6; ++walk) {
        Tile tile;
        while (tile.level + 1 < shape.max_level) {
            const glm::uvec2 mask = oracle.child_mask(tile);
            int full = -1;
            for (int i = 0; i < shape.child_count(); ++i) {
                const bool occupied = (mask[i / 32] >> (i % 32) & 1U) != 0;
                const Tile child = child_of(tile, shape.n, i);
                ASSERT_EQ(oracle.child_mask(child) != glm::uvec2(0), occupied) << to_string(child);
                if (occupied && (full < 0 || random.between(0, 2) == 0)) full = i;
            }
            ASSERT_GE(full, 0) << to_string(tile);
            tile = child_of(tile, shape.n, full);
        }
    }
}

TEST_P(SurfaceOracleTest, FinestTilesHaveNoChildren) {
    const TreeShape shape = make_tree_shape_within(GetParam().n, 16, GetParam().max_resolution);
    const voxelizer::Surface surface = random_surface(25);
    const voxelizer::GpuSurface uploaded = upload(surface);
    voxelizer::TriangleIndex lists = tile_lists(shape, surface);
    voxelizer::ConservativeVoxelizer voxelizer;
    SurfaceOracle oracle(shape, uploaded, voxelizer, lists);
    Random random(26);
    for (const auto& p : surface.chunks[0].positions) {
        const Tile tile = tile_near(random, shape, {p[0], p[1], p[2]}, shape.max_level);
        ASSERT_EQ(oracle.child_mask(tile), glm::uvec2(0)) << to_string(tile);
    }
}

TEST_P(SurfaceOracleTest, EmptySurfaceHasEmptyTiles) {
    const TreeShape shape = make_tree_shape_within(GetParam().n, 16, GetParam().max_resolution);
    const voxelizer::Surface surface = lattice_surface({}, 4096);
    const voxelizer::GpuSurface uploaded = upload(surface);
    voxelizer::TriangleIndex lists = tile_lists(shape, surface);
    voxelizer::ConservativeVoxelizer voxelizer;
    SurfaceOracle oracle(shape, uploaded, voxelizer, lists);
    EXPECT_EQ(oracle.child_mask({}), glm::uvec2(0));
    EXPECT_EQ(oracle.child_mask({shape.max_level - 1, {3, 2, 1}}), glm::uvec2(0));
}

INSTANTIATE_TEST_SUITE_P(Depths, SurfaceOracleTest,
                         ::testing::Values(Shape{4, 64}, Shape{4, 65536}, Shape{4, 262144}, Shape{2, 65536},
                                           Shape{2, 262144}),
                         [](const auto& shape) {
                             return fmt::format("N{}Resolution{}", shape.param.n, shape.param.max_resolution);
                         });

}  // namespace
}  // namespace cairn::renderer
