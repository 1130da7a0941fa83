// What the outside reaches: against a search voxel by voxel, and the voxels that it finds doubtful.
#include "voxelizer/solid/outside.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "shaders/interop/surface.h"
#include "tests/support/closed_meshes.h"
#include "tests/support/flood_search.h"
#include "voxelizer/solid/solid_tiles.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;

constexpr std::size_t plenty = std::size_t(1) << 30;
constexpr int side = 32;

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

/// One of the three kinds of voxels of a tile.
BitGrid bits_of(const Outside& outside, const glm::ivec3& origin, const glm::ivec3& size,
                std::uint32_t Outside::Word::*kind) {
    BitGrid bits(size);
    for_each_voxel(size, [&](const glm::ivec3& v) {
        const glm::ivec3 first(v.x / 32 * 32, v.y, v.z);
        if ((outside.word_at(origin + first).*kind >> (v.x % 32) & 1U) != 0) bits.set(v);
    });
    return bits;
}

void expect_as_searched(const BitGrid& surface, const std::string& what) {
    const Region region{8, {17, 3, 40}, surface.size};
    Outside outside(region, plenty);
    for_each_tile(surface.size, [&](const glm::ivec3& origin, const glm::ivec3& size) {
        const BitGrid tile = part(surface, origin, size);
        if (tile.count() == 0) return;
        ASSERT_TRUE(outside.add_surface(region.origin + origin, tile));
    });
    outside.flood(Outside::open_sides(region));
    const BitGrid truth = searched(surface);
    BitGrid enclosed(surface.size);
    BitGrid solid(surface.size);
    for_each_voxel(surface.size, [&](const glm::ivec3& v) {
        if (!truth.at(v)) solid.set(v);
        if (!truth.at(v) && !surface.at(v)) enclosed.set(v);
    });
    for_each_tile(surface.size, [&](const glm::ivec3& origin, const glm::ivec3& size) {
        const glm::ivec3 place = region.origin + origin;
        ASSERT_TRUE(
            same_bits(bits_of(outside, place, size, &Outside::Word::reached), part(truth, origin, size)))
            << what;
        ASSERT_TRUE(
            same_bits(bits_of(outside, place, size, &Outside::Word::enclosed), part(enclosed, origin, size)))
            << what;
        ASSERT_TRUE(same_bits(outside.solid(place, size), part(solid, origin, size))) << what;
        ASSERT_TRUE(same_bits(outside.surface(place, size), part(surface, origin, size))) << what;
        ASSERT_EQ(outside.has_surface(place, size), part(surface, origin, size).count() > 0) << what;
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

TEST(Outside, StaysOutWhereASideIsClosed) {
    const Region region{6, {5, 6, 7}, {33, 40, 35}};
    const auto reached = [&](const Outside::Sides& closed) {
        Outside outside(region, plenty);
        outside.flood(closed);
        return bits_of(outside, region.origin, region.size, &Outside::Word::reached).count();
    };
    Outside::Sides closed = Outside::open_sides(region);
    for (auto& sides : closed) {
        for (BitGrid& side : sides) {
            for_each_voxel(side.size, [&](const glm::ivec3& v) { side.set(v); });
        }
    }
    EXPECT_EQ(reached(closed), 0U);
    for (int axis = 0; axis < 3; ++axis) {
        for (const std::size_t high : {0U, 1U}) {
            Outside::Sides one_place = closed;
            BitGrid& side = one_place[std::size_t(axis)][high];
            const glm::ivec3 last = side.size - 1;
            side.words[side.word_index(last.x, last.y, 0)] &= ~(1U << (last.x % 32));
            EXPECT_EQ(reached(one_place), 33U * 40U * 35U) << "axis " << axis << ", side " << high;
        }
    }
}

/// A solid by a rule: its voxels, and those of them that are doubtful.
struct Solid {
    BitGrid bits, doubtful;
    std::optional<Doubts> doubts;
};
Solid solid_of(const Surface& surface, const BitGrid& bits, SolidRule rule,
               std::size_t memory_bytes = plenty) {
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
    SolidTiles solid(surface, grid, {.rule = rule, .memory_bytes = memory_bytes}, side);
    for (int x = 0; x < grid.resolution.x; x += side) {
        for (int z = 0; z < grid.resolution.z; z += side) {
            for (int y = 0; y < grid.resolution.y; y += side) {
                const glm::ivec3 origin(x, y, z);
                const glm::ivec3 size = glm::min(grid.resolution - origin, glm::ivec3(side));
                VoxelTile tile{origin, part(bits, origin, size), {}};
                if (tile.bits.count() > 0) solid.add(std::move(tile), collect(out.bits));
            }
        }
    }
    solid.finish(collect(out.bits), collect(out.doubtful));
    EXPECT_EQ(solid.occupied(), out.bits.count());
    out.doubts = solid.doubts();
    if (out.doubts) {
        EXPECT_EQ(out.doubts->enclosed + out.doubts->reached, out.doubtful.count());
    }
    return out;
}

Solid solid_of(const Mesh& mesh, int resolution, SolidRule rule, std::size_t memory_bytes = plenty) {
    const Surface surface = lattice_surface(mesh, resolution);
    return solid_of(surface, reference::exact_voxels(surface, whole(surface.grid)), rule, memory_bytes);
}
/// Of a grid of fewer voxels at the low corner of a root cube, which cuts through the mesh.
Solid cut_solid_of(const Mesh& mesh, int resolution, const glm::ivec3& cut, SolidRule rule) {
    Surface surface = lattice_surface(mesh, resolution);
    surface.grid.resolution = cut;
    return solid_of(surface, reference::exact_voxels(surface, whole(surface.grid)), rule);
}

/// The mesh with x, y and z in another order.
Mesh permuted(Mesh mesh, int times) {
    for (LatticeTriangle& t : mesh) {
        for (glm::i64vec3& p : t) {
            for (int i = 0; i < times; ++i)
                p = {p.y, p.z, p.x};
        }
    }
    return mesh;
}

class SolidRules : public testing::Test {
protected:
    /// A box with faces on voxels' middles, so that its surface is one voxel thick.
    Mesh box_of(int low, int high) {
        const std::int64_t voxel = lattice_side / resolution;
        return box(glm::i64vec3(low) * voxel + voxel / 2, glm::i64vec3(high) * voxel + voxel / 2, random);
    }
    /// A box by its corners in voxels.
    Mesh box_from(const glm::dvec3& low, const glm::dvec3& high) {
        const double voxel = double(lattice_side) / resolution;
        return box(glm::i64vec3(low * voxel), glm::i64vec3(high * voxel), random);
    }
    /// A ball of a radius in voxels around the middle.
    static Mesh ball_of(double radius) {
        return sphere(glm::dvec3(lattice_side * 0.5), radius * double(lattice_side) / resolution, 4);
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

TEST_F(SolidRules, AnInsideOutRodThatPiercesABoxIsDoubtfulAlongEveryAxis) {
    // Rows across the rod see what they would see of a cavity.
    const Mesh mesh = joined(box_of(10, 40), turned(box_from({20.5, 20.5, 4.5}, {30.5, 30.5, 50.5})));
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(solid_of(permuted(mesh, axis), resolution, SolidRule::winding).doubts->enclosed,
                  9U * 9U * 29U)
            << "axis " << axis;
    }
}

TEST_F(SolidRules, DoNotDoubtACavityForWhatLiesBesideIt) {
    const Mesh hollow = joined(ball_of(18), turned(ball_of(10)));
    const std::int64_t voxel = lattice_side / resolution;
    const Mesh quad{
        {glm::i64vec3(0, 5, 0) * voxel, glm::i64vec3(64, 5, 0) * voxel, glm::i64vec3(64, 5, 64) * voxel},
        {glm::i64vec3(0, 5, 0) * voxel, glm::i64vec3(64, 5, 64) * voxel, glm::i64vec3(0, 5, 64) * voxel}};
    const Mesh plates = joined(box_from({3.4, 1, 1}, {3.6, 63, 63}), box_from({60.4, 1, 1}, {60.6, 63, 63}));
    const Mesh cards = joined(plates, turned(plates));
    const Mesh inside_out = turned(box_from({3, 25, 25}, {9, 40, 40}));
    const std::vector<std::pair<const char*, Mesh>> beside = {{"nothing", {}},
                                                              {"thin plates", plates},
                                                              {"doubled plates", cards},
                                                              {"an inside-out box", inside_out},
                                                              {"a ground", quad}};
    for (const auto& [name, others] : beside) {
        for (int axis = 0; axis < 3; ++axis) {
            const Solid solid =
                solid_of(permuted(joined(hollow, others), axis), resolution, SolidRule::winding);
            EXPECT_EQ(solid.doubts->enclosed, 0U) << name << ", axis " << axis;
            EXPECT_FALSE(solid.bits.at(glm::ivec3(resolution / 2))) << name << ", axis " << axis;
        }
    }
}

TEST_F(SolidRules, DoubtACavityWhoseWallsAreFarThinnerThanAVoxel) {
    const auto doubts = [&](double thickness) {
        return solid_of(joined(ball_of(18), turned(ball_of(18 - thickness))), resolution, SolidRule::winding)
            .doubts->enclosed;
    };
    EXPECT_EQ(doubts(1.5), 0U);
    EXPECT_EQ(doubts(0.8), 0U);
    EXPECT_GT(doubts(0.1), 15000U);
}

TEST_F(SolidRules, DoubtWhatAMaskedSurfaceEncloses) {
    Surface surface = lattice_surface(box_of(20, 50), resolution);
    const BitGrid bits = reference::exact_voxels(surface, whole(surface.grid));
    surface.materials[0].flags = 1U << MATERIAL_MASK_BIT;
    EXPECT_EQ(solid_of(surface, bits, SolidRule::winding).doubts->enclosed, cube_of(29));
    EXPECT_EQ(solid_of(surface, bits, SolidRule::outside).bits.count(), cube_of(31));
}

TEST_F(SolidRules, OfAGridThatCutsThroughASceneAreThoseOfTheWholeScene) {
    // A ball, a cavity, and a slab that lies before all of the grid's upper side without enclosing it.
    const Mesh mesh = joined(joined(ball_of(25), turned(ball_of(8))), box_from({0, 60, 0}, {64, 63, 64}));
    for (const SolidRule rule : {SolidRule::winding, SolidRule::parity, SolidRule::outside}) {
        const BitGrid truth = solid_of(mesh, resolution, rule).bits;
        for (const glm::ivec3& cut : {glm::ivec3(64, 33, 40), {32, 64, 64}, {64, 64, 5}, {50, 31, 64}}) {
            const Solid solid = cut_solid_of(mesh, resolution, cut, rule);
            // The outside comes in where a side cuts the cavity.
            const bool opens =
                rule == SolidRule::outside && glm::any(glm::lessThan(glm::abs(cut - 32), glm::ivec3(8)));
            if (!opens) {
                EXPECT_TRUE(same_bits(solid.bits, part(truth, glm::ivec3(0), cut)))
                    << int(rule) << fmt::format(", {} x {} x {}", cut.x, cut.y, cut.z);
            }
            EXPECT_EQ(solid.doubts->reached, 0U);
            EXPECT_EQ(solid.doubts->enclosed, 0U);
        }
    }
}

TEST_F(SolidRules, OfAGridBetweenPlatesIsNothing) {
    // Plates before every side that closes nothing.
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        mesh = joined(mesh, permuted(box_from({40, 0, 0}, {42, 64, 64}), axis));
    for (const SolidRule rule : {SolidRule::winding, SolidRule::outside}) {
        const Solid solid = cut_solid_of(mesh, resolution, {64, 30, 30}, rule);
        EXPECT_EQ(solid.bits.count(), 4U * 30U * 30U) << "the plate across the grid";
        EXPECT_EQ(solid.doubts->enclosed, 0U);
    }
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
    EXPECT_FALSE(by_winding.doubts().has_value());
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

TEST_F(SolidRules, FillAlikeWhereverTheMemoryForTheFloodEnds) {
    const Mesh mesh = joined(sphere(glm::dvec3(lattice_side * 0.5), lattice_side * 0.4, 3), box_of(2, 9));
    const BitGrid truth = solid_of(mesh, resolution, SolidRule::winding).bits;
    // The surface touches all eight blocks; room for five is enough for the crossings.
    int without_doubts = 0;
    for (std::size_t memory_bytes = 46000; memory_bytes <= 80000; memory_bytes += 4000) {
        const Solid solid = solid_of(mesh, resolution, SolidRule::winding, memory_bytes);
        EXPECT_TRUE(same_bits(solid.bits, truth)) << memory_bytes << " bytes";
        without_doubts += solid.doubts ? 0 : 1;
    }
    EXPECT_GE(without_doubts, 3);
    EXPECT_LE(without_doubts, 6);
}

}  // namespace
}  // namespace cairn::voxelizer
