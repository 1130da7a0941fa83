// Solid fill: against closed forms, against solid angles, and against itself in other orientations.
#include "voxelizer/solid/fill.h"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "base/error.h"
#include "scenes/load.h"
#include "shaders/interop/grid.h"
#include "shaders/interop/surface.h"
#include "tests/support/closed_meshes.h"
#include "tests/support/test_scenes.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;

Region cube(int level) {
    return {level, glm::ivec3(0), glm::ivec3(1 << level)};
}

BitGrid interior(const SolidFill& fill, const Region& tile) {
    BitGrid bits(tile.size);
    fill.add_interior(tile.origin, bits);
    return bits;
}
BitGrid interior(const Mesh& mesh, const Region& region, SolidRule rule = SolidRule::winding) {
    return interior(SolidFill(lattice_surface(mesh, 1 << region.level), region, {.rule = rule}), region);
}

BitGrid surface_bits(const Mesh& mesh, const Region& region) {
    return reference::exact_voxels(lattice_surface(mesh, 1 << region.level), region);
}
BitGrid united(BitGrid a, const BitGrid& b) {
    for (std::size_t i = 0; i < a.words.size(); ++i)
        a.words[i] |= b.words[i];
    return a;
}

template <typename Inside>
BitGrid where(const Region& region, const Inside& inside) {
    BitGrid bits(region.size);
    for (int z = 0; z < region.size.z; ++z) {
        for (int y = 0; y < region.size.y; ++y) {
            for (int x = 0; x < region.size.x; ++x) {
                if (inside(glm::ivec3(x, y, z))) bits.set({x, y, z});
            }
        }
    }
    return bits;
}

/// Centre of a voxel, in lattice units.
glm::dvec3 centre_of(const Region& region, const glm::ivec3& voxel) {
    return (glm::dvec3(region.origin + voxel) + 0.5) * double(region.voxel_side());
}

/// A centre on a face counts as moved a little towards +x, +y, +z: low <= centre < high.
bool in_box(const Region& region, const glm::ivec3& voxel, const glm::i64vec3& low,
            const glm::i64vec3& high) {
    const glm::dvec3 c = centre_of(region, voxel);
    return glm::all(glm::greaterThanEqual(c, glm::dvec3(low))) &&
           glm::all(glm::lessThan(c, glm::dvec3(high)));
}

TEST(SolidFill, FillsABoxExactlyWhereverItsFacesLie) {
    Random random(11);
    const Region region = cube(5);
    for (int i = 0; i < 200; ++i) {
        // In halves of a voxel: faces, edges and corners on the lines through the centres, and between them.
        const std::int64_t step = i % 4 == 0 ? 1 : region.voxel_side() / 2;
        const glm::i64vec3 low = random.point(0, lattice_side / step / 2) * step;
        const glm::i64vec3 high =
            low + glm::i64vec3(1) * step + random.point(0, lattice_side / step / 2 - 1) * step;
        const Mesh mesh = box(low, high, random);
        const BitGrid truth =
            where(region, [&](const glm::ivec3& v) { return in_box(region, v, low, high); });
        ASSERT_TRUE(same_bits(interior(mesh, region), truth)) << "box " << i;
        ASSERT_TRUE(same_bits(interior(turned(mesh), region), truth)) << "box " << i << ", inside out";
        ASSERT_EQ(SolidFill(lattice_surface(mesh, 32), region).doubtful_rows(), 0U);
    }
}

/// Makes cubes from a low to a high corner, in voxels along every axis.
auto cubes_in(const Region& region, Random& random) {
    return [side = std::int64_t(region.voxel_side()), &random](std::int64_t low, std::int64_t high) {
        return box(glm::i64vec3(low * side), glm::i64vec3(high * side), random);
    };
}

TEST(SolidFill, TellsNestedShellsCavitiesAndOverlapsApart) {
    Random random(12);
    const Region region = cube(5);
    const auto at = cubes_in(region, random);
    const auto voxels = [&](const Mesh& mesh) { return interior(mesh, region).count(); };
    EXPECT_EQ(voxels(at(4, 24)), 20U * 20U * 20U);
    EXPECT_EQ(voxels(joined(at(4, 24), at(10, 16))), 20U * 20U * 20U) << "nested shells are solid";
    EXPECT_EQ(voxels(joined(at(4, 24), turned(at(10, 16)))), 20U * 20U * 20U - 6U * 6U * 6U) << "a cavity";
    EXPECT_EQ(voxels(joined(at(4, 14), at(8, 20))), 10U * 10U * 10U + 12U * 12U * 12U - 6U * 6U * 6U)
        << "overlapping shells are united";
    EXPECT_EQ(voxels(joined(at(4, 14), at(14, 20))), 10U * 10U * 10U + 6U * 6U * 6U) << "shells that touch";
}

