// Grids that are not cubes, and grids by the size of a voxel.
#include <gtest/gtest.h>

#include "base/error.h"
#include "voxelizer/grid.h"

namespace cairn::voxelizer {
namespace {

scenes::Bounds box(const glm::dvec3& low, const glm::dvec3& high) {
    scenes::Bounds bounds;
    bounds.add(low);
    bounds.add(high);
    return bounds;
}

/// Distances from the bounds to the grid's sides, in voxels.
struct Margins {
    glm::dvec3 low, high;
};
Margins margins(const Grid& grid, const scenes::Bounds& bounds) {
    const glm::dvec3 end = grid.origin + glm::dvec3(grid.resolution) * grid.voxel_size;
    return {(bounds.low - grid.origin) / grid.voxel_size, (end - bounds.high) / grid.voxel_size};
}

TEST(GridShape, AroundABoxEveryAxisKeepsAnEmptyVoxelOnEachSideAndOneNoMore) {
    const scenes::Bounds bounds = box({-3, 1, 10}, {5, 4, 11});
    for (const glm::ivec3& resolution :
         {glm::ivec3(40, 70, 129), glm::ivec3(129, 40, 70), glm::ivec3(10, 1000, 1000), glm::ivec3(3)}) {
        const Grid grid = grid_around(bounds, resolution);
        EXPECT_EQ(grid.resolution, resolution);
        const Margins m = margins(grid, bounds);
        double tightest = 1e300;
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GT(m.low[axis], 1.0) << resolution.x << ", axis " << axis;
            EXPECT_NEAR(m.low[axis], m.high[axis], 1e-9) << "not centred";
            tightest = std::min(tightest, m.low[axis]);
        }
        EXPECT_LT(tightest, 1.1) << "voxels could be smaller";
    }
}

TEST(GridShape, OverBoundsTheLowCornerIsKeptAndTheTightestAxisIsFilled) {
    const scenes::Bounds bounds = box({-3, 1, 10}, {5, 4, 11});
    const Grid grid = grid_over(bounds, glm::ivec3(16, 3, 8));
    EXPECT_EQ(grid.origin, bounds.low);
    EXPECT_EQ(grid.voxel_size, 1.0) << "y: three voxels for three units";
    const Grid wide = grid_over(bounds, glm::ivec3(4, 300, 300));
    EXPECT_EQ(wide.voxel_size, 2.0) << "x: four voxels for eight units";
}

TEST(GridShape, VoxelsOfASizeAroundABoxLeaveOneEmptyOnEachSide) {
    const scenes::Bounds bounds = box({-3, 1, 10}, {5, 4, 11});
    for (const double size : {0.1, 0.37, 1.0, 2.5, 1000.0}) {
        const Grid grid = grid_of_voxels_around(bounds, size);
        EXPECT_EQ(grid.voxel_size, size);
        const Margins m = margins(grid, bounds);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GT(m.low[axis], 1.0) << size << ", axis " << axis;
            EXPECT_LT(m.low[axis], 1.6) << size << ", axis " << axis << ": one voxel fewer would do";
            EXPECT_NEAR(m.low[axis], m.high[axis], 1e-9);
        }
    }
    EXPECT_EQ(grid_of_voxels_around(box({1, 2, 3}, {1, 2, 3}), 0.5).resolution, glm::ivec3(3));
    EXPECT_EQ(grid_of_voxels_around({}, 0.5).resolution, glm::ivec3(1));
}

TEST(GridShape, VoxelsOfASizeOverBoundsCountWhatADecimalQuotientSays) {
    const scenes::Bounds bounds = box({0, 0, 0}, {1.1, 0.3, 0.75});
    const Grid grid = grid_of_voxels_over(bounds, 0.1);
    EXPECT_EQ(grid.origin, bounds.low);
    EXPECT_EQ(grid.resolution, glm::ivec3(11, 3, 8));
}

TEST(GridShape, TooSmallAVoxelIsRefusedWithOneThatFits) {
    const scenes::Bounds bounds = box({0, 0, 0}, {100, 3, 4});
    for (const int limit : {10, 1000, 65536}) {
        for (const auto& make : {grid_of_voxels_around, grid_of_voxels_over}) {
            try {
                (void)make(bounds, 1e-6, limit);
                FAIL() << "accepted";
            } catch (const Error& error) {
                EXPECT_EQ(error.fault(), Fault::usage);
                const double way_out = std::stod(error.way_out());
                const Grid grid = make(bounds, way_out, limit);
                EXPECT_LE(grid.resolution.x, limit) << error.way_out();
                EXPECT_GE(grid.resolution.x, limit / 2) << error.way_out();
            }
        }
    }
    for (const double size : {0.0, -1.0, double(NAN)})
        EXPECT_THROW((void)grid_of_voxels_around(bounds, size), Error) << size;
}

}  // namespace
}  // namespace cairn::voxelizer
