// The truth against a second one: separating axes against clipping (clipped_triangle.h), on triangles and
// boxes that only just touch, or only just do not.
#include "reference/separating_axes.h"

#include <cstdlib>
#include <vector>

#include <fmt/format.h>
#include <gmpxx.h>
#include <gtest/gtest.h>

#include "tests/support/clipped_triangle.h"
#include "tests/support/lattice_surface.h"
#include "voxelizer/surface/wide_integer.h"

namespace cairn::reference {
namespace {

using namespace cairn::test;
using voxelizer::Int128;

constexpr std::int64_t farthest = std::int64_t(1) << 40;

struct Trial {
    LatticeTriangle triangle;
    glm::i64vec3 low, high;
};

std::string to_string(const Trial& trial) {
    return cairn::test::to_string(trial.triangle) + fmt::format("box ({} {} {}) to ({} {} {})", trial.low.x,
                                                                trial.low.y, trial.low.z, trial.high.x,
                                                                trial.high.y, trial.high.z);
}

/// A point of the triangle, but for rounding: on a corner, on a side, or anywhere.
glm::i64vec3 point_on(Random& random, const LatticeTriangle& t) {
    const std::int64_t kind = random.between(0, 3);
    if (kind == 0) return t[std::size_t(random.between(0, 2))];
    const std::int64_t parts = std::int64_t(1) << random.between(1, 10);
    const std::int64_t u = random.between(0, parts);
    const std::int64_t v = kind == 1 ? 0 : random.between(0, parts - u);
    const std::size_t first = std::size_t(random.between(0, 2));
    const glm::i64vec3 a = t[first];
    return a + ((t[(first + 1) % 3] - a) * u + (t[(first + 2) % 3] - a) * v) / parts;
}

/// A box with a corner, an edge or a face at a point.
void put_box_at(Trial& trial, Random& random, const glm::i64vec3& point, const glm::i64vec3& size) {
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t place = random.between(0, 2);
        const std::int64_t before = place == 0 ? 0 : place == 1 ? size[axis] : random.between(0, size[axis]);
        trial.low[axis] = point[axis] - before;
    }
    trial.high = trial.low + size;
}

/// Triangles, needles, segments and points within +-reach, and a box that begins on one.
Trial within(std::int64_t reach, Random& random) {
    Trial trial;
    LatticeTriangle& t = trial.triangle;
    for (glm::i64vec3& p : t)
        p = random.point(-reach, reach);
    const std::int64_t kind = random.between(0, 9);
    if (kind == 0) t[2] = t[1];
    if (kind == 1) t[1] = t[2] = t[0];
    if (kind == 2) t[2] = (t[0] + t[1]) / std::int64_t(2);
    if (kind == 3)
        t[2] = glm::clamp((t[0] + t[1]) / std::int64_t(2) + random.point(-2, 2), -farthest, farthest);
    if (kind == 4) t[1][int(random.between(0, 2))] = t[0][0];
    if (kind == 5) {
        const int axis = int(random.between(0, 2));
        t[2][axis] = t[1][axis] = t[0][axis];
    }
    const std::int64_t longest = std::int64_t(1) << random.between(0, 39);
    put_box_at(trial, random, point_on(random, t), random.point(0, std::min(longest, 2 * reach)));
    const glm::i64vec3 moved = random.point(-1, 1);
    trial.low = glm::clamp(trial.low + moved, -farthest, farthest);
    trial.high = glm::clamp(trial.high + moved, -farthest, farthest);
    return trial;
}

/// Triangles with corners on voxel planes, or one unit beside them, and a voxel nearby: contacts of every
/// kind.
Trial on_lattice(Random& random) {
    Trial trial;
    LatticeTriangle& t = trial.triangle;
    const std::int64_t side = std::int64_t(1) << random.between(0, 24);
    const std::int64_t reach = random.between(1, 8);
    const std::int64_t away = (farthest / 2) / side;
    const glm::i64vec3 centre = random.between(0, 3) == 0 ? random.point(-away, away) : glm::i64vec3(0);
    for (glm::i64vec3& p : t)
        p = (centre + random.point(-reach, reach)) * side;
    const std::int64_t kind = random.between(0, 7);
    if (kind == 0) t[2] = t[1];
    if (kind == 1) t[2] = t[1] + (t[1] - t[0]);
    const glm::i64vec3 on_triangle = point_on(random, t);
    if (random.between(0, 1) == 0) t[std::size_t(random.between(0, 2))] += random.point(-1, 1);
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t cell = std::int64_t(voxelizer::floor_divide(on_triangle[axis], side));
        trial.low[axis] = (cell + random.between(-1, 1)) * side;
    }
    trial.high = trial.low + side * random.between(1, 2);
    return trial;
}

