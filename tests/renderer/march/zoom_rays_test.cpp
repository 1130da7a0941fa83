// The marching loop against a walk in whole numbers: the first occupied voxel that a ray meets.
//
// A ray's steps are in floats, so it may take either side if the exact ray is closer to a voxel's edge than
// floats can resolve. A mismatch is a ray whose first voxel is neither the exact one, nor one that the exact
// ray comes within `margin` of while it comes no deeper than that into any occupied voxel before it. Both
// counts are printed.
//
// CAIRN_RAY_COUNT in the environment sets how many rays each test takes; the default is a sample.

#include <array>
#include <cmath>
#include <cstdlib>
#include <random>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "renderer/produce/fractal_content.h"
#include "tests/support/exact_rays.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/probe.h"

namespace cairn::test {
namespace {

using renderer::TreeShape;

constexpr int direction_bits = 56;
constexpr std::size_t batch_rays = 125'000;  // as many of each kind

std::size_t ray_count(std::size_t sample) {
    const char* text = std::getenv("CAIRN_RAY_COUNT");
    return text != nullptr ? std::size_t(std::strtoull(text, nullptr, 10)) : sample;
}

/// Random numbers: the same stream with every standard library.
class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    unsigned below(unsigned end) { return unsigned(engine_() % end); }
    double unit() { return double(engine_() >> 8U) * 0x1p-24; }
    float sign() { return below(2) == 0 ? 1.0F : -1.0F; }
    std::uint64_t bits() { return std::uint64_t(engine_()) << 32U | engine_(); }

private:
    std::mt19937 engine_;
};

/// Values that the loop takes for 0, because a ray that slow never crosses a plane.
constexpr float inert_components[] = {0.0F, -0.0F, 1e-40F, -1e-40F, 1e-21F, -1e-30F};

enum Kind { anywhere, along_an_axis, in_a_plane, diagonal, nearly_along_an_axis, kind_count };

glm::vec3 direction_of(Kind kind, Random& random) {
    glm::vec3 d(0.0F);
    if (kind == diagonal) {
        const bool flat = random.below(3) == 0;
        d = glm::vec3(random.sign(), random.sign(), random.sign()) * (flat ? 0.70710677F : 0.57735026F);
        if (flat) d[int(random.below(3))] = inert_components[random.below(6)];
        return d;
    }
    do {
        d = glm::vec3(random.unit(), random.unit(), random.unit()) * 2.0F - 1.0F;
    } while (glm::length(d) > 1.0F || glm::length(d) < 0.1F);
    d /= glm::length(d);
    const int axis = int(random.below(3));
    if (kind == in_a_plane) d[axis] = inert_components[random.below(6)];
    if (kind == along_an_axis || kind == nearly_along_an_axis) {
        for (int other = 0; other < 3; ++other) {
            d[other] = kind == along_an_axis ? inert_components[random.below(6)]
                                             : random.sign() * std::ldexp(float(0.5 + 0.5 * random.unit()),
                                                                          -int(random.below(30)));
        }
        d[axis] = random.sign();
    }
    return d;
}

glm::i64vec3 exact_direction(const glm::vec3& d) {
    glm::i64vec3 out(0);
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(d[axis]) < 1e-20F) continue;
        const double scaled = std::ldexp(double(d[axis]), direction_bits);
        EXPECT_EQ(scaled, std::floor(scaled)) << "a component of " << d[axis] << " has too many bits";
        out[axis] = std::int64_t(scaled);
    }
    return out;
}

struct Tally {
    std::size_t rays = 0, hits = 0, second_check = 0, wrong = 0;
    std::array<std::size_t, kind_count> second_check_of{};  ///< number per Kind
    std::string first;
};

enum class Verdict { exact, within_margin, wrong };

/// @param margin  in units of a voxel's side
Verdict judge(const std::vector<Space>& spaces, const ExactRay& ray, bool hit, const Crossed& ours,
              long double margin) {
    Verdict verdict = Verdict::exact;
    bool decided = false;
    auto meets_ours_before = [&](long double time) {
        if (!hit || !renderer::fractal::occupied(ours.voxel, spaces[std::size_t(ours.space)].bits))
            return false;
        const Interval grown = inside(spaces, ray, ours, margin);
        return !grown.empty() && grown.first <= time;
    };
    cross_occupied(spaces, ray, [&](const Crossed& theirs) {
        if (hit && theirs.space == ours.space && theirs.voxel == ours.voxel) {
            decided = true;
            return true;
        }
        verdict = Verdict::within_margin;
        if (inside(spaces, ray, theirs, -margin).empty()) return false;  // only grazed
        if (!meets_ours_before(inside(spaces, ray, theirs, margin).last)) verdict = Verdict::wrong;
        decided = true;
        return true;
    });
    if (decided) return verdict;
    // The exact ray passes the set.
    if (!hit) return verdict;
    return meets_ours_before(std::numeric_limits<long double>::infinity()) ? Verdict::within_margin
                                                                           : Verdict::wrong;
}

