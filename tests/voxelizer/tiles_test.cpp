// Voxels that arrive tile by tile, against the same grid voxelized at once.
#include <tuple>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/voxelizer_fixture.h"
#include "voxelizer/methods/conservative_voxelizer.h"
#include "voxelizer/methods/voxelize_tiles.h"
#include "voxelizer/solid/solid_tiles.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;

constexpr int side = 32;

/// Puts tiles together, and checks that they arrive in the order of VoxelWriter.
class Collector {
public:
    explicit Collector(const Grid& grid) : whole(grid.resolution) {}

    void add(const VoxelTile& tile) {
        ++tiles;
        const glm::ivec3 o = tile.origin;
        EXPECT_EQ(o % side, glm::ivec3(0));
        EXPECT_EQ(tile.bits.size, glm::min(whole.size - o, glm::ivec3(side)));
        EXPECT_GT(tile.bits.count(), 0U);
        const std::tuple order(o.x, o.z, o.y);
        EXPECT_TRUE(last_ < order) << fmt::format("({} {} {}) came too late", o.x, o.y, o.z);
        last_ = order;
        for (int z = 0; z < tile.bits.size.z; ++z) {
            for (int y = 0; y < tile.bits.size.y; ++y) {
                for (int x = 0; x < tile.bits.size.x; ++x) {
                    if (tile.bits.at({x, y, z})) whole.set(o + glm::ivec3(x, y, z));
                }
            }
        }
    }

    BitGrid whole;
    std::size_t tiles = 0;

private:
    std::tuple<int, int, int> last_{-1, -1, -1};
};

class TilesTest : public ConservativeTest {
protected:
    /// Checks that bits are the same if marked at once, in a region per tile, or in regions of many tiles.
    TileStatistics expect_as_whole(const Surface& surface, const std::string& what) {
        const GpuSurface on_gpu = upload(surface);
        const BitGrid truth = voxelizer().voxelize(on_gpu, whole(surface.grid));
        TileStatistics last;
        for (const std::size_t region_bytes : {0, 1 << 15, 1 << 17, 1 << 24}) {
            TriangleIndex index(surface);
            Collector collector(surface.grid);
            last = voxelize_tiles(
                voxelizer(), on_gpu, index, surface.grid, [&](VoxelTile&& tile) { collector.add(tile); }, {},
                {.tile_side = side, .whole_bytes = region_bytes, .region_bytes = region_bytes});
            EXPECT_TRUE(same_bits(collector.whole, truth)) << what << ", region of " << region_bytes;
            EXPECT_EQ(last.occupied, truth.count()) << what;
            EXPECT_EQ(last.tiles, collector.tiles) << what;
        }
        return last;
    }
};

const glm::ivec3 shapes[] = {{100, 100, 100}, {33, 70, 129}, {200, 31, 65},
                             {1, 1, 1},       {1, 97, 2},    {64, 64, 64}};

std::string to_string(const glm::ivec3& v) {
    return fmt::format("{} x {} x {}", v.x, v.y, v.z);
}

TEST_F(TilesTest, OfAnySizeAndShapeHaveTheBitsOfTheWhole) {
    const scenes::Scene scene = scenes::make_builtin("knot");
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    for (const glm::ivec3& shape : shapes) {
        const Surface surface = build_surface(scene, snapshot, grid_around(snapshot.bounds, shape));
        EXPECT_GT(expect_as_whole(surface, to_string(shape)).occupied, 0U);
    }
}

TEST_F(TilesTest, FilledSolidHaveTheBitsOfTheWholeFilled) {
    const scenes::Scene scene = scenes::make_builtin("knot");
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    for (const glm::ivec3& shape : shapes) {
        const Surface surface =
            build_surface(scene, snapshot, grid_around(snapshot.bounds, shape), {.outside = true});
        const SolidFill fill(surface, whole(surface.grid));
        const GpuSurface on_gpu = upload(surface);
        BitGrid truth = voxelizer().voxelize(on_gpu, whole(surface.grid));
        const std::uint64_t shell = truth.count();
        fill.add_interior(glm::ivec3(0), truth);
        TriangleIndex index(surface);
        Collector collector(surface.grid);
        SolidTiles solid(surface, surface.grid, {}, side);
        const TileSink sink = [&](VoxelTile&& tile) { collector.add(tile); };
        (void)voxelize_tiles(voxelizer(), on_gpu, index, surface.grid,
                             [&](VoxelTile&& tile) { solid.add(std::move(tile), sink); }, {},
                             {.tile_side = side});
        solid.finish(sink);
        EXPECT_TRUE(same_bits(collector.whole, truth)) << to_string(shape);
        EXPECT_EQ(solid.occupied(), truth.count()) << to_string(shape);
        if (shape == shapes[0]) {
            EXPECT_GT(solid.occupied(), shell + 1000) << "nothing was filled";
        }
    }
}

