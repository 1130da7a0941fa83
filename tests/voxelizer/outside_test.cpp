// What the outside reaches: against a search voxel by voxel, and the voxels that it finds doubtful.
#include "voxelizer/solid/outside.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "tests/support/closed_meshes.h"
#include "voxelizer/solid/solid_tiles.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;

constexpr std::size_t plenty = std::size_t(1) << 30;
constexpr int side = 32;

template <typename Visit>
void for_each_voxel(const glm::ivec3& size, const Visit& visit) {
    for (int z = 0; z < size.z; ++z) {
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x)
                visit(glm::ivec3(x, y, z));
        }
    }
}

/// The free voxels that a search finds, one voxel after the other, from all sides of a grid.
BitGrid searched(const BitGrid& surface) {
    BitGrid found(surface.size);
    std::vector<glm::ivec3> waiting;
    const auto visit = [&](const glm::ivec3& v) {
        if (surface.at(v) || found.at(v)) return;
        found.set(v);
        waiting.push_back(v);
    };
    for_each_voxel(surface.size, [&](const glm::ivec3& v) {
        if (glm::any(glm::equal(v, glm::ivec3(0))) || glm::any(glm::equal(v, surface.size - 1))) visit(v);
    });
    while (!waiting.empty()) {
        const glm::ivec3 v = waiting.back();
        waiting.pop_back();
        for (int axis = 0; axis < 3; ++axis) {
            for (const int step : {-1, 1}) {
                glm::ivec3 beside = v;
                beside[axis] += step;
                if (beside[axis] >= 0 && beside[axis] < surface.size[axis]) visit(beside);
            }
        }
    }
    return found;
}

BitGrid part(const BitGrid& whole, const glm::ivec3& origin, const glm::ivec3& size) {
    BitGrid bits(size);
    for_each_voxel(size, [&](const glm::ivec3& v) {
        if (whole.at(origin + v)) bits.set(v);
    });
    return bits;
}

template <typename Visit>
void for_each_tile(const glm::ivec3& size, const Visit& visit) {
    for_each_voxel((size - 1) / side + 1, [&](const glm::ivec3& place) {
        visit(place * side, glm::min(size - place * side, glm::ivec3(side)));
    });
}

void expect_as_searched(const BitGrid& surface, const std::string& what) {
    const Region region{8, {17, 3, 40}, surface.size};
    Outside outside(lattice_surface({}, 256), region, plenty);
    for_each_tile(surface.size, [&](const glm::ivec3& origin, const glm::ivec3& size) {
        const BitGrid tile = part(surface, origin, size);
        if (tile.count() == 0) return;
        ASSERT_TRUE(outside.add_surface(region.origin + origin, tile));
    });
    outside.flood();
    const BitGrid truth = searched(surface);
    ASSERT_TRUE(same_bits(outside.reached(region.origin, surface.size), truth)) << what;
    BitGrid enclosed(surface.size);
    BitGrid solid(surface.size);
    for_each_voxel(surface.size, [&](const glm::ivec3& v) {
        if (!truth.at(v)) solid.set(v);
        if (!truth.at(v) && !surface.at(v)) enclosed.set(v);
    });
    for_each_tile(surface.size, [&](const glm::ivec3& origin, const glm::ivec3& size) {
        const glm::ivec3 place = region.origin + origin;
        ASSERT_TRUE(same_bits(outside.enclosed(place, size), part(enclosed, origin, size))) << what;
        ASSERT_TRUE(same_bits(outside.solid(place, size), part(solid, origin, size))) << what;
    });
}