void count(Tally& tally, Verdict verdict, const Probe& probe, const glm::vec3& direction,
           const Crossed& ours) {
    const std::size_t kind = tally.rays++ % kind_count;
    tally.hits += probe.state.x == PROBE_HIT ? 1 : 0;
    if (verdict == Verdict::within_margin) {
        ++tally.second_check;
        ++tally.second_check_of[kind];
    }
    if (verdict != Verdict::wrong || tally.wrong++ != 0) return;
    tally.first = fmt::format("ray along ({}, {}, {}): {} voxel ({}, {}, {}) of space {}", direction.x,
                              direction.y, direction.z, probe.state.x == PROBE_HIT ? "met" : "missed, last",
                              ours.voxel.x, ours.voxel.y, ours.voxel.z, ours.space);
}

void expect_none_wrong(const Tally& tally) {
    EXPECT_EQ(tally.wrong, 0U) << tally.first;
    EXPECT_GT(tally.hits * 20, tally.rays) << "hardly a ray met anything";
    EXPECT_LT(tally.second_check * 50, tally.rays) << "the second check decides too much";
    fmt::print("{} rays, {} of them met a voxel; {} needed the second check ({} of each kind); {} wrong\n",
               tally.rays, tally.hits, tally.second_check, fmt::join(tally.second_check_of, ", "),
               tally.wrong);
}

class RayTest : public GlTest {};

/// A place on the voxel grid: anywhere (in 1/256), on a face, edge or corner of small or large cells.
glm::vec3 origin_of(Random& random, int side) {
    glm::vec3 origin;
    const bool around = random.below(4) == 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double place = around ? (2.0 * random.unit() - 0.5) * side : random.unit() * side;
        const double step = random.below(2) == 0 ? 1.0 / 256.0 : std::ldexp(1.0, int(random.below(7)) - 1);
        origin[axis] = float(std::floor(place / step) * step);
    }
    return origin;
}

Tally through_one_root(const TreeShape& shape, std::size_t rays, unsigned seed) {
    const int bits = shape.voxel_level(shape.max_level);
    const std::vector<Space> spaces = {{glm::i64vec3(0), std::int64_t(1) << bits, 0, bits, bits}};
    Prober prober(shape, 256U << 20U, 16U << 20U);
    Random random(seed);
    Tally tally;
    while (tally.rays < rays) {
        std::vector<Probe> probes(std::min(batch_rays, rays - tally.rays));
        for (std::size_t i = 0; i < probes.size(); ++i) {
            probes[i].origin_t = glm::vec4(origin_of(random, 1 << bits), 0.0F);
            probes[i].direction = glm::vec4(direction_of(Kind(i % kind_count), random), 0.0F);
        }
        const std::vector<Probe> asked = probes;
        prober.run(probes);
        for (std::size_t i = 0; i < probes.size(); ++i) {
            ExactRay ray{.origin = {}, .direction = exact_direction(asked[i].direction), .fraction_bits = 8};
            for (int axis = 0; axis < 3; ++axis)
                ray.origin[axis] = Wide(std::int64_t(std::ldexp(double(asked[i].origin_t[axis]), 8)));
            const Crossed ours{0, glm::i64vec3(probes[i].voxel_window)};
            // Distances up to 2.6 sides, rounded three times, and a sum rounded once.
            const long double margin = std::ldexp(1.0L, bits - 21);
            count(tally, judge(spaces, ray, probes[i].state.x == PROBE_HIT, ours, margin), probes[i],
                  asked[i].direction, ours);
        }
    }
    return tally;
}

TEST_F(RayTest, FirstVoxelOfARayIsTheOneOfAnExactWalk) {
    fmt::print("seed 1: ");
    expect_none_wrong(through_one_root({.n = 4, .m = 16, .max_level = 2}, ray_count(1'000'000), 1));
}

TEST_F(RayTest, FirstVoxelInAFineTreeIsTheOneOfAnExactWalk) {
    fmt::print("seed 2: ");
    expect_none_wrong(through_one_root({.n = 2, .m = 8, .max_level = 13}, ray_count(1'000'000) / 100, 2));
}

