// Changes of a surface that must not change its voxels, or must change them in a known way. They need no
// truth, so surfaces may be large. The method under test is `conservative`.
#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "scenes/load.h"
#include "shaders/interop/surface.h"
#include "tests/support/voxelizer_fixture.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;

constexpr std::int64_t N = lattice_side;
constexpr int resolution = 64;
const Region all{6, glm::ivec3(0), glm::ivec3(resolution)};
constexpr std::int64_t voxel = N / resolution;

std::vector<LatticeTriangle> random_surface() {
    Random random(41);
    std::vector<LatticeTriangle> triangles;
    for (int i = 0; i < 80; ++i)
        triangles.push_back(random_triangle(random, voxel));
    return triangles;
}

std::vector<LatticeTriangle> needles() {
    Random random(42);
    std::vector<LatticeTriangle> triangles;
    for (int i = 0; i < 300; ++i) {
        const glm::i64vec3 a = random.point(0, N);
        const glm::i64vec3 b = random.point(0, N);
        triangles.push_back({a, b, (a + b) / std::int64_t(2) + random.point(-9, 9)});
    }
    return triangles;
}

/// The triangles of a scene on the lattice of its default grid.
std::vector<LatticeTriangle> triangles_of(const std::string& path) {
    const scenes::Scene scene = scenes::load(path);
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    const Surface surface = build_surface(scene, snapshot, grid_around(snapshot.bounds, resolution));
    std::vector<LatticeTriangle> triangles;
    for (const SurfaceChunk& chunk : surface.chunks) {
        for (const interop::SurfaceTriangle& t : chunk.triangles) {
            LatticeTriangle& out = triangles.emplace_back();
            for (int corner = 0; corner < 3; ++corner) {
                const auto& p = chunk.positions[t.vertices[corner]];
                out[std::size_t(corner)] = {p[0], p[1], p[2]};
            }
        }
    }
    return triangles;
}

struct Named {
    const char* name;
    std::vector<LatticeTriangle> (*make)();
};

void PrintTo(const Named& named, std::ostream* out) {
    *out << named.name;
}

class Metamorphic : public ConservativeTest, public ::testing::WithParamInterface<Named> {
protected:
    void SetUp() override {
        ConservativeTest::SetUp();
        triangles_ = GetParam().make();
        bits_ = voxelize(triangles_, all);
        ASSERT_GT(bits_.count(), 100U) << "there is little to compare";
    }

    std::vector<LatticeTriangle> triangles_;
    BitGrid bits_;  ///< bits of the whole grid
};

/// One of the 48 ways to put a cube onto itself: axis i of the image is axis `from[i]`, turned by `sign[i]`.
struct Turn {
    glm::ivec3 from, sign;

    [[nodiscard]] bool is_rotation() const {
        const bool even =
            from == glm::ivec3(0, 1, 2) || from == glm::ivec3(1, 2, 0) || from == glm::ivec3(2, 0, 1);
        return even == (sign.x * sign.y * sign.z > 0);
    }
    /// The image of a point under the turn about the middle of [0, side]^3.
    template <class Vector>
    [[nodiscard]] Vector operator()(const Vector& p, typename Vector::value_type side) const {
        Vector out;
        for (int axis = 0; axis < 3; ++axis)
            out[axis] = sign[axis] > 0 ? p[from[axis]] : side - p[from[axis]];
        return out;
    }
};

std::vector<Turn> turns(bool rotations) {
    std::vector<Turn> out;
    glm::ivec3 from(0, 1, 2);
    do {
        for (int signs = 0; signs < 8; ++signs) {
            const Turn turn{from, 1 - 2 * glm::ivec3(signs & 1, signs >> 1 & 1, signs >> 2)};
            if (turn.is_rotation() == rotations) out.push_back(turn);
        }
    } while (std::next_permutation(&from[0], &from[0] + 3));
    return out;
}

BitGrid turned(const BitGrid& bits, const Turn& turn) {
    BitGrid out(bits.size);
    for (int z = 0; z < bits.size.z; ++z)
        for (int y = 0; y < bits.size.y; ++y)
            for (int x = 0; x < bits.size.x; ++x)
                if (bits.at({x, y, z})) out.set(turn(glm::ivec3(x, y, z), bits.size.x - 1));
    return out;
}

void expect_turns_with(ConservativeVoxelizer& voxelizer, const std::vector<LatticeTriangle>& triangles,
                       const BitGrid& bits, bool rotations) {
    const std::vector<Turn> ways = turns(rotations);
    ASSERT_EQ(ways.size(), 24U);
    for (const Turn& turn : ways) {
        std::vector<LatticeTriangle> moved = triangles;
        for (LatticeTriangle& t : moved) {
            for (glm::i64vec3& p : t)
                p = turn(p, N);
        }
        EXPECT_TRUE(same_bits(voxelizer.voxelize(upload(lattice_surface(moved, resolution)), all),
                              turned(bits, turn)))
            << fmt::format("axes {} {} {}, signs {} {} {}", turn.from.x, turn.from.y, turn.from.z,
                           turn.sign.x, turn.sign.y, turn.sign.z);
    }
}