TEST(SolidFill, ByParityCountsCrossingsAloneSoThatOverlapsAndNestedShellsAreEmpty) {
    Random random(21);
    const Region region = cube(5);
    const auto at = cubes_in(region, random);
    const auto voxels = [&](const Mesh& mesh) { return interior(mesh, region, SolidRule::parity).count(); };
    const auto cube_of = [](std::uint64_t length) { return length * length * length; };
    for (const bool flip : {false, true}) {
        const auto other = [&](const Mesh& mesh) { return flip ? turned(mesh) : mesh; };
        EXPECT_EQ(voxels(other(at(4, 24))), cube_of(20));
        EXPECT_EQ(voxels(joined(at(4, 24), other(at(10, 16)))), cube_of(20) - cube_of(6));
        EXPECT_EQ(voxels(joined(at(4, 14), other(at(8, 20)))), cube_of(10) + cube_of(12) - 2 * cube_of(6));
        EXPECT_EQ(voxels(joined(at(4, 14), other(at(14, 20)))), cube_of(10) + cube_of(6));
    }
}

TEST(SolidFill, ByParityDoesNotCareWhichWayFacesAreTurned) {
    constexpr std::uint32_t seed = 22;
    Random random(seed);
    const Region region = cube(5);
    for (int i = 0; i < 20; ++i) {
        Mesh mesh = joined(random_tetrahedra(random, 3, 1), sphere(glm::dvec3(lattice_side * 0.5), 4e6, 2));
        const BitGrid truth = interior(mesh, region, SolidRule::parity);
        EXPECT_GT(truth.count(), 0U);
        for (LatticeTriangle& t : mesh) {
            if (random.between(0, 1) == 1) t = turned(t);
        }
        const SolidFill fill(lattice_surface(mesh, 32), region, {.rule = SolidRule::parity});
        EXPECT_TRUE(fill.closed());
        EXPECT_EQ(fill.doubtful_rows(), 0U);
        EXPECT_TRUE(same_bits(interior(fill, region), truth)) << "seed " << seed << ", mesh " << i;
        mesh.pop_back();
        const SolidFill open(lattice_surface(mesh, 32), region, {.rule = SolidRule::parity});
        EXPECT_FALSE(open.closed());
    }
}

TEST(SolidFill, ByParityOfAMeshWithAHoleDoesNotLeak) {
    const Region region = cube(6);
    const Mesh whole = sphere(glm::dvec3(lattice_side * 0.5), lattice_side * 0.45, 2);
    const BitGrid truth = interior(whole, region, SolidRule::parity);
    Mesh mesh = whole;
    mesh.erase(mesh.begin() + 5);
    const SolidFill fill(lattice_surface(mesh, 64), region, {.rule = SolidRule::parity});
    EXPECT_GT(fill.doubtful_rows(), 0U);
    const BitGrid ours = interior(fill, region);
    std::uint64_t lost = 0;
    (void)where(region, [&](const glm::ivec3& v) {
        EXPECT_FALSE(ours.at(v) && !truth.at(v)) << "filled outside";
        lost += truth.at(v) && !ours.at(v) ? 1U : 0U;
        return false;
    });
    EXPECT_LT(lost, truth.count() / 50);
}

TEST(SolidFill, FillsASphereAsItsFormulaSays) {
    for (const int level : {4, 6}) {
        const Region region = cube(level);
        const glm::dvec3 centre(lattice_side * 0.5 + 1234, lattice_side * 0.5, lattice_side * 0.5 - 777);
        const double radius = lattice_side * 0.4;
        const Mesh mesh = sphere(centre, radius, 5);
        const BitGrid surface = surface_bits(mesh, region);
        const BitGrid truth = where(region, [&](const glm::ivec3& v) {
            return glm::distance(centre_of(region, v), centre) < radius;
        });
        EXPECT_TRUE(same_bits(united(interior(mesh, region), surface), united(truth, surface)));
    }
}

