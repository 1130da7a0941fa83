// The triangle lists of tiles against all triangles of all tiles. CPU only.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/produce/tile_lists.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "shaders/interop/grid.h"
#include "shaders/interop/surface.h"
#include "tests/support/lattice_surface.h"

namespace cairn::renderer {
namespace {

using namespace cairn::test;

struct Shape {
    int n, m;
};

class TileListsTest : public ::testing::TestWithParam<Shape> {
protected:
    [[nodiscard]] static TreeShape shape() {
        return make_tree_shape_within(GetParam().n, GetParam().m, 4096);
    }
};

/// A surface without the triangles that miss the root cube, as build_surface() makes it.
voxelizer::Surface random_surface(std::size_t count, std::uint32_t seed) {
    Random random(seed);
    std::vector<LatticeTriangle> triangles;
    while (triangles.size() < count) {
        const LatticeTriangle t = random_triangle(random, lattice_side >> random.between(3, 12));
        const glm::i64vec3 low = glm::min(t[0], glm::min(t[1], t[2]));
        const glm::i64vec3 high = glm::max(t[0], glm::max(t[1], t[2]));
        if (glm::any(glm::lessThan(high, glm::i64vec3(0)))) continue;
        if (glm::any(glm::greaterThan(low, glm::i64vec3(lattice_side)))) continue;
        triangles.push_back(t);
    }
    return lattice_surface(triangles, 4096);
}

voxelizer::Surface knot() {
    const scenes::Scene scene = scenes::make_builtin("knot");
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    return build_surface(scene, snapshot, voxelizer::grid_around(snapshot.bounds, 4096));
}

/// Bounding boxes against the tile and one voxel around it, both closed.
std::vector<std::uint32_t> brute_force(const TreeShape& shape, const voxelizer::Surface& surface,
                                       const Tile& tile) {
    const std::int64_t side = lattice_side >> (shape.n_shift() * tile.level);
    const std::int64_t border = lattice_side >> shape.voxel_level(tile.level);
    const glm::i64vec3 low = glm::i64vec3(tile.position) * side - border;
    const glm::i64vec3 high = low + side + 2 * border;
    std::vector<std::uint32_t> numbers;
    for (std::size_t chunk = 0; chunk < surface.chunks.size(); ++chunk) {
        const voxelizer::SurfaceChunk& part = surface.chunks[chunk];
        for (std::size_t i = 0; i < part.triangles.size(); ++i) {
            glm::i64vec3 from(INT64_MAX);
            glm::i64vec3 to(INT64_MIN);
            for (int corner = 0; corner < 3; ++corner) {
                const auto& p = part.positions[part.triangles[i].vertices[corner]];
                from = glm::min(from, glm::i64vec3(p[0], p[1], p[2]));
                to = glm::max(to, glm::i64vec3(p[0], p[1], p[2]));
            }
            if (glm::any(glm::lessThan(to, low)) || glm::any(glm::greaterThan(from, high))) continue;
            numbers.push_back(std::uint32_t(chunk * surface.chunk_triangles + i));
        }
    }
    return numbers;
}

Tile random_tile(Random& random, const TreeShape& shape, int level) {
    const std::int64_t last = (std::int64_t(1) << (shape.n_shift() * level)) - 1;
    return {level, glm::ivec3(random.point(0, last))};
}

/// The tile of a level that holds a vertex of the surface.
Tile tile_at_vertex(Random& random, const TreeShape& shape, const voxelizer::Surface& surface, int level) {
    const auto& positions = surface.chunks[0].positions;
    const auto& p = positions[std::size_t(random.between(0, std::int64_t(positions.size()) - 1))];
    const glm::ivec3 place = glm::clamp(glm::ivec3(p[0], p[1], p[2]), 0, int(lattice_side) - 1);
    return {level, place >> (LATTICE_BITS - shape.n_shift() * level)};
}

/// Every list equals brute force, triangle by triangle.
std::size_t expect_same_lists(voxelizer::TriangleIndex& lists, const TreeShape& shape,
                              const voxelizer::Surface& surface, int tiles_a_level, int seed) {
    Random random{std::uint32_t(seed)};
    std::size_t listed = 0;
    for (int i = 0; i < tiles_a_level; ++i) {
        for (int level = shape.max_level; level >= 0; --level) {
            const Tile tile = i % 3 == 0 ? random_tile(random, shape, level)
                                         : tile_at_vertex(random, shape, surface, level);
            const std::span<const std::uint32_t> list = lists.list(cell_of(tile, shape));
            const std::vector<std::uint32_t> truth = brute_force(shape, surface, tile);
            listed += truth.size();
            EXPECT_TRUE(std::equal(list.begin(), list.end(), truth.begin(), truth.end()))
                << fmt::format("seed {}, level {}, tile ({} {} {}): {} listed, {} meet it", seed, level,
                               tile.position.x, tile.position.y, tile.position.z, list.size(), truth.size());
        }
    }
    return listed;
}

TEST_P(TileListsTest, HoldExactlyWhatMeetsTheTileAndItsBorder) {
    const voxelizer::Surface surface = random_surface(400, 11);
    ASSERT_TRUE(surface.far_triangles.empty());
    voxelizer::TriangleIndex lists = tile_lists(shape(), surface);
    EXPECT_GT(expect_same_lists(lists, shape(), surface, 150, 12), 1000U);
}

TEST_P(TileListsTest, HoldExactlyWhatMeetsTheTileInARealScene) {
    const voxelizer::Surface surface = knot();
    voxelizer::TriangleIndex lists = tile_lists(shape(), surface);
    EXPECT_GT(expect_same_lists(lists, shape(), surface, 12, 13), 1000U);
}

TEST_P(TileListsTest, LoseNothingWhenWhatTheyHoldIsDropped) {
    const voxelizer::Surface surface = random_surface(400, 14);
    for (const std::size_t held : {0, 500, 5000}) {
        voxelizer::TriangleIndex lists = tile_lists(shape(), surface, held);
        expect_same_lists(lists, shape(), surface, 40, 15);
    }
}

TEST_P(TileListsTest, CountFacesOnTheTilesSidesToBothNeighbours) {
    // A square in the plane between the two halves of the cube, and one a border further on.
    const std::int64_t half = lattice_side / 2;
    const std::int64_t voxel = lattice_side >> shape().voxel_level(1);
    auto square = [](std::int64_t x) { return LatticeTriangle{{{x, 5, 5}, {x, 900, 5}, {x, 5, 900}}}; };
    const voxelizer::Surface surface =
        lattice_surface({square(half), square(half + voxel), square(half + voxel + 1)}, 4096);
    voxelizer::TriangleIndex lists = tile_lists(shape(), surface);
    const int n = shape().n;
    const std::span<const std::uint32_t> left = lists.list({shape().n_shift(), {n / 2 - 1, 0, 0}});
    EXPECT_EQ(std::vector<std::uint32_t>(left.begin(), left.end()), (std::vector<std::uint32_t>{0, 1}));
    const std::span<const std::uint32_t> right = lists.list({shape().n_shift(), {n / 2, 0, 0}});
    EXPECT_EQ(std::vector<std::uint32_t>(right.begin(), right.end()), (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST_P(TileListsTest, NumberTrianglesAcrossChunks) {
    voxelizer::Surface surface = random_surface(50, 16);
    const voxelizer::Surface more = random_surface(60, 17);
    surface.chunks.push_back(more.chunks[0]);
    surface.triangle_count += more.triangle_count;
    voxelizer::TriangleIndex lists = tile_lists(shape(), surface);
    EXPECT_GT(expect_same_lists(lists, shape(), surface, 30, 18), 100U);
}

INSTANTIATE_TEST_SUITE_P(NAndM, TileListsTest, ::testing::Values(Shape{4, 16}, Shape{2, 8}, Shape{2, 32}),
                         [](const auto& shape) {
                             return fmt::format("N{}M{}", shape.param.n, shape.param.m);
                         });

}  // namespace
}  // namespace cairn::renderer
