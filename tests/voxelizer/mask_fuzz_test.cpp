// Alpha masks against clipping: the part of a triangle inside a voxel is clipped to each texel and to where
// its alpha passes. This shares nothing with the shaders, nor with the definition
// (voxelizer/surface/exact_mask.h). CAIRN_FUZZ_TRIALS and CAIRN_FUZZ_SEED ask for a longer trial.
#include <gtest/gtest.h>

#include "shaders/interop/surface.h"
#include "tests/support/clipped_triangle.h"
#include "tests/support/fuzz.h"
#include "tests/support/masked_scene.h"
#include "tests/support/voxelizer_fixture.h"
#include "voxelizer/surface/wide_integer.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;
using scenes::Wrap;
using Values = ClippedTriangle<Int128>::Values;

constexpr int steps = 4096;  // steps of a coordinate across the unit cube

/// A texture of few texels, and triangles whose numbers are all in whole units.
struct Trial {
    int width, height;
    Wrap wrap_s, wrap_t;
    std::vector<std::uint8_t> alphas;
    int cutoff;  ///< alpha cutoff, in [0, 255]
    int resolution;
    bool has_vertex_alphas;
    struct Triangle {
        std::array<glm::ivec3, 3> corners;  ///< corners, in units of 1 / steps of the cube
        /// Texture coordinates, in units of 1 / TEXEL_UNITS of a texel.
        std::array<glm::ivec2, 3> texcoords;
        std::array<int, 3> alphas;
    };
    std::vector<Triangle> triangles;

    [[nodiscard]] MaskedScene scene() const;
    [[nodiscard]] BitGrid truth() const;

private:
    void mark(const Triangle& triangle, BitGrid& bits) const;
    [[nodiscard]] bool shows(ClippedTriangle<Int128> in_voxel, const Triangle& triangle) const;
};

MaskedScene Trial::scene() const {
    MaskedScene out(width, height, alphas, wrap_s, wrap_t);
    out.scene.materials[0].alpha_cutoff = float(cutoff) / 255.0F;
    for (const Triangle& t : triangles) {
        std::array<glm::vec3, 3> corners;
        std::array<glm::vec2, 3> texcoords;
        for (std::size_t i = 0; i < 3; ++i) {
            corners[i] = glm::vec3(t.corners[i]) / float(steps);
            texcoords[i] =
                glm::vec2(glm::dvec2(t.texcoords[i]) / (glm::dvec2(width, height) * double(TEXEL_UNITS)));
            if (has_vertex_alphas) out.primitive.colors.push_back({65535, 65535, 65535, t.alphas[i]});
        }
        out.add(corners, texcoords);
    }
    return out;
}

int wrapped(int texel, int size, Wrap wrap) {
    if (wrap == Wrap::clamp_to_edge) return std::clamp(texel, 0, size - 1);
    const int textures = int(std::floor(double(texel) / size));
    const int within = texel - textures * size;
    return wrap == Wrap::mirrored_repeat && textures % 2 != 0 ? size - 1 - within : within;
}

bool Trial::shows(ClippedTriangle<Int128> in_voxel, const Triangle& t) const {
    const Values u = {t.texcoords[0].x, t.texcoords[1].x, t.texcoords[2].x};
    const Values v = {t.texcoords[0].y, t.texcoords[1].y, t.texcoords[2].y};
    const auto texels = [](const Values& values) {
        const auto [low, high] = std::minmax({values[0], values[1], values[2]});
        return std::pair(int(std::floor(double(low) / TEXEL_UNITS)) - 1,
                         int(std::floor(double(high) / TEXEL_UNITS)));
    };
    for (int row = texels(v).first; row <= texels(v).second; ++row) {
        ClippedTriangle<Int128> in_row = in_voxel;
        in_row.keep_at_least(v, row * TEXEL_UNITS);
        in_row.keep_at_most(v, (row + 1) * TEXEL_UNITS);
        for (int column = texels(u).first; column <= texels(u).second && !in_row.empty(); ++column) {
            const std::int64_t alpha =
                alphas[std::size_t(wrapped(row, height, wrap_t) * width + wrapped(column, width, wrap_s))];
            ClippedTriangle<Int128> in_texel = in_row;
            in_texel.keep_at_least(u, column * TEXEL_UNITS);
            in_texel.keep_at_most(u, (column + 1) * TEXEL_UNITS);
            in_texel.keep_at_least({alpha * t.alphas[0], alpha * t.alphas[1], alpha * t.alphas[2]},
                                   cutoff * 65535);
            if (!in_texel.empty()) return true;
        }
    }
    return false;
}

void Trial::mark(const Triangle& t, BitGrid& bits) const {
    // In units where a voxel is `steps` wide.
    LatticeTriangle corners;
    for (std::size_t i = 0; i < 3; ++i)
        corners[i] = glm::i64vec3(t.corners[i]) * std::int64_t(resolution);
    for (int z = 0; z < resolution; ++z) {
        for (int y = 0; y < resolution; ++y) {
            for (int x = 0; x < resolution; ++x) {
                const glm::i64vec3 low = glm::i64vec3(x, y, z) * std::int64_t(steps);
                ClippedTriangle<Int128> in_voxel;
                clip_to_box(in_voxel, corners, low, low + std::int64_t(steps));
                if (!in_voxel.empty() && !bits.at({x, y, z}) && shows(in_voxel, t)) bits.set({x, y, z});
            }
        }
    }
}

