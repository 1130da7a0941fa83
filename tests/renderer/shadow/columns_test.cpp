// Rays through the xy-reduced pyramid against walks from voxel to voxel on the CPU.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "gl/handle.h"
#include "gl/program.h"
#include "renderer/shadow/column_pyramid.h"
#include "renderer/shadow/shadow_base.h"
#include "tests/support/gl_fixture.h"
#include "voxelizer/bit_grid.h"

namespace cairn::test {
namespace {

using renderer::ColumnMask;
using renderer::ColumnPyramid;
using voxelizer::BitGrid;

constexpr unsigned group_size = 64;

/// A ray, and the occupied voxel that it meets after skipping some.
struct Probe {
    glm::vec4 origin_start{0.0F};
    /// xyz: direction, of any length; w: end of the ray.
    glm::vec4 direction_end{0.0F, 0.0F, 0.0F, 1e30F};
    /// xyz: voxel that is found, -1 if none; w: number of voxels to skip.
    glm::ivec4 voxel_skipped{-1, -1, -1, 0};
    /// x: distance of the middle of the way through the voxel; y: turns of the loop.
    glm::vec4 found{0.0F};
};

constexpr const char* probe_shader = R"(
struct Probe { vec4 origin_start; vec4 direction_end; ivec4 voxel_skipped; vec4 found; };
layout(std430, binding = 5) buffer ProbeBlock { Probe probes[]; };
layout(local_size_x = 64) in;
uniform uint probe_count;
ivec3 seen;
float seen_t;
int left;
bool visit_voxel(ivec3 voxel, float t) {
    seen = voxel;
    seen_t = t;
    return --left >= 0;
}
void main() {
    const uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (i >= probe_count) return;
    Ray ray = make_ray(probes[i].origin_start.xyz, probes[i].direction_end.xyz, probes[i].direction_end.w, 0.0, 0.0);
    ray.t = probes[i].origin_start.w;
    left = probes[i].voxel_skipped.w;
    int turns = 0;
    const bool stopped = trace_columns(ray, turns);
    probes[i].voxel_skipped.xyz = stopped ? seen : ivec3(-1);
    probes[i].found = vec4(stopped ? seen_t : 0.0, float(turns), 0.0, 0.0);
}
)";

gl::Program build(const ColumnPyramid& pyramid, ColumnMask mask) {
    gl::Defines defines = pyramid.defines();
    defines.emplace_back("COLUMN_MASK", std::to_string(int(mask)));
    const std::string text =
        gl::ShaderSource().resolve("shadow/trace_columns.glsl", defines).text + probe_shader;
    const char* source = text.c_str();
    const gl::ShaderHandle shader(glCreateShader(GL_COMPUTE_SHADER));
    glShaderSource(shader.id(), 1, &source, nullptr);
    glCompileShader(shader.id());
    gl::Program program{gl::ProgramHandle(glCreateProgram())};
    glAttachShader(program.id(), shader.id());
    glLinkProgram(program.id());
    GLint linked = 0;
    glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
    if (linked == 0) {
        std::string log(4096, '\0');
        glGetShaderInfoLog(shader.id(), GLsizei(log.size()), nullptr, log.data());
        throw Error(Fault::context, "test", log);
    }
    return program;
}

constexpr std::array masks = {ColumnMask::mip_level, ColumnMask::adaptive};
constexpr std::array mask_names = {"mip level", "adaptive"};

/// A grid of bits and its pyramid.
class Columns {
public:
    explicit Columns(BitGrid bits)
        : bits_(std::move(bits)), pyramid_(bits_.size.y), padded_(pyramid_.grid_size()) {
        const int row = bits_.words_per_row();
        for (std::size_t i = 0; i < bits_.words.size(); ++i)
            padded_
                .words[i / std::size_t(row) * std::size_t(padded_.words_per_row()) + i % std::size_t(row)] =
                bits_.words[i];
        pyramid_.build(gl::Buffer::of(std::span<const std::uint32_t>(padded_.words), "bits"));
    }