TEST_P(Metamorphic, The24RotationsOfTheCubeTurnTheVoxels) {
    ConservativeVoxelizer voxelizer;
    expect_turns_with(voxelizer, triangles_, bits_, true);
}

TEST_P(Metamorphic, The24ReflectionsOfTheCubeTurnTheVoxels) {
    ConservativeVoxelizer voxelizer;
    expect_turns_with(voxelizer, triangles_, bits_, false);
}

// The furthest moves leave the shaders' range, so that the CPU marks what the GPU marked before.
TEST_P(Metamorphic, TranslationsByWholeVoxelsMoveTheVoxels) {
    for (const glm::ivec3& by : {glm::ivec3(1, 0, 0), glm::ivec3(-17, 5, 33), glm::ivec3(-64, 64, -64),
                                 glm::ivec3(0, 0, 32), glm::ivec3(200, -300, 0)}) {
        std::vector<LatticeTriangle> moved(
            triangles_.begin(), triangles_.begin() + std::min<std::ptrdiff_t>(std::ssize(triangles_), 500));
        const BitGrid expected = voxelize(moved, all);
        for (LatticeTriangle& t : moved) {
            for (glm::i64vec3& p : t)
                p += glm::i64vec3(by) * voxel;
        }
        EXPECT_TRUE(same_bits(voxelize(moved, {all.level, by, all.size}), expected))
            << fmt::format("by {} {} {}", by.x, by.y, by.z);
    }
}

TEST_P(Metamorphic, TheOrderOfTrianglesDoesNotMatter) {
    Random random(43);
    for (int run = 0; run < 3; ++run) {
        for (std::size_t i = triangles_.size() - 1; i > 0; --i)
            std::swap(triangles_[i], triangles_[std::size_t(random.between(0, std::int64_t(i)))]);
        EXPECT_TRUE(same_bits(voxelize(triangles_, all), bits_)) << "shuffle " << run;
    }
}

TEST_P(Metamorphic, TheOrderOfCornersDoesNotMatter) {
    glm::ivec3 order(0, 1, 2);
    do {
        std::vector<LatticeTriangle> permuted;
        for (const LatticeTriangle& t : triangles_)
            permuted.push_back({t[std::size_t(order.x)], t[std::size_t(order.y)], t[std::size_t(order.z)]});
        EXPECT_TRUE(same_bits(voxelize(permuted, all), bits_))
            << fmt::format("{} {} {}", order.x, order.y, order.z);
    } while (std::next_permutation(&order[0], &order[0] + 3));
}

/// The parts of a triangle between the lattice points a + (i ab + j ac) / sides; ab and ac must be multiples
/// of `sides`.
void subdivide(const LatticeTriangle& t, std::int64_t sides, std::vector<LatticeTriangle>& out) {
    const glm::i64vec3 ab = (t[1] - t[0]) / sides;
    const glm::i64vec3 ac = (t[2] - t[0]) / sides;
    const auto at = [&](std::int64_t i, std::int64_t j) { return t[0] + ab * i + ac * j; };
    for (std::int64_t i = 0; i < sides; ++i) {
        for (std::int64_t j = 0; i + j < sides; ++j) {
            out.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
            if (i + j + 1 < sides) out.push_back({at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)});
        }
    }
}

TEST_P(Metamorphic, SubdivisionDoesNotChangeTheUnion) {
    triangles_.resize(std::min<std::size_t>(triangles_.size(), 10000));  // times 49 below
    for (const std::int64_t sides : {2, 3, 7}) {
        std::vector<LatticeTriangle> coarse = triangles_;
        std::vector<LatticeTriangle> fine;
        for (LatticeTriangle& t : coarse) {
            for (const std::size_t corner : {1, 2})
                t[corner] = t[0] + (t[corner] - t[0]) / sides * sides;
            subdivide(t, sides, fine);
        }
        EXPECT_TRUE(same_bits(voxelize(fine, all), voxelize(coarse, all))) << sides << " parts a side";
    }
}

// A fan from one corner to points of the opposite side at uneven distances: its neighbours' corners lie on
// its sides.
TEST_P(Metamorphic, UnevenFansDoNotChangeTheUnion) {
    Random random(44);
    std::vector<LatticeTriangle> coarse = triangles_;
    std::vector<LatticeTriangle> fine;
    for (LatticeTriangle& t : coarse) {
        constexpr std::int64_t parts = 1024;
        t[2] = t[1] + (t[2] - t[1]) / parts * parts;
        const glm::i64vec3 step = (t[2] - t[1]) / parts;
        std::int64_t from = 0;
        while (from < parts) {
            const std::int64_t to = std::min(parts, from + random.between(1, 600));
            fine.push_back({t[1] + step * to, t[0], t[1] + step * from});
            from = to;
        }
    }
    EXPECT_TRUE(same_bits(voxelize(fine, all), voxelize(coarse, all)));
}