TEST(SolidFill, AgreesWithSolidAnglesOnShellsOfEitherOrientation) {
    constexpr std::uint32_t seed = 13;
    Random random(seed);
    const Region region = cube(4);
    for (int i = 0; i < 60; ++i) {
        const Mesh mesh = random_tetrahedra(random, 1 + i % 5, i % 2 == 0 ? region.voxel_side() / 2 : 1);
        const BitGrid surface = surface_bits(mesh, region);
        const BitGrid truth = where(region, [&](const glm::ivec3& v) {
            return surface.at(v) || std::abs(winding_number(mesh, centre_of(region, v))) > 0.5;
        });
        ASSERT_TRUE(same_bits(united(interior(mesh, region), surface), truth))
            << "seed " << seed << ", mesh " << i;
    }
}

/// The inside by the rows along one axis alone.
BitGrid interior_along(int axis, const Mesh& mesh, const Region& region) {
    const Surface surface = lattice_surface(mesh, 1 << region.level);
    const RowCrossings rows(surface, region, axis, std::size_t(1) << 30);
    return where(region, [&](const glm::ivec3& v) {
        int winding = 0;
        for (const RowCrossings::Event& event : rows.row(v)) {
            if (event.voxel() <= v[axis]) winding += event.winding();
        }
        return winding != 0;
    });
}

TEST(SolidFill, SaysTheSameAlongAllAxesEvenOfCentresOnTheSurface) {
    constexpr std::uint32_t seed = 14;
    Random random(seed);
    for (const int level : {3, 4, LATTICE_BITS - 1, LATTICE_BITS}) {
        const Region region{level, glm::ivec3(0), glm::ivec3(15)};
        for (int i = 0; i < 40; ++i) {
            Mesh mesh = random_tetrahedra(random, 3, region.voxel_side());
            if (level > 10) {  // a few lattice units small
                for (LatticeTriangle& t : mesh) {
                    for (glm::i64vec3& p : t)
                        p = p * std::int64_t(16 * region.voxel_side()) / lattice_side;
                }
            }
            const BitGrid along_x = interior_along(0, mesh, region);
            ASSERT_TRUE(same_bits(interior_along(1, mesh, region), along_x))
                << "seed " << seed << ", mesh " << i;
            ASSERT_TRUE(same_bits(interior_along(2, mesh, region), along_x))
                << "seed " << seed << ", mesh " << i;
        }
    }
}

TEST(SolidFill, TurnsWithTheMesh) {
    Random random(15);
    const Region region = cube(5);
    const auto turn = [](const glm::i64vec3& p, std::int64_t side) {
        return glm::i64vec3(p.y, side - p.x, p.z);
    };
    for (int i = 0; i < 20; ++i) {
        const Mesh mesh = joined(random_tetrahedra(random, 2, region.voxel_side() / 2),
                                 sphere(glm::dvec3(lattice_side / 2), lattice_side * 0.3, 2));
        Mesh other = mesh;
        for (LatticeTriangle& t : other) {
            for (glm::i64vec3& p : t)
                p = turn(p, lattice_side);
        }
        const BitGrid solid = united(interior(mesh, region), surface_bits(mesh, region));
        const BitGrid truth = where(region, [&](const glm::ivec3& v) {
            return solid.at({region.size.x - 1 - v.y, v.x, v.z});
        });
        ASSERT_TRUE(same_bits(united(interior(other, region), surface_bits(other, region)), truth)) << i;
    }
}

TEST(SolidFill, OfTilesAndOfRegionsIsThatOfTheWhole) {
    const Mesh mesh = joined(sphere(glm::dvec3(lattice_side * 0.45), lattice_side * 0.4, 3),
                             turned(sphere(glm::dvec3(lattice_side * 0.5), lattice_side * 0.2, 3)));
    const Region whole{6, glm::ivec3(0), {53, 61, 47}};
    const Surface surface = lattice_surface(mesh, 64);
    const SolidFill fill(surface, whole);
    const BitGrid all = interior(fill, whole);
    EXPECT_GT(all.count(), 1000U);
    Random random(16);
    for (int i = 0; i < 50; ++i) {
        Region tile{6, {}, {}};
        for (int axis = 0; axis < 3; ++axis) {
            tile.origin[axis] = int(random.between(0, whole.size[axis] - 1));
            tile.size[axis] = int(random.between(1, whole.size[axis] - tile.origin[axis]));
        }
        const BitGrid truth = where(tile, [&](const glm::ivec3& v) { return all.at(tile.origin + v); });
        ASSERT_TRUE(same_bits(interior(fill, tile), truth)) << "tile " << i;
        ASSERT_TRUE(same_bits(interior(SolidFill(surface, tile), tile), truth)) << "region " << i;
    }
    for (int z = 0; z < whole.size.z; ++z) {
        for (int y = 0; y < whole.size.y; ++y) {
            for (int x = 0; x < whole.size.x; ++x)
                ASSERT_EQ(fill.is_inside({x, y, z}), all.at({x, y, z})) << x << ' ' << y << ' ' << z;
        }
    }
    BitGrid outside(glm::ivec3(8));
    EXPECT_THROW(fill.add_interior({50, 0, 0}, outside), Error);
    EXPECT_THROW(fill.add_interior({-1, 0, 0}, outside), Error);
}