TEST(Outside, ReachesWhatASearchVoxelByVoxelReaches) {
    constexpr std::uint32_t seed = 31;
    Random random(seed);
    const std::vector<glm::ivec3> sizes = {
        {70, 41, 65}, {32, 64, 33}, {1, 100, 40}, {97, 1, 1}, {64, 64, 64}};
    for (const glm::ivec3& size : sizes) {
        // Where about 0.31 of all voxels are free, they begin to join, along long and winding paths.
        for (const double share : {0.0, 0.02, 0.5, 0.66, 0.69, 0.9, 1.0}) {
            BitGrid surface(size);
            for_each_voxel(size, [&](const glm::ivec3& v) {
                if (random.unit() < share) surface.set(v);
            });
            expect_as_searched(surface,
                               fmt::format("seed {}, {} x {} x {}, {}", seed, size.x, size.y, size.z, share));
        }
    }
}

TEST(Outside, FollowsACorridorThroughAllBlocks) {
    for (int axis = 0; axis < 3; ++axis) {
        // Walls along an axis with a gap at alternating ends, in a box that is open at one voxel.
        BitGrid surface(glm::ivec3(80));
        for_each_voxel(surface.size, [&](const glm::ivec3& v) {
            const int along = v[axis];
            const int across = v[(axis + 1) % 3];
            const bool gap = (along / 2) % 2 == 0 ? across < 3 : across > 76;
            const bool shell =
                glm::any(glm::equal(v, glm::ivec3(1))) || glm::any(glm::equal(v, glm::ivec3(78)));
            if ((along % 2 == 0 && !gap) || shell) surface.set(v);
        });
        expect_as_searched(surface, fmt::format("closed, axis {}", axis));
        glm::ivec3 door(2);
        door[axis] = 1;
        surface.words[surface.word_index(door.x, door.y, door.z)] &= ~(1U << (door.x % 32));
        expect_as_searched(surface, fmt::format("with a door, axis {}", axis));
    }
}

Outside flooded(const Mesh& mesh, const Region& region) {
    const Surface surface = lattice_surface(mesh, 1 << region.level);
    Outside outside(surface, region, plenty);
    EXPECT_TRUE(outside.add_surface(region.origin, reference::exact_voxels(surface, region)));
    outside.flood();
    return outside;
}

TEST(Outside, ComesInOverTheSidesOnlyWhereNothingLiesBefore) {
    const Region whole{6, glm::ivec3(0), glm::ivec3(64)};
    const Mesh mesh = joined(sphere(glm::dvec3(lattice_side * 0.5), lattice_side * 0.45, 3),
                             sphere(glm::dvec3(lattice_side * 0.5), lattice_side * 0.1, 2));
    const BitGrid truth = flooded(mesh, whole).solid(whole.origin, whole.size);
    EXPECT_GT(truth.count(), 50000U);
    constexpr std::uint32_t seed = 32;
    Random random(seed);
    for (int i = 0; i < 40; ++i) {
        Region cut{6, {}, {}};
        for (int axis = 0; axis < 3; ++axis) {
            cut.origin[axis] = int(random.between(0, 40));
            cut.size[axis] = int(random.between(1, 64 - cut.origin[axis]));
        }
        ASSERT_TRUE(
            same_bits(flooded(mesh, cut).solid(cut.origin, cut.size), part(truth, cut.origin, cut.size)))
            << fmt::format("seed {}, region {}: {} {} {} and {} x {} x {}", seed, i, cut.origin.x,
                           cut.origin.y, cut.origin.z, cut.size.x, cut.size.y, cut.size.z);
    }
}

TEST(Outside, IsStoppedByTrianglesFarBeyondTheRegion) {
    const Region region{4, glm::ivec3(0), glm::ivec3(16)};
    for (const double radius : {1.2, 40000.0}) {
        const Mesh mesh = sphere(glm::dvec3(lattice_side * 0.5), lattice_side * radius, 2);
        EXPECT_EQ(flooded(mesh, region).solid(region.origin, region.size).count(), 16U * 16U * 16U) << radius;
        Surface surface = lattice_surface({}, 16);
        surface.outside_triangles = mesh;
        Outside outside(surface, region, plenty);
        outside.flood();
        EXPECT_EQ(outside.enclosed(region.origin, region.size).count(), 16U * 16U * 16U) << radius;
    }
    EXPECT_EQ(flooded({}, region).reached(region.origin, region.size).count(), 16U * 16U * 16U);
}