BitGrid Trial::truth() const {
    BitGrid bits{glm::ivec3(resolution)};
    for (const Triangle& triangle : triangles)
        mark(triangle, bits);
    return bits;
}

Wrap random_wrap(Random& random) {
    constexpr std::array<Wrap, 3> all = {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge};
    return all[std::size_t(random.between(0, 2))];
}

/// Random triangles, half of them in whole voxels and whole texels, where sides and corners meet.
Trial::Triangle random_triangle(Random& random, const Trial& trial) {
    Trial::Triangle t;
    const int voxel = steps / trial.resolution;
    const bool on_planes = steps % trial.resolution == 0 && random.between(0, 1) == 0;
    const bool on_texels = random.between(0, 1) == 0;
    const std::int64_t kind = random.between(0, 9);
    for (std::size_t i = 0; i < 3; ++i) {
        t.corners[i] = on_planes ? glm::ivec3(random.point(0, trial.resolution)) * voxel
                                 : glm::ivec3(random.point(-steps / 8, steps + steps / 8));
        const glm::ivec2 texels = glm::ivec2(glm::i64vec2(random.point(-6, 9)));
        t.texcoords[i] = texels * TEXEL_UNITS;
        if (!on_texels) t.texcoords[i] += glm::ivec2(glm::i64vec2(random.point(-200, 200)));
        t.alphas[i] = trial.has_vertex_alphas ? int(random.between(0, 65535)) : 65535;
    }
    if (kind == 0) t.corners[2] = t.corners[1];
    if (kind == 1) t.corners[1] = t.corners[2] = t.corners[0];
    if (kind == 2) t.texcoords[2] = t.texcoords[1];
    if (kind == 3) t.texcoords[1] = t.texcoords[2] = t.texcoords[0];
    if (kind == 4) t.corners[2] = t.corners[0] + (t.corners[1] - t.corners[0]) / 2;
    if (kind == 5) t.corners[2].x = t.corners[1].x = t.corners[0].x;
    return t;
}

Trial random_trial(Random& random) {
    Trial trial;
    trial.width = int(random.between(1, 6));
    trial.height = int(random.between(1, 6));
    trial.wrap_s = random_wrap(random);
    trial.wrap_t = random_wrap(random);
    trial.cutoff = int(random.between(1, 254));
    const std::int64_t holes = random.between(1, 8);
    for (int i = 0; i < trial.width * trial.height; ++i) {
        // Near the cutoff on both sides, and at it.
        const std::int64_t alpha = random.between(0, 2) == 0 ? trial.cutoff + random.between(-1, 1) : 255;
        trial.alphas.push_back(
            std::uint8_t(random.between(0, 8) < holes ? random.between(0, trial.cutoff - 1) : alpha));
    }
    trial.has_vertex_alphas = random.between(0, 3) == 0;
    constexpr std::array<int, 8> resolutions = {1, 2, 3, 4, 7, 8, 8, 12};
    trial.resolution = resolutions[std::size_t(random.between(0, 7))];
    const std::int64_t count = random.between(1, 3);
    for (std::int64_t i = 0; i < count; ++i)
        trial.triangles.push_back(random_triangle(random, trial));
    return trial;
}

std::string to_string(const Trial& trial) {
    std::string out =
        fmt::format("{} x {} texels, wraps {} {}, cutoff {}, resolution {}, alphas", trial.width,
                    trial.height, int(trial.wrap_s), int(trial.wrap_t), trial.cutoff, trial.resolution);
    for (const std::uint8_t alpha : trial.alphas)
        out += fmt::format(" {}", alpha);
    for (const Trial::Triangle& t : trial.triangles) {
        out += "\ntriangle";
        for (std::size_t i = 0; i < 3; ++i) {
            out += fmt::format(" ({} {} {} at {} {}, alpha {})", t.corners[i].x, t.corners[i].y,
                               t.corners[i].z, t.texcoords[i].x, t.texcoords[i].y, t.alphas[i]);
        }
    }
    return out;
}

using MaskFuzz = ConservativeTest;

TEST_F(MaskFuzz, AnyMaskedTrianglesAreExact) {
    const Fuzz fuzz = fuzz_of(71, 1000);
    Random random(fuzz.seed);
    int cut = 0;
    for (std::int64_t i = 0; i < fuzz.trials; ++i) {
        const Trial trial = random_trial(random);
        const Surface surface = trial.scene().surface(trial.resolution);
        const BitGrid truth = trial.truth();
        const BitGrid bits = voxelizer().voxelize(upload(surface), whole(surface.grid));
        ASSERT_TRUE(same_bits(bits, truth))
            << "seed " << fuzz.seed << ", trial " << i << ": " << to_string(trial);
        ASSERT_TRUE(same_bits(reference::exact_voxels(surface, whole(surface.grid)), truth))
            << "the reference, seed " << fuzz.seed << ", trial " << i << ": " << to_string(trial);
        cut += surface.has_mask && truth.count() > 0 ? 1 : 0;
    }
    EXPECT_GT(cut, fuzz.trials / 2) << "few triangles are cut: the trials say little";
}

}  // namespace
}  // namespace cairn::voxelizer
