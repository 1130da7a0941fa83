// Produced bricks against the exact reference, their neighbours, and colours that are predicted by hand.
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/pool/packed_bricks.h"
#include "renderer/produce/tile_lists.h"
#include "shaders/interop/grid.h"
#include "shaders/interop/surface.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/produced_brick.h"
#include "voxelizer/surface/surface_attributes.h"

namespace cairn::renderer {
namespace {

using namespace cairn::test;

struct Shape {
    int n, m;
    bool has_color;
};

std::string to_string(const Tile& tile) {
    return fmt::format("level {}, tile ({} {} {})", tile.level, tile.position.x, tile.position.y,
                       tile.position.z);
}

void add_attributes(voxelizer::Surface& surface) {
    for (voxelizer::SurfaceChunk& chunk : surface.chunks)
        chunk.attributes.assign(chunk.positions.size(),
                                voxelizer::surface_attributes(0, glm::u16vec4(65535), glm::vec2(0.0F)));
}

interop::SurfaceMaterial colored(const glm::vec3& color) {
    interop::SurfaceMaterial material{};
    material.base_color = glm::vec4(color, 1.0F);
    return material;
}

voxelizer::Surface random_surface(int count, bool has_color, std::uint32_t seed) {
    Random random(seed);
    std::vector<LatticeTriangle> triangles;
    triangles.reserve(std::size_t(count));
    for (int i = 0; i < count; ++i)
        triangles.push_back(random_triangle(random, lattice_side >> random.between(4, 12)));
    voxelizer::Surface surface = lattice_surface(triangles, 4096);
    add_attributes(surface);
    surface.has_color = has_color;
    surface.materials = {colored({1.0F, 1.0F, 1.0F}), colored({0.5F, 0.1F, 0.9F}),
                         colored({0.0F, 0.7F, 0.2F})};
    for (interop::SurfaceTriangle& triangle : surface.chunks[0].triangles)
        triangle.material = std::uint32_t(random.between(0, 2));
    return surface;
}

/// A tile that holds a vertex of the surface, or one beside it.
Tile tile_near_vertex(Random& random, const TreeShape& shape, const voxelizer::Surface& surface, int level) {
    const auto& positions = surface.chunks[0].positions;
    const auto& p = positions[std::size_t(random.between(0, std::int64_t(positions.size()) - 1))];
    const glm::ivec3 place = glm::ivec3(p[0], p[1], p[2]) >> (LATTICE_BITS - shape.n_shift() * level);
    const int last = (1 << (shape.n_shift() * level)) - 1;
    return {level, glm::clamp(place + glm::ivec3(random.point(-1, 1)), 0, last)};
}

void expect_occupancy(const voxelizer::Surface& surface, const TreeShape& shape, const Tile& tile,
                      const ProducedBrick& brick) {
    const int level = shape.voxel_level(tile.level);
    const glm::ivec3 low = glm::ivec3(tile.position) * shape.m;
    EXPECT_TRUE(
        same_bits(mask_bits(brick), reference::exact_voxels(surface, {level, low, glm::ivec3(shape.m)})))
        << "masks, " << to_string(tile);
    if (mask_bits(brick).count() != 0) {  // a brick whose border alone is occupied is not kept
        EXPECT_TRUE(same_bits(coverage_bits(brick),
                              reference::exact_voxels(surface, {level, low - 1, glm::ivec3(shape.m + 2)})))
            << "coverage, " << to_string(tile);
    }
    for (int z = 0; z < shape.m / 4; ++z) {
        for (int y = 0; y < shape.m / 4; ++y) {
            for (int x = 0; x < shape.m / 4; ++x) {
                bool any = false;
                for (int i = 0; i < 64; ++i)
                    any |= brick.occupied(4 * glm::ivec3(x, y, z) + glm::ivec3(i % 4, i / 4 % 4, i / 16));
                ASSERT_EQ(brick.summary_at({x, y, z}), any)
                    << "summary of block (" << x << ' ' << y << ' ' << z << "), " << to_string(tile);
            }
        }
    }
}

class SurfaceProducerTest : public GlTest, public ::testing::WithParamInterface<Shape> {
protected:
    [[nodiscard]] static TreeShape shape() {
        return make_tree_shape_within(GetParam().n, GetParam().m, 65536);
    }
};

TEST_P(SurfaceProducerTest, BricksHoldExactlyTheOccupiedVoxelsBorderIncluded) {
    const voxelizer::Surface surface = random_surface(150, GetParam().has_color, 41);
    ASSERT_TRUE(surface.far_triangles.empty());
    std::vector<Tile> tiles = {{0, glm::ivec3(0)}};
    Random random(42);
    for (int level = 1; level <= shape().max_level; ++level) {
        for (int i = 0; i < (GetParam().m == 32 ? 2 : 4); ++i)
            tiles.push_back(tile_near_vertex(random, shape(), surface, level));
    }
    BrickMaker maker(shape(), surface, int(tiles.size()) * 2);
    const std::vector<ProducedBrick> bricks = maker.produce(tiles);
    SCOPED_TRACE("seeds 41 and 42");
    for (std::size_t i = 0; i < tiles.size() && !HasFailure(); ++i)
        expect_occupancy(surface, shape(), tiles[i], bricks[i]);
}

TEST_P(SurfaceProducerTest, NeighboursAgreeOnTheTexelsTheyShare) {
    const voxelizer::Surface surface = random_surface(400, GetParam().has_color, 43);
    std::vector<Tile> tiles;
    tiles.reserve(8);
    for (int i = 0; i < 8; ++i)
        tiles.push_back({1, glm::ivec3(i % 2, i / 2 % 2, i / 4)});
    BrickMaker maker(shape(), surface, 16);
    const std::vector<ProducedBrick> bricks = maker.produce(tiles);
    const int m = shape().m;
    // Two voxels on each side of the planes between the eight bricks.
    int shared = 0;
    auto compare = [&](const glm::ivec3& voxel) {
        const ProducedBrick* first = nullptr;
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            const glm::ivec3 place = voxel - glm::ivec3(tiles[i].position) * m;
            if (glm::any(glm::lessThan(place, glm::ivec3(-1))) ||
                glm::any(glm::greaterThan(place, glm::ivec3(m))))
                continue;
            if (first == nullptr) {
                first = &bricks[i];
                continue;
            }
            ++shared;
            const std::size_t a =
                first->index(voxel - glm::ivec3(tiles[std::size_t(first - bricks.data())].position) * m);
            const std::size_t b = bricks[i].index(place);
            ASSERT_EQ(first->color[a], bricks[i].color[b])
                << "colour of voxel " << voxel.x << ' ' << voxel.y << ' ' << voxel.z;
            ASSERT_EQ(first->normal[a], bricks[i].normal[b])
                << "normal of voxel " << voxel.x << ' ' << voxel.y << ' ' << voxel.z;
        }
    };
    for (int z = 0; z < 2 * m; ++z) {
        for (int y = 0; y < 2 * m; ++y) {
            for (int x = 0; x < 2 * m; ++x)
                compare({x, y, z});
        }
    }
    EXPECT_EQ(shared, (2 * m + 2) * (2 * m + 2) * (2 * m + 2) - 8 * m * m * m) << "voxels that were compared";
}

TEST_P(SurfaceProducerTest, TileHasTheSameTexelsAloneAndAmongHundreds) {
    const voxelizer::Surface surface = random_surface(200, GetParam().has_color, 44);
    // More tiles than are sent to the GPU at once.
    const int count = GetParam().m == 8 ? 1000 : GetParam().m == 16 ? 200 : 60;
    Random random(45);
    std::vector<Tile> tiles;
    tiles.reserve(std::size_t(count));
    for (int i = 0; i < count; ++i)
        tiles.push_back(tile_near_vertex(random, shape(), surface, int(random.between(1, 2))));
    BrickMaker maker(shape(), surface, count * 5 / 4);
    ASSERT_GE(maker.pool().slot_count(), count);
    const std::vector<ProducedBrick> together = maker.produce(tiles);
    // All bricks go to the first slot in turn: it must be written completely.
    for (std::size_t i = 0; i < tiles.size(); i += tiles.size() / 12)
        EXPECT_TRUE(maker.produce_one(tiles[i]) == together[i]) << "seeds 44 and 45, " << to_string(tiles[i]);
}

TEST_P(SurfaceProducerTest, EmptyTileIsToldAndTakesNoRoom) {
    voxelizer::Surface surface = random_surface(50, GetParam().has_color, 46);
    // All triangles are in the lower half.
    for (auto& p : surface.chunks[0].positions)
        p[1] = p[1] / 4;
    const voxelizer::GpuSurface uploaded = upload(surface);
    voxelizer::TriangleIndex lists = tile_lists(shape(), surface);
    SurfaceProducer producer(shape(), uploaded, lists, {});
    BrickPool pool(shape(), {.color = surface.has_color, .packed = true},
                   4 * least_packed_bytes(shape(), surface.has_color));
    const std::size_t all = pool.packed()->free_words();
    const std::vector<BrickRequest> requests = {{{1, {0, GetParam().n - 1, 0}}, 0},
                                                {{0, glm::i64vec3(0)}, 1}};
    const std::vector<ProducedTile> produced = producer.produce(requests, pool);
    EXPECT_TRUE(produced[0].constant);
    EXPECT_FALSE(pool.packed()->has_room(0));
    EXPECT_FALSE(produced[1].constant);
    EXPECT_TRUE(pool.packed()->has_room(1));
    EXPECT_LT(pool.packed()->free_words(), all);
    pool.release(1);
    EXPECT_EQ(pool.packed()->free_words(), all);
}

TEST_P(SurfaceProducerTest, TrianglesOfEveryChunkAreInTheBrick) {
    voxelizer::Surface surface = random_surface(40, GetParam().has_color, 47);
    const voxelizer::Surface more = random_surface(40, GetParam().has_color, 48);
    surface.chunks.push_back(more.chunks[0]);
    surface.triangle_count += more.triangle_count;
    BrickMaker maker(shape(), surface, 1);
    for (const Tile& tile : {Tile{}, Tile{1, {1, 1, 1}}, Tile{1, {1, 0, 1}}})
        expect_occupancy(surface, shape(), tile, maker.produce_one(tile));
}

INSTANTIATE_TEST_SUITE_P(Shapes, SurfaceProducerTest,
                         ::testing::Values(Shape{4, 16, false}, Shape{4, 16, true}, Shape{2, 8, false},
                                           Shape{2, 8, true}, Shape{4, 32, true}, Shape{2, 32, false}),
                         [](const auto& shape) {
                             return fmt::format("N{}M{}{}", shape.param.n, shape.param.m,
                                                shape.param.has_color ? "Colour" : "");
                         });

}  // namespace
}  // namespace cairn::renderer