/// A solid by a rule: its voxels, and those of them that are doubtful.
struct Solid {
    BitGrid bits, doubtful;
    std::optional<Doubts> doubts;
};
Solid solid_of(const Mesh& mesh, int resolution, SolidRule rule) {
    const Surface surface = lattice_surface(mesh, resolution);
    const Grid& grid = surface.grid;
    Solid out{BitGrid(grid.resolution), BitGrid(grid.resolution), {}};
    const auto collect = [](BitGrid& whole) {
        return [&whole](VoxelTile&& tile) {
            EXPECT_GT(tile.bits.count(), 0U);
            for_each_voxel(tile.bits.size, [&](const glm::ivec3& v) {
                if (tile.bits.at(v)) whole.set(tile.origin + v);
            });
        };
    };
    SolidTiles solid(surface, grid, {.rule = rule}, side);
    const BitGrid bits = reference::exact_voxels(surface, whole(grid));
    for (int x = 0; x < resolution; x += side) {
        for (int z = 0; z < resolution; z += side) {
            for (int y = 0; y < resolution; y += side) {
                const glm::ivec3 origin(x, y, z);
                const glm::ivec3 size = glm::min(grid.resolution - origin, glm::ivec3(side));
                VoxelTile tile{origin, part(bits, origin, size), {}};
                if (tile.bits.count() > 0) solid.add(std::move(tile), collect(out.bits));
            }
        }
    }
    solid.finish(collect(out.bits));
    EXPECT_EQ(solid.occupied(), out.bits.count());
    out.doubts = solid.find_doubts(collect(out.doubtful));
    if (out.doubts) {
        EXPECT_EQ(out.doubts->enclosed + out.doubts->reached, out.doubtful.count());
    }
    return out;
}

class SolidRules : public testing::Test {
protected:
    /// A box with faces on voxels' middles, so that its surface is one voxel thick.
    Mesh box_of(int low, int high) {
        const std::int64_t voxel = lattice_side / resolution;
        return box(glm::i64vec3(low) * voxel + voxel / 2, glm::i64vec3(high) * voxel + voxel / 2, random);
    }
    static std::uint64_t cube_of(std::uint64_t length) { return length * length * length; }

    static constexpr int resolution = 64;
    Random random{33};
};

TEST_F(SolidRules, ByOutsideADoubledBoxIsFullAndByWindingItIsDoubtful) {
    const Mesh mesh = joined(box_of(20, 50), turned(box_of(20, 50)));
    EXPECT_EQ(solid_of(mesh, resolution, SolidRule::outside).bits.count(), cube_of(31));
    for (const SolidRule rule : {SolidRule::winding, SolidRule::parity}) {
        const Solid solid = solid_of(mesh, resolution, rule);
        EXPECT_EQ(solid.bits.count(), cube_of(31) - cube_of(29));
        EXPECT_EQ(solid.doubts->enclosed, cube_of(29));
        EXPECT_EQ(solid.doubts->reached, 0U);
    }
}

TEST_F(SolidRules, ByOutsidePartsTurnedAgainstEachOtherAreUnitedAndByWindingTheirOverlapIsDoubtful) {
    const Mesh mesh = joined(box_of(10, 30), turned(box_of(20, 50)));
    EXPECT_EQ(solid_of(mesh, resolution, SolidRule::outside).bits.count(),
              cube_of(21) + cube_of(31) - cube_of(11));
    const Solid solid = solid_of(mesh, resolution, SolidRule::winding);
    EXPECT_EQ(solid.doubts->enclosed, cube_of(9)) << "the overlap, without the surface around it";
    EXPECT_EQ(solid.bits.count(), cube_of(21) + cube_of(31) - cube_of(11) - cube_of(9));
    for_each_voxel(glm::ivec3(resolution), [&](const glm::ivec3& v) {
        EXPECT_EQ(solid.doubtful.at(v),
                  glm::all(glm::greaterThan(v, glm::ivec3(20))) && glm::all(glm::lessThan(v, glm::ivec3(30))))
            << fmt::format("{} {} {}", v.x, v.y, v.z);
    });
}