TEST_F(TilesTest, OfRandomTrianglesOnVoxelPlanesHaveTheBitsOfTheWhole) {
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        Random random(seed);
        std::vector<LatticeTriangle> triangles;
        for (int i = 0; i < 40; ++i)
            triangles.push_back(random_triangle(random, lattice_side / 128));
        Surface surface = lattice_surface(triangles, 128);
        surface.grid.resolution = {int(random.between(65, 128)), int(random.between(1, 128)), 100};
        expect_as_whole(surface, fmt::format("seed {}", seed));
    }
}

TEST_F(TilesTest, OfFarTrianglesHaveTheBitsOfTheWhole) {
    Random random(8);
    std::uint64_t occupied = 0;
    for (int i = 0; i < 8; ++i) {
        LatticeTriangle t;
        t[0] = random.point(0, lattice_side);
        t[1] = random.point(-10 * lattice_side, 10 * lattice_side);
        t[2] = random.point(-10 * lattice_side, 10 * lattice_side);
        const Surface surface = lattice_surface({t}, 100);
        ASSERT_EQ(surface.far_triangles.size(), 1U);
        occupied += expect_as_whole(surface, fmt::format("triangle {}", i)).occupied;
    }
    EXPECT_GT(occupied, 1000U);
}

TEST_F(TilesTest, OfAMaskedSceneHaveTheBitsOfTheWhole) {
    const scenes::Scene scene = scenes::make_builtin("tree-leaves");
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    const Surface surface = build_surface(scene, snapshot, grid_around(snapshot.bounds, {34, 66, 40}));
    ASSERT_TRUE(surface.has_mask);
    EXPECT_GT(expect_as_whole(surface, "tree-leaves").occupied, 0U);
}

TEST_F(TilesTest, OfAnEmptySceneAreNone) {
    const scenes::Scene scene;
    const Surface surface = build_surface(scene, {}, grid_around({}, {100, 40, 70}));
    EXPECT_EQ(expect_as_whole(surface, "empty").tiles, 0U);
}

TEST_F(TilesTest, WhereNothingIsCostNothing) {
    // A triangle in each of two opposite corners of 4096^3: a region each, and the rest is never marked.
    const std::int64_t end = lattice_side - 5;
    const Surface surface =
        lattice_surface({{glm::i64vec3(5), {900, 5, 5}, {5, 900, 5}},
                         {glm::i64vec3(end), {end - 900, end, end}, {end, end, end - 900}}},
                        4096);
    TriangleIndex index(surface);
    std::vector<glm::ivec3> origins;
    const TileStatistics statistics =
        voxelize_tiles(voxelizer(), upload(surface), index, surface.grid,
                       [&](VoxelTile&& tile) { origins.push_back(tile.origin); });
    EXPECT_EQ(statistics.regions, 2U);
    EXPECT_EQ(statistics.triangles, 2U);
    EXPECT_EQ(origins, (std::vector<glm::ivec3>{glm::ivec3(0), glm::ivec3(4096 - VOXEL_TILE_SIDE)}));
}

TEST_F(TilesTest, StopWhenTheProgressSaysSo) {
    const Surface surface =
        lattice_surface({{glm::i64vec3(5), {lattice_side - 5, 5, 77}, {5, 900, 5}}}, 1024);
    const GpuSurface on_gpu = upload(surface);
    TriangleIndex index(surface);
    double last = -1.0;
    int asked = 0;
    std::size_t tiles = 0;
    try {
        (void)voxelize_tiles(
            voxelizer(), on_gpu, index, surface.grid, [&](VoxelTile&&) { ++tiles; },
            [&](double share) {
                EXPECT_GE(share, last);
                EXPECT_LE(share, 1.0);
                last = share;
                return ++asked < 5;
            });
        FAIL() << "went on";
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::interrupted);
    }
    EXPECT_EQ(asked, 5);
    EXPECT_LT(tiles, 5U);
}

TEST_F(TilesTest, OfASideThatCutsWordsAreRefused) {
    const Surface surface = lattice_surface({{glm::i64vec3(5), {900, 5, 5}, {5, 900, 5}}}, 64);
    TriangleIndex index(surface);
    for (const int bad : {0, -32, 33, 16}) {
        EXPECT_THROW((void)voxelize_tiles(voxelizer(), upload(surface), index, surface.grid,
                                          [](VoxelTile&&) {}, {}, {.tile_side = bad}),
                     Error)
            << bad;
    }
}

}  // namespace
}  // namespace cairn::voxelizer
