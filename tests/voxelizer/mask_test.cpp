// Alpha masks: the shader against the definition (voxelizer/surface/exact_mask.h), and the definition against
// samples.
#include <gtest/gtest.h>

#include "shaders/interop/surface.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/masked_scene.h"
#include "tests/support/voxelizer_fixture.h"
#include "voxelizer/methods/conservative_voxelizer.h"
#include "voxelizer/surface/exact_mask.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;

class MaskTest : public ConservativeTest {
protected:
    BitGrid voxelize(const Surface& surface) {
        return voxelizer().voxelize(upload(surface), whole(surface.grid));
    }
    void expect_exact(const MaskedScene& scene, int resolution, const std::string& what) {
        const Surface surface = scene.surface(resolution);
        EXPECT_TRUE(same_bits(voxelize(surface), reference::exact_voxels(surface, whole(surface.grid))))
            << what << ", resolution " << resolution;
    }
};

glm::vec3 random_corner(Random& random, bool on_planes) {
    const auto coordinate = [&] {
        return on_planes ? float(random.between(0, 8)) / 8.0F : float(random.unit());
    };
    const float x = coordinate();
    const float y = coordinate();
    return {x, y, coordinate()};
}

TEST_F(MaskTest, AllWrapModesAreExact) {
    Random random(31);
    for (const scenes::Wrap s :
         {scenes::Wrap::repeat, scenes::Wrap::mirrored_repeat, scenes::Wrap::clamp_to_edge}) {
        for (const scenes::Wrap t :
             {scenes::Wrap::repeat, scenes::Wrap::mirrored_repeat, scenes::Wrap::clamp_to_edge}) {
            std::vector<std::uint8_t> alphas;
            for (int i = 0; i < 5 * 3; ++i)
                alphas.push_back(random.between(0, 3) == 0 ? 200 : 20);
            MaskedScene scene(5, 3, alphas, s, t);
            for (int i = 0; i < 12; ++i) {
                const bool snapped = i % 3 == 0;
                const auto uv = [&] {
                    const auto one = [&] {
                        return snapped ? float(random.between(-10, 10)) / 5.0F
                                       : float(random.unit() * 5.0 - 2.5);
                    };
                    const float u = one();
                    return glm::vec2(u, one());
                };
                scene.add({random_corner(random, snapped), random_corner(random, snapped),
                           random_corner(random, snapped)},
                          {uv(), uv(), uv()});
            }
            expect_exact(scene, 8, fmt::format("wrap {} {}", int(s), int(t)));
            expect_exact(scene, 33, fmt::format("wrap {} {}", int(s), int(t)));
        }
    }
}

TEST_F(MaskTest, TexelsMuchFinerThanVoxelsAreExact) {
    Random random(32);
    std::vector<std::uint8_t> alphas(64 * 48, 0);
    for (int i = 0; i < 40; ++i)
        alphas[std::size_t(random.between(0, 64 * 48 - 1))] = 255;
    MaskedScene scene(64, 48, alphas, scenes::Wrap::repeat, scenes::Wrap::mirrored_repeat);
    for (int i = 0; i < 20; ++i) {
        const auto uv = [&] { return glm::vec2(random.unit() * 4.0 - 2.0, random.unit() * 4.0 - 2.0); };
        scene.add({random_corner(random, false), random_corner(random, false), random_corner(random, false)},
                  {uv(), uv(), uv()});
    }
    expect_exact(scene, 4, "fine texels");
    expect_exact(scene, 12, "fine texels");
}

TEST_F(MaskTest, DegenerateTrianglesAndTexcoordsAreExact) {
    MaskedScene scene(2, 2, {255, 0, 0, 255}, scenes::Wrap::repeat, scenes::Wrap::repeat);
    const glm::vec3 a(0.1F, 0.2F, 0.3F);
    const glm::vec3 b(0.9F, 0.7F, 0.4F);
    const glm::vec3 c(0.3F, 0.9F, 0.8F);
    scene.add({a, b, b}, {glm::vec2(0.1F, 0.2F), glm::vec2(3.2F, 0.9F), glm::vec2(3.2F, 0.9F)});  // a segment
    scene.add({a, b, b}, {glm::vec2(0.1F, 0.2F), glm::vec2(1.2F, 0.9F), glm::vec2(-2.0F, 4.0F)});
    scene.add({c, c, c}, {glm::vec2(0.6F, 0.2F), glm::vec2(0.6F, 0.2F), glm::vec2(0.6F, 0.2F)});  // on a hole
    scene.add({a, b, c}, {glm::vec2(0.25F), glm::vec2(0.25F), glm::vec2(0.25F)});                 // one texel
    scene.add({a, c, b},
              {glm::vec2(0.5F, 0.0F), glm::vec2(0.5F, 1.0F), glm::vec2(0.5F, 7.0F)});  // along a texel's side
    expect_exact(scene, 8, "degenerate");
    expect_exact(scene, 32, "degenerate");
}