    std::vector<Probe> trace(std::vector<Probe> probes, ColumnMask mask) const {
        const gl::Program program = build(pyramid_, mask);
        const gl::Buffer buffer = gl::Buffer::of(std::span<const Probe>(probes), "probes");
        pyramid_.bind_for_reading();
        buffer.bind_storage(5);
        program.set("probe_count", unsigned(probes.size()));
        program.use();
        gl::dispatch_threads(probes.size(), group_size);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        return buffer.read_all<Probe>(probes.size());
    }

    [[nodiscard]] const BitGrid& bits() const { return bits_; }
    [[nodiscard]] const BitGrid& padded() const { return padded_; }
    [[nodiscard]] const ColumnPyramid& pyramid() const { return pyramid_; }
    [[nodiscard]] bool occupied(const glm::i64vec3& v) const {
        const glm::i64vec3 side(bits_.size.y);
        return glm::all(glm::greaterThanEqual(v, glm::i64vec3(0))) && glm::all(glm::lessThan(v, side)) &&
               bits_.at(glm::ivec3(v));
    }

private:
    BitGrid bits_;
    ColumnPyramid pyramid_;
    BitGrid padded_;
};

struct Dice {
    std::mt19937 rng;
    float unit() { return float(rng() >> 8U) * 0x1p-24F; }
    int below(int n) { return int(rng() % unsigned(n)); }
};

/// Planes, rods and dust.
BitGrid clutter(int side, double dust, Dice& dice) {
    BitGrid bits((glm::ivec3(side)));
    const auto count = int(dust * side * side * side);
    for (int i = 0; i < count; ++i)
        bits.set({dice.below(side), dice.below(side), dice.below(side)});
    for (int i = 0; i < side / 8; ++i) {
        glm::ivec3 at(dice.below(side), dice.below(side), dice.below(side));
        const int axis = dice.below(3);
        for (int k = dice.below(side); k < side; ++k) {
            at[axis] = k;
            bits.set(at);
        }
    }
    return bits;
}

/// Components are 0, -0 or powers of two and places are eighths of voxels: then every crossing time is a
/// float, and rays meet faces, edges and corners all the time.
Probe dyadic_probe(int side, Dice& dice) {
    Probe probe;
    bool moves = false;
    for (int axis = 0; axis < 3; ++axis) {
        const int kind = dice.below(7);
        float d = 0.0F;
        if (kind > 1) d = std::ldexp(dice.below(2) == 0 ? 1.0F : -1.0F, dice.below(5) - 2);
        if (kind == 1) d = -0.0F;
        probe.direction_end[axis] = d;
        moves = moves || d != 0.0F;
        const int grain = dice.below(3) == 0 ? 8 : 1;  // often on a plane
        probe.origin_start[axis] = float(dice.below(8 * (side - 1)) / grain * grain + 4) / 8.0F;
    }
    if (!moves) probe.direction_end.x = 1.0F;
    if (dice.below(3) == 0) probe.direction_end.w = float(dice.below(4 * side) + 1) / 4.0F;
    if (dice.below(3) == 0) probe.voxel_skipped.w = dice.below(4);
    return probe;
}

/// The voxel that a dyadic ray finds, in whole numbers, with times in 1/256. The ray starts past the planes
/// at 0.
glm::i64vec3 walk_exactly(const Columns& columns, const Probe& probe) {
    const std::int64_t never = std::int64_t(1) << 60;
    glm::i64vec3 voxel(0);
    glm::i64vec3 step(0);
    std::array<std::int64_t, 3> scale{};  // time between planes
    glm::i64vec3 origin(0);               // eighths
    for (int axis = 0; axis < 3; ++axis) {
        const float d = probe.direction_end[axis];
        origin[axis] = std::int64_t(probe.origin_start[axis] * 8.0F);
        voxel[axis] = origin[axis] >> 3;
        if (d == 0.0F) continue;
        step[axis] = d > 0.0F ? 1 : -1;
        scale[std::size_t(axis)] = std::int64_t(256.0F / std::abs(d));
        if (d < 0.0F && (origin[axis] & 7) == 0) --voxel[axis];
    }
    voxel = glm::max(voxel, glm::i64vec3(0));
    const auto end = probe.direction_end.w > 1e9F ? never : std::int64_t(probe.direction_end.w * 256.0F);
    int skip = probe.voxel_skipped.w;
    const std::int64_t side = columns.bits().size.y;
    for (;;) {
        if (columns.occupied(voxel) && --skip < 0) return voxel;
        int axis = 0;
        std::array<std::int64_t, 3> time{};
        for (int a = 0; a < 3; ++a) {
            const std::int64_t plane = step[a] > 0 ? voxel[a] + 1 : voxel[a];
            time[std::size_t(a)] =
                step[a] == 0 ? never : (8 * plane - origin[a]) * step[a] * scale[std::size_t(a)] / 8;
            if (time[std::size_t(a)] < time[std::size_t(axis)]) axis = a;
        }
        if (time[std::size_t(axis)] >= end) return glm::i64vec3(-1);
        voxel[axis] += step[axis];
        if (voxel[axis] < 0 || voxel[axis] >= side) return glm::i64vec3(-1);
    }
}

std::string text_of(const Probe& probe) {
    return fmt::format("from ({}, {}, {}) at {} along ({}, {}, {}) to {}, skipping {}", probe.origin_start.x,
                       probe.origin_start.y, probe.origin_start.z, probe.origin_start.w,
                       probe.direction_end.x, probe.direction_end.y, probe.direction_end.z,
                       probe.direction_end.w, probe.voxel_skipped.w);
}

std::string text_of(const glm::i64vec3& v) {
    return fmt::format("({}, {}, {})", v.x, v.y, v.z);
}

class ColumnRays : public GlTest {};

TEST_F(ColumnRays, LevelsAreTheOrOfColumnsAsOnTheCpu) {
    for (const int side : {8, 32, 128, 256}) {
        Dice dice{std::mt19937(unsigned(side))};
        const Columns columns(clutter(side, 0.001, dice));
        const ColumnPyramid& pyramid = columns.pyramid();
        const auto words = pyramid.texels().read_all<std::uint32_t>(pyramid.size_bytes() / 4);
        const int row = columns.padded().words_per_row();
        std::size_t first = 0;
        for (int level = 0; side >> level > 0; ++level) {
            const int across = side >> level;
            std::vector<std::uint32_t> expected(std::size_t(across) * std::size_t(across) * std::size_t(row));
            for (int z = 0; z < side; ++z) {
                for (int y = 0; y < side; ++y) {
                    for (int w = 0; w < row; ++w)
                        expected[std::size_t(((z >> level) * across + (y >> level)) * row + w)] |=
                            columns.padded().words[columns.padded().word_index(32 * w, y, z)];
                }
            }
            ASSERT_TRUE(std::equal(expected.begin(), expected.end(), words.begin() + std::ptrdiff_t(first)))
                << "side " << side << ", level " << level;
            first += expected.size();
        }
        EXPECT_EQ(first, words.size());
    }
}

TEST_F(ColumnRays, FindTheVoxelsOfAWalkInWholeNumbers) {
    for (const auto& [side, count, dust] :
         {std::tuple{8, 20000, 0.1}, {64, 50000, 0.015}, {256, 30000, 0.003}}) {
        Dice dice{std::mt19937(11U + unsigned(side))};
        const Columns columns(clutter(side, dust, dice));
        std::vector<Probe> probes;
        for (int i = 0; i < count; ++i)
            probes.push_back(dyadic_probe(side, dice));
        std::array<std::vector<Probe>, masks.size()> found;
        for (std::size_t m = 0; m < masks.size(); ++m)
            found[m] = columns.trace(probes, masks[m]);
        int hits = 0;
        int wrong = 0;
        for (std::size_t i = 0; i < probes.size() && wrong < 5; ++i) {
            const glm::i64vec3 truth = walk_exactly(columns, probes[i]);
            hits += truth.x >= 0 ? 1 : 0;
            for (std::size_t m = 0; m < masks.size(); ++m) {
                const glm::i64vec3 voxel(glm::ivec3(found[m][i].voxel_skipped));
                if (voxel == truth) continue;
                ++wrong;
                ADD_FAILURE() << "side " << side << ", " << mask_names[m] << ", ray " << i << " "
                              << text_of(probes[i]) << ": " << text_of(voxel) << ", not " << text_of(truth);
            }
        }
        EXPECT_GT(hits, count / 5) << side;
        EXPECT_LT(hits, count * 19 / 20) << side;
    }
}

/// A random ray: from inside, from outside, nearly along an axis, with denormal components.
Probe free_probe(int side, Dice& dice) {
    Probe probe;
    const float far = dice.below(4) == 0 ? 3.0F * float(side) : 0.0F;
    for (int axis = 0; axis < 3; ++axis) {
        const int kind = dice.below(12);
        float d = 2.0F * dice.unit() - 1.0F;
        if (kind < 3) d *= 1e-4F;
        if (kind == 3) d = 0.0F;
        if (kind == 4) d *= 1e-41F;
        probe.direction_end[axis] = d;
        probe.origin_start[axis] = dice.unit() * float(side) + (2.0F * dice.unit() - 1.0F) * far;
    }
    if (dice.below(3) == 0) probe.direction_end.w = dice.unit() * float(2 * side);
    if (dice.below(3) == 0) probe.origin_start.w = dice.unit() * float(side);
    return probe;
}

/// The part of a ray in a box, as distances; empty if first > last.
std::pair<double, double> part_in(const Probe& probe, const glm::dvec3& low, const glm::dvec3& high) {
    double first = probe.origin_start.w;
    double last = probe.direction_end.w;
    for (int axis = 0; axis < 3; ++axis) {
        const double o = probe.origin_start[axis];
        const double d = std::abs(probe.direction_end[axis]) < 1e-20F ? 0.0 : probe.direction_end[axis];
        if (d == 0.0) {
            if (o < low[axis] || o > high[axis]) return {1.0, 0.0};
            continue;
        }
        const double a = (low[axis] - o) / d;
        const double b = (high[axis] - o) / d;
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return {first, last};
}

/// The distance before which a ray must have met a voxel, by a walk in double over all occupied voxels that
/// rounding cannot have hidden: those that the ray meets further inside than `margin`.
double must_meet_before(const Columns& columns, const Probe& probe, double margin) {
    const double side = columns.bits().size.y;
    auto [t, end] = part_in(probe, glm::dvec3(0.0), glm::dvec3(side));
    if (t > end) return 1e300;
    const glm::dvec3 origin(probe.origin_start);
    const glm::dvec3 direction(probe.direction_end);
    // Steps so short that no voxel is crossed between two of them further inside than the margin.
    const double step =
        margin / std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
    glm::i64vec3 before(-1);
    for (; t <= end; t += step) {
        const glm::i64vec3 voxel(glm::floor(origin + t * direction));
        if (voxel == before) continue;
        before = voxel;
        if (!columns.occupied(voxel)) continue;
        const auto [in, out] = part_in(probe, glm::dvec3(voxel) + margin, glm::dvec3(voxel) + 1.0 - margin);
        if (in <= out) return in;
    }
    return 1e300;
}

TEST_F(ColumnRays, AnyRayFindsTheFirstVoxelThatRoundingCannotHide) {
    constexpr double margin = 0x1p-7;
    for (const auto& [side, count, dust] : {std::tuple{32, 20000, 0.05}, {128, 6000, 0.02}}) {
        Dice dice{std::mt19937(5U + unsigned(side))};
        const Columns columns(clutter(side, dust, dice));
        std::vector<Probe> probes;
        for (int i = 0; i < count; ++i)
            probes.push_back(free_probe(side, dice));
        const auto found = columns.trace(probes, ColumnMask::adaptive);
        const auto other = columns.trace(probes, ColumnMask::mip_level);
        for (std::size_t i = 0; i < probes.size(); ++i)
            ASSERT_EQ(glm::ivec3(other[i].voxel_skipped), glm::ivec3(found[i].voxel_skipped))
                << "mip level, ray " << i << " " << text_of(probes[i]);
        int hits = 0;
        int wrong = 0;
        for (std::size_t i = 0; i < probes.size() && wrong < 5; ++i) {
            const glm::i64vec3 voxel(glm::ivec3(found[i].voxel_skipped));
            const double must = must_meet_before(columns, probes[i], margin);
            double entered = 1e300;
            bool right = voxel.x < 0;
            if (voxel.x >= 0) {
                ++hits;
                const auto [in, out] =
                    part_in(probes[i], glm::dvec3(voxel) - margin, glm::dvec3(voxel) + 1.0 + margin);
                entered = in;
                right = in <= out && columns.occupied(voxel);
            }
            if (right && entered <= must) continue;
            ++wrong;
            ADD_FAILURE() << "side " << side << ", ray " << i << " " << text_of(probes[i]) << ": "
                          << text_of(voxel) << " at " << entered << ", must meet one at " << must;
        }
        EXPECT_GT(hits, count / 5) << side;
        EXPECT_LT(hits, count * 19 / 20) << side;
    }
}

TEST_F(ColumnRays, AdaptiveMasksTakeFewerTurns) {
    // Figure 10 of Forest et al.: a node that a cube's mask would refine need not be.
    Dice dice{std::mt19937(3)};
    const Columns columns(clutter(128, 0.003, dice));
    std::vector<Probe> probes;
    for (int i = 0; i < 20000; ++i)
        probes.push_back(free_probe(128, dice));
    std::array<double, masks.size()> turns{};
    for (std::size_t m = 0; m < masks.size(); ++m) {
        for (const Probe& probe : columns.trace(probes, masks[m]))
            turns[m] += probe.found.y;
    }
    RecordProperty("turns_a_ray", fmt::format("{:.1f}, {:.1f}", turns[0] / 20000.0, turns[1] / 20000.0));
    EXPECT_LT(turns[1], 0.7 * turns[0]) << "adaptive, mip level";
}

/// A full grid with a tunnel along a ray, no wider than rounding requires.
BitGrid tunnel(int side, const glm::dvec3& origin, const glm::dvec3& direction) {
    constexpr double step = 0x1p-6;
    BitGrid bits((glm::ivec3(side)));
    std::fill(bits.words.begin(), bits.words.end(), 0xFFFFFFFFU);
    for (double t = 0.0; t < 2.0 * side; t += step) {
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 shift(corner & 1 ? step : -step, corner & 2 ? step : -step,
                                   corner & 4 ? step : -step);
            const glm::ivec3 v(glm::floor(origin + t * direction + shift));
            if (glm::any(glm::lessThan(v, glm::ivec3(0))) ||
                glm::any(glm::greaterThanEqual(v, glm::ivec3(side))))
                continue;
            bits.words[bits.word_index(v.x, v.y, v.z)] &= ~(1U << (v.x % 32));
        }
    }
    return bits;
}

TEST_F(ColumnRays, TurnTheirLoopsSeldomEnoughThatNoDriverEndsThem) {
    // COLUMN_MOST_LEVELS depends on this limit: in a tunnel every node that a ray crosses is refined.
    constexpr int side = 256;
    for (const glm::dvec3 direction : {glm::dvec3(1.0, 0.97, 0.93), glm::dvec3(0.03, 1.0, 0.99),
                                       glm::dvec3(1.0, 0.02, 0.01), glm::dvec3(0.5, 1.0, 0.25)}) {
        const glm::dvec3 origin(0.51, 0.37, 0.43);
        const Columns columns(tunnel(side, origin, direction));
        Probe probe;
        probe.origin_start = glm::vec4(origin, 0.0F);
        probe.direction_end = glm::vec4(direction, 1e30F);
        for (std::size_t m = 0; m < masks.size(); ++m) {
            const Probe found = columns.trace({probe}, masks[m])[0];
            EXPECT_EQ(found.voxel_skipped.x, -1) << mask_names[m] << " " << text_of(probe);
            EXPECT_GT(found.found.y, 20.0F) << mask_names[m] << " " << text_of(probe);
            EXPECT_LT(found.found.y, float(12 * side)) << mask_names[m] << " " << text_of(probe);
            RecordProperty(fmt::format("turns_{}_{}", m, direction.x), int(found.found.y));
        }
    }
}

TEST_F(ColumnRays, OtherResolutionsAreRefused) {
    for (const int resolution : {0, 4, 48, 4096, -8})
        EXPECT_THROW(ColumnPyramid{resolution}, Error) << resolution;
}

}  // namespace
}  // namespace cairn::test