TEST(SolidFill, OfAnOpenSheetIsNothing) {
    const std::int64_t s = lattice_side;
    const Region region = cube(5);
    const Mesh sheet{{glm::i64vec3(s / 8, s / 9, s / 7), {s / 2, s, s / 5}, {s / 6, s / 3, s}}};
    const SolidFill fill(lattice_surface(sheet, 32), region);
    EXPECT_GT(fill.doubtful_rows(), 0U);
    EXPECT_EQ(interior(fill, region).count(), 0U);
}

TEST(SolidFill, OfTwoSheetsThatFaceEachOtherIsNothing) {
    constexpr std::int64_t s = lattice_side;
    const Region region = cube(5);
    const auto square = [](std::int64_t x) {
        return Mesh{{glm::i64vec3(x, 0, 0), {x, s, 0}, {x, s, s}},
                    {glm::i64vec3(x, 0, 0), {x, s, s}, {x, 0, s}}};
    };
    Mesh mesh = square(3 * s / 4);
    for (const LatticeTriangle& t : square(s / 4))
        mesh.push_back(turned(t));
    const SolidFill fill(lattice_surface(mesh, 32), region);
    EXPECT_FALSE(fill.closed());
    EXPECT_EQ(interior(fill, region).count(), 0U);
}

TEST(SolidFill, OfABoxWithoutALidIsThatOfTheBox) {
    Random random(19);
    const Region region = cube(5);
    const glm::i64vec3 low(lattice_side / 5);
    const glm::i64vec3 high(lattice_side * 3 / 4);
    const Mesh whole = box(low, high, random);
    EXPECT_TRUE(SolidFill(lattice_surface(whole, 32), region).closed());
    for (int axis = 0; axis < 3; ++axis) {
        Mesh mesh = whole;
        std::erase_if(mesh, [&](const LatticeTriangle& t) {
            return t[0][axis] == high[axis] && t[1][axis] == high[axis] && t[2][axis] == high[axis];
        });
        ASSERT_LT(mesh.size(), whole.size());
        const SolidFill fill(lattice_surface(mesh, 32), region);
        EXPECT_FALSE(fill.closed());
        EXPECT_GT(fill.doubtful_rows(), 0U) << "axis " << axis;
        EXPECT_TRUE(same_bits(interior(fill, region), interior(whole, region))) << "axis " << axis;
    }
}

/// The voxels that a triangle's box reaches.
bool in_box_of(const LatticeTriangle& t, const Region& region, const glm::ivec3& voxel) {
    const glm::dvec3 c = centre_of(region, voxel);
    const glm::dvec3 low(glm::min(glm::min(t[0], t[1]), t[2]));
    const glm::dvec3 high(glm::max(glm::max(t[0], t[1]), t[2]));
    return glm::all(glm::greaterThanEqual(c, low)) && glm::all(glm::lessThanEqual(c, high));
}

TEST(SolidFill, OfAMeshWithAHoleDiffersOnlyInTheHolesBox) {
    const Region region = cube(6);
    const Mesh whole = sphere(glm::dvec3(lattice_side * 0.5), lattice_side * 0.45, 2);
    const BitGrid truth = interior(whole, region);
    std::uint64_t doubtful = 0;
    std::uint64_t different = 0;
    for (std::size_t hole = 0; hole < whole.size(); hole += 7) {
        Mesh mesh = whole;
        mesh.erase(mesh.begin() + std::ptrdiff_t(hole));
        const SolidFill fill(lattice_surface(mesh, 64), region);
        doubtful += fill.doubtful_rows();
        const BitGrid ours = interior(fill, region);
        (void)where(region, [&](const glm::ivec3& v) {
            EXPECT_EQ(fill.is_inside(v), ours.at(v)) << fmt::format("{} {} {}", v.x, v.y, v.z);
            if (ours.at(v) == truth.at(v)) return false;
            ++different;
            EXPECT_TRUE(truth.at(v)) << "filled outside";
            EXPECT_TRUE(in_box_of(whole[hole], region, v))
                << fmt::format("hole {}, voxel {} {} {}", hole, v.x, v.y, v.z);
            return true;
        });
    }
    EXPECT_GT(doubtful, 0U);
    EXPECT_GT(different, 0U) << "the holes were too small to matter";
}