TEST_F(MaskTest, VertexAlphasAreExact) {
    Random random(33);
    MaskedScene scene(3, 3, {255, 0, 128, 60, 255, 0, 0, 200, 255}, scenes::Wrap::repeat,
                      scenes::Wrap::clamp_to_edge);
    for (int i = 0; i < 8; ++i) {
        scene.add({random_corner(random, false), random_corner(random, false), random_corner(random, false)},
                  {glm::vec2(0.0F), glm::vec2(1.7F, 0.3F), glm::vec2(0.2F, 1.6F)});
        for (int corner = 0; corner < 3; ++corner) {
            scene.primitive.colors.push_back(
                {65535, 65535, 65535, i < 2 ? 180 * 257 : int(random.between(0, 65535))});
        }
    }
    expect_exact(scene, 16, "vertex alpha");
}

TEST_F(MaskTest, VertexAlphasWithoutTextureAreExact) {
    MaskedScene scene(1, 1, {255}, scenes::Wrap::repeat, scenes::Wrap::repeat);
    scene.scene.materials[0].texture = -1;
    scene.add({glm::vec3(0.1F, 0.1F, 0.5F), glm::vec3(0.9F, 0.1F, 0.5F), glm::vec3(0.1F, 0.9F, 0.5F)}, {});
    scene.primitive.colors = {
        {65535, 65535, 65535, 65535}, {65535, 65535, 65535, 0}, {65535, 65535, 65535, 0}};
    expect_exact(scene, 16, "vertex alpha alone");
    const BitGrid bits = voxelize(scene.surface(16));
    EXPECT_TRUE(bits.at({2, 2, 8}));
    EXPECT_FALSE(bits.at({13, 2, 8}));
}

/// The quad x, y in [0, 1] at z = 0.55, texture upright on it.
void add_sheet(MaskedScene& scene, float repeats = 1.0F) {
    const glm::vec3 a(0.0F, 0.0F, 0.55F);
    const glm::vec3 b(1.0F, 0.0F, 0.55F);
    const glm::vec3 c(1.0F, 1.0F, 0.55F);
    const glm::vec3 d(0.0F, 1.0F, 0.55F);
    scene.add({a, b, c}, {glm::vec2(0.0F), glm::vec2(repeats, 0.0F), glm::vec2(repeats)});
    scene.add({a, c, d}, {glm::vec2(0.0F), glm::vec2(repeats), glm::vec2(0.0F, repeats)});
}

TEST_F(MaskTest, HolesAreHolesAndTheirEdgesAreClosed) {
    // 4 x 4 texels over 16 x 16 voxels: texel (1, 2) alone is there.
    std::vector<std::uint8_t> alphas(16, 0);
    alphas[2 * 4 + 1] = 255;
    MaskedScene scene(4, 4, alphas, scenes::Wrap::repeat, scenes::Wrap::repeat);
    add_sheet(scene);
    const BitGrid bits = voxelize(scene.surface(16));
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) {
            const bool expected =
                x >= 3 && x <= 8 && y >= 7 && y <= 12;  // its 4 x 4 voxels and those that touch them
            EXPECT_EQ(bits.at({x, y, 8}), expected) << x << ", " << y;
        }
    }
    EXPECT_EQ(bits.count(), 36U);
}

TEST_F(MaskTest, TheCutoffItselfPasses) {
    for (const int alpha : {127, 128, 51, 50}) {
        MaskedScene scene(1, 2, {std::uint8_t(alpha), 0}, scenes::Wrap::repeat, scenes::Wrap::repeat);
        scene.scene.materials[0].alpha_cutoff = alpha > 100 ? 128.0F / 255.0F : 0.2F;
        add_sheet(scene);
        EXPECT_EQ(voxelize(scene.surface(8)).count() > 0, alpha == 128 || alpha == 51) << alpha;
    }
}

TEST_F(MaskTest, BaseColourAlphaCounts) {
    MaskedScene scene(1, 2, {255, 0}, scenes::Wrap::repeat, scenes::Wrap::repeat);
    add_sheet(scene);
    scene.scene.materials[0].base_color.a = 0.49F;
    EXPECT_EQ(scene.surface(8).triangle_count, 0U) << "no texel can pass";
    scene.scene.materials[0].base_color.a = 0.51F;
    EXPECT_TRUE(scene.surface(8).has_mask);
    scene.scene.materials[0].alpha_cutoff = 0.0F;
    EXPECT_FALSE(scene.surface(8).has_mask) << "every texel passes";
}