TEST_F(SolidRules, LeaveNoDoubtAboutClosedPartsThatAreTurnedOneWayNorAboutCavities) {
    const Mesh ball = sphere(glm::dvec3(lattice_side * 0.5 + 77), lattice_side * 0.4, 3);
    for (const Mesh& mesh : {box_of(20, 50), turned(box_of(20, 50)), joined(box_of(10, 30), box_of(20, 50)),
                             joined(box_of(20, 50), turned(box_of(30, 40))), joined(ball, box_of(30, 40)),
                             ball, joined(box_of(10, 20), box_of(21, 40))}) {
        const Solid solid = solid_of(mesh, resolution, SolidRule::winding);
        EXPECT_GT(solid.bits.count(), 0U);
        EXPECT_EQ(solid.doubts->enclosed, 0U);
        EXPECT_EQ(solid.doubts->reached, 0U);
        EXPECT_FALSE(solid_of(mesh, resolution, SolidRule::outside).doubts->enclosed);
    }
    EXPECT_EQ(
        solid_of(joined(box_of(20, 50), turned(box_of(30, 40))), resolution, SolidRule::outside).bits.count(),
        cube_of(31))
        << "the outside does not reach a cavity";
    EXPECT_EQ(
        solid_of(joined(box_of(10, 50), box_of(20, 40)), resolution, SolidRule::parity).doubts->enclosed,
        cube_of(19))
        << "by parity, a part within another of the same orientation is doubtful";
}

TEST_F(SolidRules, TellWhatIsFilledThoughTheOutsideReachesIt) {
    Mesh mesh = box_of(20, 50);
    std::int64_t high = 0;
    for (const LatticeTriangle& t : mesh) {
        for (const glm::i64vec3& p : t)
            high = std::max(high, p.y);
    }
    std::erase_if(
        mesh, [&](const LatticeTriangle& t) { return t[0].y == high && t[1].y == high && t[2].y == high; });
    ASSERT_EQ(mesh.size(), 10U);
    const Solid solid = solid_of(mesh, resolution, SolidRule::winding);
    EXPECT_EQ(solid.doubts->enclosed, 0U);
    EXPECT_EQ(solid.doubts->reached, 29U * 29U * 29U) << "the inside, up to the last centre below the lid";
    EXPECT_EQ(solid_of(mesh, resolution, SolidRule::outside).bits.count(), cube_of(31) - 29U * 29U * 30U)
        << "the outside comes in where the lid was";
}

TEST_F(SolidRules, SayWhatIsNotFoundInTheMemoryTheyMayTake) {
    const Mesh mesh = sphere(glm::dvec3(lattice_side * 0.5), lattice_side * 0.4, 2);
    const Surface surface = lattice_surface(mesh, resolution);
    const BitGrid bits = reference::exact_voxels(surface, whole(surface.grid));
    const TileSink nowhere = [](VoxelTile&&) {};
    const SolidOptions little{.memory_bytes = 60000};
    SolidTiles by_winding(surface, surface.grid, little, side * 2);
    by_winding.add({glm::ivec3(0), bits, {}}, nowhere);
    by_winding.finish(nowhere);
    EXPECT_FALSE(by_winding.find_doubts().has_value());
    EXPECT_GT(by_winding.occupied(), bits.count());
    SolidTiles by_outside(surface, surface.grid, {.rule = SolidRule::outside, .memory_bytes = 60000},
                          side * 2);
    try {
        by_outside.add({glm::ivec3(0), bits, {}}, nowhere);
        ADD_FAILURE() << "it fitted";
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::memory);
    }
}

}  // namespace
}  // namespace cairn::voxelizer