struct Tally {
    int met = 0;
    /// Pairs for which a box smaller by a unit on every side is missed, or a box larger by a unit is met.
    int just = 0;
};

void count(Tally& tally, const Trial& trial, bool met) {
    tally.met += met ? 1 : 0;
    const std::int64_t unit = met ? -1 : 1;
    const bool other = triangle_meets_box(trial.triangle, trial.low - unit, trial.high + unit);
    tally.just += met != other ? 1 : 0;
}

template <class Number, class MakeTrial>
void expect_agreement(std::uint32_t seed, int trials, const MakeTrial& make_trial) {
    Random random(seed);
    Tally tally;
    for (int i = 0; i < trials; ++i) {
        const Trial trial = make_trial(random);
        const bool expected = is_left_in_box<Number>(trial.triangle, trial.low, trial.high);
        ASSERT_EQ(triangle_meets_box(trial.triangle, trial.low, trial.high), expected)
            << "seed " << seed << ", trial " << i << ": " << to_string(trial);
        count(tally, trial, expected);
    }
    EXPECT_GT(tally.met, trials / 4) << "most boxes were missed: the trials say little";
    EXPECT_LT(tally.met, trials / 4 * 3) << "most boxes were met: the trials say little";
    EXPECT_GT(tally.just, trials / 8) << "few touch by a unit: the trials say little";
}

TEST(SeparatingAxes, AgreeWithClippingOnAMillionTrianglesOfEverySize) {
    expect_agreement<Int128>(
        1, 1000000, [](Random& random) { return within(std::int64_t(1) << random.between(1, 40), random); });
}

TEST(SeparatingAxes, AgreeWithClippingOnAMillionTrianglesOnVoxelPlanes) {
    expect_agreement<Int128>(2, 1000000, on_lattice);
}

// Both use 128 bits above. Numbers of any length show whether 128 bits are enough for the greatest
// coordinates.
TEST(SeparatingAxes, AgreeWithClippingInNumbersWithoutEnd) {
    expect_agreement<mpz_class>(3, 100000, [](Random& random) { return within(farthest, random); });
}

TEST(SeparatingAxes, HoldAtTheEdgeOfTheirRange) {
    // The plane x + y + z = 0 through a corner of the box, and one unit beside it.
    const LatticeTriangle t = {glm::i64vec3(farthest, -farthest, 0), glm::i64vec3(-farthest, 0, farthest),
                               glm::i64vec3(0, farthest, -farthest)};
    for (const auto& [low, high, expected] : {std::tuple(glm::i64vec3(0), glm::i64vec3(5), true),
                                              std::tuple(glm::i64vec3(1, 0, 0), glm::i64vec3(5), false),
                                              std::tuple(glm::i64vec3(-5), glm::i64vec3(0), true),
                                              std::tuple(glm::i64vec3(-5), glm::i64vec3(0, -1, 0), false)}) {
        EXPECT_EQ(triangle_meets_box(t, low, high), expected) << to_string(Trial{t, low, high});
        EXPECT_EQ(is_left_in_box<mpz_class>(t, low, high), expected) << to_string(Trial{t, low, high});
    }
}

}  // namespace
}  // namespace cairn::reference