TEST(SolidFill, OfAConvexMeshWithSomeFacesTurnedAroundIsThatOfTheMesh) {
    constexpr std::uint32_t seed = 17;
    Random random(seed);
    const Region region = cube(5);
    const Mesh whole = sphere(glm::dvec3(lattice_side * 0.5), lattice_side * 0.45, 2);
    const BitGrid truth = interior(whole, region);
    for (int i = 0; i < 30; ++i) {
        Mesh mesh = whole;
        for (LatticeTriangle& t : mesh) {
            if (random.between(0, 9) < i % 10) t = turned(t);
        }
        const SolidFill fill(lattice_surface(mesh, 32), region);
        EXPECT_TRUE(same_bits(interior(fill, region), truth)) << "seed " << seed << ", mesh " << i;
        if (i % 10 > 0) {
            EXPECT_GT(fill.doubtful_rows(), 0U);
        }
    }
}

TEST(SolidFill, GoesAroundTheGridAndFarBeyond) {
    const Region region = cube(4);
    for (const double radius : {1.2, 3.0, 40000.0}) {
        const Mesh mesh = sphere(glm::dvec3(lattice_side * 0.5), lattice_side * radius, 2);
        Surface surface = lattice_surface({}, 16);
        surface.outside_triangles = mesh;
        EXPECT_EQ(interior(SolidFill(surface, region), region).count(), 16U * 16U * 16U) << radius;
        EXPECT_EQ(interior(mesh, region).count(), 16U * 16U * 16U) << radius;
    }
}

TEST(SolidFill, LeavesOutWhatAMaskCutsAndWhatHasNoArea) {
    Random random(18);
    const Region region = cube(4);
    const glm::i64vec3 low(lattice_side / 4);
    const glm::i64vec3 high(lattice_side / 2);
    Surface surface = lattice_surface(box(low, high, random), 16);
    const std::uint64_t whole = interior(SolidFill(surface, region), region).count();
    EXPECT_EQ(whole, 64U);
    surface.materials.resize(2);
    surface.materials[1].flags = 1U << MATERIAL_MASK_BIT;
    for (interop::SurfaceTriangle& t : surface.chunks[0].triangles)
        t.material = 1;
    EXPECT_EQ(interior(SolidFill(surface, region), region).count(), 0U);

    Mesh mesh = box(low, high, random);
    mesh.push_back({low, low, high});
    mesh.push_back({low, high, low + (high - low) * std::int64_t(2)});
    mesh.push_back({high, high, high});
    const SolidFill fill(lattice_surface(mesh, 16), region);
    EXPECT_EQ(fill.doubtful_rows(), 0U);
    EXPECT_EQ(interior(fill, region).count(), whole);
}

TEST(SolidFill, SaysWhatWouldFitBeforeItTakesTooMuch) {
    Random random(19);
    const Mesh mesh = box(glm::i64vec3(0), glm::i64vec3(lattice_side), random);
    const Surface surface = lattice_surface(mesh, 256);
    const Region region = cube(8);
    EXPECT_EQ(SolidFill(surface, region).size_bytes(), 256U * 256U * (3U * 4U) + 256U * 256U / 8U);
    try {
        const SolidFill fill(surface, region, {.memory_bytes = 700000});
        ADD_FAILURE() << "it fitted";
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::memory);
        EXPECT_EQ(error.way_out(), "240 x 240 x 240 would fit");
    }
    EXPECT_THROW(SolidFill(surface, region, {.memory_bytes = 1000}), Error);
}

/// A snapshot of one closed box, |x|, |y|, |z| <= 1, with copies at some places.
struct Boxes {
    explicit Boxes(const std::vector<glm::dmat4>& places) {
        Random random(20);
        std::vector<glm::vec3> corners;
        for (const LatticeTriangle& t : box(glm::i64vec3(-1), glm::i64vec3(1), random)) {
            for (const glm::i64vec3& p : t)
                corners.emplace_back(p);
        }
        scene = triangles(corners);
        snapshot = scenes::take_snapshot(scene);
        const scenes::Item item = snapshot.items.at(0);
        snapshot.items.clear();
        for (const glm::dmat4& place : places) {
            snapshot.items.push_back(item);
            snapshot.items.back().world_from_mesh = place;
        }
    }
    scenes::Scene scene;
    scenes::Snapshot snapshot;
};