TEST_P(Metamorphic, EachResolutionIsTheOrOfTwiceAsMany) {
    const GpuSurface surface = upload(lattice_surface(triangles_, 256));
    const BitmaskPyramid pyramid = voxelizer().voxelize_pyramid(surface, {8, glm::ivec3(0), glm::ivec3(256)});
    for (int level = 0; level < 9; ++level) {
        const Region region{8 - level, glm::ivec3(0), glm::ivec3(256 >> level)};
        EXPECT_TRUE(same_bits(voxelizer().voxelize(surface, region), pyramid.level(level)))
            << "resolution " << region.size.x;
    }
}

/// The part of `whole`, which begins at `origin`, that a region within it holds.
BitGrid cut_out(const BitGrid& whole, const glm::ivec3& origin, const Region& region) {
    BitGrid out(region.size);
    for (int z = 0; z < region.size.z; ++z)
        for (int y = 0; y < region.size.y; ++y)
            for (int x = 0; x < region.size.x; ++x)
                if (whole.at(region.origin - origin + glm::ivec3(x, y, z))) out.set({x, y, z});
    return out;
}

TEST_P(Metamorphic, RandomBoxesHoldTheBitsOfTheWhole) {
    const GpuSurface surface = upload(lattice_surface(triangles_, resolution));
    Random random(45);
    for (const int level : {6, 8}) {
        const int side = 1 << level;
        const Region wide{level, glm::ivec3(-9), glm::ivec3(side + 18)};  // past the cube on every side
        const BitGrid whole_bits = voxelizer().voxelize(surface, wide);
        for (int i = 0; i < 12; ++i) {
            const glm::ivec3 a(random.point(-9, side + 8));
            const glm::ivec3 b(random.point(-9, side + 8));
            const Region box{level, glm::min(a, b), glm::abs(a - b) + 1};
            EXPECT_TRUE(same_bits(voxelizer().voxelize(surface, box), cut_out(whole_bits, wide.origin, box)))
                << fmt::format("level {}, from {} {} {}, size {} {} {}", level, box.origin.x, box.origin.y,
                               box.origin.z, box.size.x, box.size.y, box.size.z);
        }
    }
}

TEST_P(Metamorphic, SubsetsAddUpToAll) {
    const GpuSurface surface = upload(lattice_surface(triangles_, resolution));
    Random random(46);
    std::vector<std::vector<std::uint32_t>> parts(5);
    for (std::uint32_t i = 0; i < triangles_.size(); ++i)
        parts[std::size_t(random.between(0, 4))].push_back(i);
    BitGrid sum(all.size);
    for (const std::vector<std::uint32_t>& part : parts) {
        const BitGrid bits = voxelizer().voxelize(surface, all, part);
        for (std::size_t w = 0; w < bits.words.size(); ++w)
            sum.words[w] |= bits.words[w];
    }
    EXPECT_TRUE(same_bits(sum, bits_));
}

TEST_P(Metamorphic, TheSubsetThatReachesABoxIsEnoughForIt) {
    const GpuSurface surface = upload(lattice_surface(triangles_, resolution));
    Random random(47);
    for (int i = 0; i < 10; ++i) {
        const glm::ivec3 low(random.point(0, resolution - 8));
        const Region box{all.level, low, glm::ivec3(random.point(1, 8))};
        const glm::i64vec3 box_low = glm::i64vec3(box.origin) * voxel;
        const glm::i64vec3 box_high = glm::i64vec3(box.origin + box.size) * voxel;
        std::vector<std::uint32_t> reaching;
        for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
            const auto& [a, b, c] = triangles_[t];
            if (glm::all(glm::lessThanEqual(glm::min(glm::min(a, b), c), box_high)) &&
                glm::all(glm::greaterThanEqual(glm::max(glm::max(a, b), c), box_low)))
                reaching.push_back(t);
        }
        EXPECT_TRUE(
            same_bits(voxelizer().voxelize(surface, box, reaching), cut_out(bits_, glm::ivec3(0), box)))
            << fmt::format("box at {} {} {}", low.x, low.y, low.z);
    }
}

std::vector<Named> surfaces() {
    std::vector<Named> out = {{"Random", random_surface}, {"Needles", needles}};
#ifdef CAIRN_ENGINE
    out.push_back({"Engine", [] { return triangles_of(CAIRN_ENGINE); }});
#endif
    return out;
}

INSTANTIATE_TEST_SUITE_P(Surfaces, Metamorphic, ::testing::ValuesIn(surfaces()),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace cairn::voxelizer