TEST_F(MaskTest, TexturesRepeatedWithoutEndAreExact) {
    MaskedScene scene(16, 16, std::vector<std::uint8_t>(256, 0), scenes::Wrap::repeat,
                      scenes::Wrap::clamp_to_edge);
    scene.scene.images[0].rgba[4 * (5 * 16 + 7) + 3] = 255;
    scene.scene.images[0].rgba[4 * (15 * 16 + 2) + 3] = 255;
    add_sheet(scene, 300.0F);
    const Surface surface = scene.surface(2);
    // There are too many texels to test one by one by the definition, so that halves of the finer grid are
    // compared.
    const BitGrid coarse = voxelize(surface);
    const BitGrid fine = voxelize(scene.surface(64));
    EXPECT_TRUE(same_bits(coarse, build_pyramid(fine).level(5)));
}

TEST_F(MaskTest, LargeTrianglesAndManyCandidatesAreExact) {
    std::vector<std::uint8_t> alphas(8 * 8);
    for (std::size_t i = 0; i < alphas.size(); ++i)
        alphas[i] = (i / 8 + i) % 2 == 0 ? 255 : 0;
    MaskedScene scene(8, 8, alphas, scenes::Wrap::repeat, scenes::Wrap::repeat);
    add_sheet(scene, 3.0F);
    expect_exact(scene, 100, "a large sheet");
}

TEST_F(MaskTest, EachLevelIsTheOrOfTheFinerOne) {
    Random random(34);
    MaskedScene scene(4, 4, {255, 0, 0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 255, 0, 0, 0},
                      scenes::Wrap::mirrored_repeat, scenes::Wrap::repeat);
    for (int i = 0; i < 20; ++i) {
        scene.add(
            {random_corner(random, i % 2 == 0), random_corner(random, false), random_corner(random, false)},
            {glm::vec2(random.unit() * 9.0, 0.3F), glm::vec2(1.1F, random.unit() * 9.0), glm::vec2(0.0F)});
    }
    const BitmaskPyramid pyramid = build_pyramid(voxelize(scene.surface(64)));
    for (int level = 1; level < 5; ++level) {
        EXPECT_TRUE(same_bits(pyramid.level(level), voxelize(scene.surface(64 >> level))))
            << "level " << level;
    }
}

TEST(ExactMask, CountsEveryPointOfATexelThatPasses) {
    Random random(35);
    std::vector<std::uint32_t> texels(6 * 4, 0x00FFFFFFU);
    for (int i = 0; i < 8; ++i)
        texels[std::size_t(random.between(0, 23))] = 0xFFFFFFFFU;
    interop::SurfaceMaterial material{};
    material.width = 6;
    material.height = 4;
    material.alpha_threshold = 128 * 255 * 256;
    int passed = 0;
    for (int i = 0; i < 4000; ++i) {
        const std::array<glm::i64vec3, 3> positions = {random.point(0, 4096), random.point(0, 4096),
                                                       random.point(0, 4096)};
        std::array<glm::vec2, 3> texcoords;
        for (glm::vec2& t : texcoords)
            t = {float(random.between(0, 1023)) / 1024, float(random.between(0, 1023)) / 1024};
        const ExactMask mask(positions, texcoords, {65535, 65535, 65535}, material, texels);
        const std::int64_t a = random.between(0, 64);
        const std::int64_t b = random.between(0, 64 - a);
        const std::array<std::int64_t, 3> weights = {a, b, 64 - a - b};
        glm::i64vec3 point(0);  // 64 times the point
        glm::dvec2 at(0.0);
        for (std::size_t k = 0; k < 3; ++k) {
            point += weights[k] * positions[k];
            at += double(weights[k]) / 64.0 * glm::dvec2(texcoords[k]) * glm::dvec2(6, 4);
        }
        const bool passes = texels[std::size_t(at.y) * 6 + std::size_t(at.x)] >> 24 == 255;
        passed += passes ? 1 : 0;
        const glm::i64vec3 voxel = point / std::int64_t(64 * 256);
        if (passes) {
            ASSERT_TRUE(mask.touches(voxel * std::int64_t(256), 256)) << i;
        }
    }
    EXPECT_GT(passed, 500);
}

}  // namespace
}  // namespace cairn::voxelizer