/// A place in the empty octant of a random tile that is not empty.
struct DeepEye {
    renderer::TilePoint place;
    WideVector exact;  // in 2^-60 of the root cube
};

constexpr int fixed_bits = 60;

DeepEye deep_eye(const TreeShape& shape, int level, Random& random) {
    DeepEye eye;
    eye.place.tile.level = level;
    const int tile_bits = shape.n_shift() * level;
    const glm::i64vec3 any(std::int64_t(random.bits() >> 4U), std::int64_t(random.bits() >> 4U),
                           std::int64_t(random.bits() >> 4U));
    const std::int64_t common = any.x & any.y & any.z;
    const std::int64_t below = (std::int64_t(1) << tile_bits) - 1;
    for (int axis = 0; axis < 3; ++axis) {
        // Bits in all three are cleared in one of them.
        const std::int64_t path = axis == 0 ? any[axis] & ~common : any[axis];
        eye.place.tile.position[axis] = path & below;
        const auto offset =
            std::int64_t(std::ldexp(0.52 + 0.46 * random.unit(), 40));  // in 2^-40 of the tile
        const int rest = fixed_bits - tile_bits;
        const std::int64_t fixed = rest >= 40 ? offset << (rest - 40) : offset >> (40 - rest);
        eye.place.offset[axis] = std::ldexp(double(fixed), -rest);
        eye.exact[axis] = (Wide(eye.place.tile.position[axis]) << rest) + fixed;
    }
    return eye;
}

std::vector<Space> spaces_of(const std::vector<renderer::Window>& windows, const TreeShape& shape) {
    const int tile_shift = shape.m_shift() + shape.n_shift() * shape.levels_in_window();
    std::vector<Space> spaces;
    for (const renderer::Window& window : windows) {
        spaces.push_back({window.low << std::int64_t(tile_shift), std::int64_t(2) << tile_shift,
                          shape.n_shift() * int(spaces.size()), shape.n_shift() * window.level + tile_shift,
                          tile_shift});
    }
    return spaces;
}

Tally through_windows(const TreeShape& shape, std::size_t rays, unsigned seed) {
    Prober prober(shape, 128U << 20U, 16U << 20U);
    const int voxel_bits = shape.voxel_level(shape.max_level);
    Random random(seed);
    Tally tally;
    constexpr int eyes = 8;
    for (int number = 0; number < eyes; ++number) {
        // From the whole root cube to 2^-44 of it.
        const DeepEye eye = deep_eye(shape, 44 / shape.n_shift() * number / (eyes - 1), random);
        const std::vector<renderer::Window> windows = renderer::windows_around(shape, eye.place);
        const std::vector<Space> spaces = spaces_of(windows, shape);
        std::vector<Probe> probes(rays / eyes / kind_count * kind_count);
        for (std::size_t i = 0; i < probes.size(); ++i)
            probes[i].direction = glm::vec4(direction_of(Kind(i % kind_count), random), 0.0F);
        const std::vector<Probe> asked = probes;
        prober.run(probes, windows, eye.place);
        for (std::size_t i = 0; i < probes.size(); ++i) {
            const ExactRay ray{eye.exact, exact_direction(asked[i].direction), fixed_bits - voxel_bits};
            Crossed ours{probes[i].voxel_window.w, glm::i64vec3(probes[i].voxel_window)};
            ours.voxel += spaces[std::size_t(ours.space)].low;
            const long double margin = std::ldexp(1.0L, shape.window_tile_bits + 1 - 21);
            count(tally, judge(spaces, ray, probes[i].state.x == PROBE_HIT, ours, margin), probes[i],
                  asked[i].direction, ours);
        }
    }
    return tally;
}

TEST_F(RayTest, FirstVoxelThroughManyWindowsIsTheOneOfAnExactWalk) {
    fmt::print("seed 3: ");
    expect_none_wrong(through_windows({.n = 2, .m = 8, .max_level = 49, .window_tile_bits = 5},
                                      ray_count(1'000'000) / 4, 3));
    fmt::print("seed 4: ");
    expect_none_wrong(through_windows({.n = 4, .m = 16, .max_level = 24, .window_tile_bits = 8},
                                      ray_count(1'000'000) / 20, 4));
}

TEST_F(RayTest, FirstVoxelThroughWindowsOfFullSizeIsTheOneOfAnExactWalk) {
    fmt::print("seed 5: ");
    expect_none_wrong(through_windows({.n = 2, .m = 8, .max_level = 49}, ray_count(1'000'000) / 100, 5));
}

}  // namespace
}  // namespace cairn::test