TEST(SolidFill, UnitesAMirroredNodeWithAnUprightOne) {
    const glm::dmat4 upright = glm::translate(glm::dmat4(1.0), glm::dvec3(0.5, 0.0, 0.0));
    const glm::dmat4 mirrored =
        glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(-0.5, 0.0, 0.0)), glm::dvec3(-1.0, 1.0, 1.0));
    const Boxes boxes({upright, mirrored});
    const Grid grid = grid_over({glm::dvec3(-2.0), glm::dvec3(2.0)}, 16);
    const Surface surface = build_surface(boxes.scene, boxes.snapshot, grid);
    const SolidFill fill(surface, whole(grid));
    EXPECT_EQ(fill.doubtful_rows(), 0U);
    EXPECT_EQ(interior(fill, whole(grid)).count(), 12U * 8U * 8U);
}

TEST(SolidFill, OfAGridThatCutsThroughTheSceneKnowsWhatLiesOutside) {
    const Boxes boxes({glm::dmat4(1.0), glm::translate(glm::dmat4(1.0), glm::dvec3(40.0, 0.0, 0.0))});
    const Grid grid = grid_over({glm::dvec3(-0.5), glm::dvec3(1.5)}, 16);
    const Region region = whole(grid);
    const Surface surface = build_surface(boxes.scene, boxes.snapshot, grid, {.outside = true});
    const SolidFill fill(surface, region);
    EXPECT_EQ(fill.doubtful_rows(), 0U);
    const BitGrid truth =
        where(region, [](const glm::ivec3& v) { return glm::all(glm::lessThan(v, glm::ivec3(12))); });
    EXPECT_TRUE(same_bits(interior(fill, region), truth));
    EXPECT_TRUE(build_surface(boxes.scene, boxes.snapshot, grid).outside_triangles.empty());
    EXPECT_GT(SolidFill(build_surface(boxes.scene, boxes.snapshot, grid), region).doubtful_rows(), 0U);
}

Mesh mesh_of(const Surface& surface) {
    Mesh mesh;
    for (const SurfaceChunk& chunk : surface.chunks) {
        for (const interop::SurfaceTriangle& triangle : chunk.triangles) {
            LatticeTriangle t;
            for (int i = 0; i < 3; ++i) {
                const auto& p = chunk.positions[triangle.vertices[i]];
                t[std::size_t(i)] = {p[0], p[1], p[2]};
            }
            mesh.push_back(t);
        }
    }
    return mesh;
}

class SolidFillOf : public ::testing::TestWithParam<const char*> {};

TEST_P(SolidFillOf, AgreesWithSolidAngles) {
    const scenes::Scene scene = scenes::load(GetParam());
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    const Surface surface = build_surface(scene, snapshot, grid_around(snapshot.bounds, 64));
    const Region region = whole(surface.grid);
    const SolidFill fill(surface, region);
    EXPECT_EQ(fill.doubtful_rows(), 0U);
    const BitGrid ours = interior(fill, region);
    const BitGrid occupied = reference::exact_voxels(surface, region);
    const Mesh mesh = mesh_of(surface);
    constexpr std::uint32_t seed = 21;
    Random random(seed);
    int inside = 0;
    for (int tried = 0; tried < 400;) {
        const glm::ivec3 v = random.point(0, 63);
        if (occupied.at(v)) continue;
        ++tried;
        const bool truth = std::abs(winding_number(mesh, centre_of(region, v))) > 0.5;
        inside += int(truth);
        ASSERT_EQ(ours.at(v), truth) << fmt::format("seed {}, voxel {} {} {}", seed, v.x, v.y, v.z);
    }
    EXPECT_GT(inside, 5);
}

INSTANTIATE_TEST_SUITE_P(Builtin, SolidFillOf, ::testing::Values("builtin:knot", "builtin:spheres"),
                         [](const auto& scene) { return std::string(scene.param + 8); });
#ifdef CAIRN_SCENE_DATA
INSTANTIATE_TEST_SUITE_P(Data, SolidFillOf,
                         ::testing::Values(CAIRN_SCENE_DATA "/gltf/DenseSphere_draco_quantized.glb"));
#endif

}  // namespace
}  // namespace cairn::voxelizer
