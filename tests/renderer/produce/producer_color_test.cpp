// Colours, normals and coverage of produced bricks, on sheets where they can be predicted by hand.
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "shaders/interop/surface.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/produced_brick.h"
#include "voxelizer/surface/surface_attributes.h"

namespace cairn::renderer {
namespace {

using namespace cairn::test;

const glm::vec3 red(1.0F, 0.0F, 0.0F);
const glm::vec3 blue(0.0F, 0.0F, 1.0F);

/// Sheets parallel to the floor in a grid of 8^3 voxels, which is the root's brick. Lengths are in voxels.
class Sheets {
public:
    Sheets() {
        surface_.grid = unit_grid(8);
        surface_.has_color = true;
        surface_.chunks.emplace_back();
    }

    /// Two triangles that look up, over x0 to x1 and z0 to z1, in a material of their own.
    void add(double y, double x0, double x1, double z0, double z1, const glm::vec3& color) {
        surface_.materials.emplace_back().base_color = glm::vec4(color, 1.0F);
        const std::uint32_t a = vertex(x0, y, z0);
        const std::uint32_t b = vertex(x0, y, z1);
        const std::uint32_t c = vertex(x1, y, z1);
        const std::uint32_t d = vertex(x1, y, z0);
        add_triangle(a, b, c);
        add_triangle(a, c, d);
    }
    /// A degenerate triangle, as a glTF line is.
    void add_segment(const glm::dvec3& from, const glm::dvec3& to, const glm::vec3& color) {
        surface_.materials.emplace_back().base_color = glm::vec4(color, 1.0F);
        const std::uint32_t b = vertex(to.x, to.y, to.z);
        add_triangle(vertex(from.x, from.y, from.z), b, b);
    }
    /// Gives the last material a picture of `width` by 1 texels.
    void set_texture(const std::vector<glm::u8vec4>& texels, unsigned flags) {
        interop::SurfaceMaterial& material = surface_.materials.back();
        material.texel_offset = std::uint32_t(surface_.texels.size());
        material.width = std::uint32_t(texels.size());
        material.height = 1;
        material.flags = flags;
        material.alpha_cutoff = 0.5F;
        for (const glm::u8vec4& t : texels) {
            surface_.texels.push_back(std::uint32_t(t.r) | std::uint32_t(t.g) << 8U |
                                      std::uint32_t(t.b) << 16U | std::uint32_t(t.a) << 24U);
        }
    }
    /// fill(attributes, x) for every vertex, x in voxels.
    template <typename Fill>
    void set_attributes(const Fill& fill) {
        voxelizer::SurfaceChunk& chunk = surface_.chunks[0];
        for (std::size_t v = 0; v < chunk.positions.size(); ++v)
            fill(chunk.attributes[v], double(chunk.positions[v][0]) / double(1 << 21));
    }

    [[nodiscard]] ProducedBrick brick() {
        surface_.triangle_count = surface_.chunks[0].triangles.size();
        BrickMaker maker(make_tree_shape(2, 8, 64), surface_, 1);
        return maker.produce_one({});
    }
    voxelizer::Surface& surface() { return surface_; }

private:
    std::uint32_t vertex(double x, double y, double z) {
        voxelizer::SurfaceChunk& chunk = surface_.chunks[0];
        const double voxel = double(1 << 21);
        chunk.positions.push_back({int(x * voxel), int(y * voxel), int(z * voxel)});
        chunk.attributes.push_back(voxelizer::surface_attributes(0, glm::u16vec4(65535), glm::vec2(0.0F)));
        return std::uint32_t(chunk.positions.size()) - 1;
    }
    void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        surface_.chunks[0].triangles.push_back({{a, b, c}, std::uint32_t(surface_.materials.size()) - 1});
    }

    voxelizer::Surface surface_;
};

/// The texel of a linear colour and a coverage; `tolerance` in steps of 1/255.
void expect_color(const ProducedBrick& brick, const glm::ivec3& place, const glm::dvec3& linear,
                  double coverage, double tolerance) {
    const glm::ivec4 texel = brick.color_at(place);
    const auto where = fmt::format("voxel ({} {} {}): {} {} {} {}", place.x, place.y, place.z, texel.r,
                                   texel.g, texel.b, texel.a);
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(texel[channel], std::sqrt(linear[channel]) * coverage * 255.0, tolerance)
            << "channel " << channel << ", " << where;
    EXPECT_NEAR(texel.a, coverage * 255.0, 1.0) << where;
}

class ProducedColor : public GlTest {};

TEST_F(ProducedColor, VoxelHalfRedAndHalfBlueIsTheirMean) {
    Sheets sheets;
    sheets.add(4.6, 0.0, 3.5, 0.0, 8.0, red);
    sheets.add(4.6, 3.5, 8.0, 0.0, 8.0, blue);
    const ProducedBrick brick = sheets.brick();
    expect_color(brick, {1, 4, 4}, red, 1.0, 1.0);
    expect_color(brick, {3, 4, 4}, {0.5, 0.0, 0.5}, 1.0, 2.0);
    expect_color(brick, {6, 4, 4}, blue, 1.0, 1.0);
    EXPECT_EQ(brick.color_at({3, 3, 4}), glm::ivec4(0)) << "under the sheet";
}

TEST_F(ProducedColor, MeanIsWeightedByTheFinerVoxelsThatEachCovers) {
    Sheets sheets;
    sheets.add(4.6, 0.0, 3.625, 0.0, 8.0, red);   // three of four columns
    sheets.add(4.6, 3.625, 8.0, 0.0, 8.0, blue);  // two: they share the one in which they meet
    expect_color(sheets.brick(), {3, 4, 4}, {0.6, 0.0, 0.4}, 1.0, 2.0);
}

TEST_F(ProducedColor, SheetsAboveEachOtherInAVoxelMix) {
    Sheets sheets;
    sheets.add(4.1, 0.0, 8.0, 0.0, 8.0, red);
    sheets.add(4.9, 0.0, 8.0, 0.0, 8.0, blue);
    expect_color(sheets.brick(), {5, 4, 2}, {0.5, 0.0, 0.5}, 1.0, 2.0);
}

TEST_F(ProducedColor, SumsOfManyTrianglesInAVoxelDoNotOverflow) {
    Sheets sheets;
    sheets.add(4.5, 3.0, 4.0, 4.0, 5.0, red);
    sheets.add(4.5, 3.0, 4.0, 4.0, 5.0, blue);
    std::vector<interop::SurfaceTriangle>& triangles = sheets.surface().chunks[0].triangles;
    const std::vector<interop::SurfaceTriangle> pair = triangles;
    for (int i = 0; i < 60000; ++i)
        triangles.insert(triangles.end(), pair.begin(), pair.end());
    const ProducedBrick brick = sheets.brick();
    expect_color(brick, {3, 4, 4}, {0.5, 0.0, 0.5}, 1.0, 3.0);
    EXPECT_NEAR(brick.normal_at({3, 4, 4}).y, 1.0, 0.01);
}

TEST_F(ProducedColor, TexelsComeThroughInEveryWrapMode) {
    const std::vector<glm::u8vec4> texels = {
        {188, 188, 188, 255}, {255, 0, 0, 255}, {0, 137, 255, 255}, {64, 128, 10, 255}};
    auto linear = [](int srgb) {
        const double c = srgb / 255.0;
        return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    };
    for (const unsigned mode : {0U, 1U, 2U}) {
        SCOPED_TRACE(fmt::format("wrap mode {}", mode));
        Sheets sheets;
        sheets.add(4.6, 0.0, 8.0, 0.0, 8.0, {1.0F, 1.0F, 0.5F});
        sheets.set_texture(texels, mode << MATERIAL_WRAP_S_SHIFT);
        // A voxel is a texel wide, and the picture begins in the middle.
        sheets.set_attributes([](interop::SurfaceAttributes& attributes, double x) {
            attributes.u = float(x / 4.0 - 1.0);
            attributes.v = 0.5F;
        });
        const ProducedBrick brick = sheets.brick();
        for (int x = 0; x < 8; ++x) {
            const int i = x - 4;
            const int texel = mode == 0 ? (i + 4) % 4 : mode == 1 ? (i < 0 ? -1 - i : i) : std::max(i, 0);
            const glm::u8vec4& t = texels[std::size_t(texel)];
            expect_color(brick, {x, 4, x < 4 ? 6 : 1}, {linear(t.r), linear(t.g), 0.5 * linear(t.b)}, 1.0,
                         2.0);
        }
    }
}

TEST_F(ProducedColor, VertexColoursAreInterpolated) {
    Sheets sheets;
    sheets.add(4.6, 0.0, 8.0, 0.0, 8.0, {1.0F, 0.5F, 0.0F});
    sheets.set_attributes([](interop::SurfaceAttributes& attributes, double x) {
        attributes.red_green = x > 4.0 ? 0xFFFFFFFFU : 0xFFFF0000U;  // red from 0 to 1
        attributes.blue_alpha = x > 4.0 ? 0xFFFFFFFFU : 0xFFFF0000U;
    });
    const ProducedBrick brick = sheets.brick();
    for (int x = 0; x < 8; ++x)
        expect_color(brick, {x, 4, x < 4 ? 6 : 1}, {(x + 0.5) / 8.0, 0.5, 0.0}, 1.0, 3.0);
}

TEST_F(ProducedColor, CoverageIsTheShareOfTheFaceThatTheSurfaceHides) {
    Sheets sheets;
    sheets.add(4.6, 0.0, 3.375, 0.0, 8.0, red);  // ends within the second of four columns
    sheets.add_segment({0.0, 1.1, 5.6}, {8.0, 1.1, 5.6}, blue);
    const ProducedBrick brick = sheets.brick();
    expect_color(brick, {2, 4, 4}, red, 1.0, 1.0);
    expect_color(brick, {3, 4, 4}, red, 0.5, 1.0);
    expect_color(brick, {4, 4, 4}, glm::dvec3(0.0), 0.0, 0.0);
    expect_color(brick, {6, 1, 5}, blue, 0.25, 1.0);  // a wire: one of four rows
}

TEST_F(ProducedColor, NormalsAreTheTrianglesOwnUnlessVerticesHaveTheirs) {
    Sheets sheets;
    sheets.add(2.6, 0.0, 8.0, 0.0, 8.0, red);
    EXPECT_LT(glm::distance(sheets.brick().normal_at({3, 2, 4}), glm::vec3(0.0F, 1.0F, 0.0F)), 0.01F);
    sheets.set_attributes([](interop::SurfaceAttributes& attributes, double) {
        attributes.normal = 32767;  // (1, 0) on the octahedral map: along x
    });
    EXPECT_LT(glm::distance(sheets.brick().normal_at({3, 2, 4}), glm::vec3(1.0F, 0.0F, 0.0F)), 0.01F);
    EXPECT_LT(glm::length(sheets.brick().normal_at({3, 5, 4})), 0.01F) << "an empty voxel has no normal";
}

TEST_F(ProducedColor, TwoFacesInAVoxelKeepTheirNormals) {
    constexpr std::uint32_t along_x = 32767;
    constexpr std::uint32_t along_y = 32767U << 16U;
    constexpr std::uint32_t against_y = 32769U << 16U;  // -32767
    for (const auto& [other, normal] :
         {std::pair{along_x, glm::vec3(1, 0, 0)}, {against_y, glm::vec3(0, -1, 0)}}) {
        Sheets sheets;
        sheets.add(4.6, 3.05, 3.7, 4.05, 4.95, red);
        sheets.add(4.6, 3.8, 3.95, 4.05, 4.95, red);
        sheets.set_attributes([&, other = other](interop::SurfaceAttributes& attributes, double x) {
            attributes.normal = x < 3.75 ? along_y : other;
        });
        const ProducedBrick brick = sheets.brick();
        const glm::ivec3 voxel(3, 4, 4);
        EXPECT_LT(glm::distance(brick.normal_at(voxel), glm::vec3(0, 1, 0)), 0.02F);
        EXPECT_LT(glm::distance(brick.second_normal_at(voxel), normal), 0.08F);
        EXPECT_NEAR(brick.second_share_at(voxel), 0.25F, 0.1F);  // one column of finer voxels against three
    }
}

TEST_F(ProducedColor, NormalsThatHardlyDifferAreOne) {
    Sheets sheets;
    sheets.add(4.6, 0.0, 8.0, 0.0, 8.0, red);
    const ProducedBrick brick = sheets.brick();
    EXPECT_EQ(brick.second_share_at({3, 4, 4}), 0.0F);
    EXPECT_LT(glm::distance(brick.normal_at({3, 4, 4}), glm::vec3(0.0F, 1.0F, 0.0F)), 0.005F);
}

TEST_F(ProducedColor, AlphaMaskCutsSurfaceAway) {
    Sheets sheets;
    sheets.add(4.6, 0.0, 8.0, 0.0, 8.0, red);
    sheets.set_texture({{255, 255, 255, 255}, {255, 255, 255, 100}},
                       1U << MATERIAL_MASK_BIT | 2U << MATERIAL_WRAP_S_SHIFT);
    sheets.surface().has_mask = true;
    sheets.set_attributes([](interop::SurfaceAttributes& attributes, double x) {
        attributes.u = float(x / 7.0);  // the picture's second half begins at x = 3.5
        attributes.v = 0.5F;
    });
    const ProducedBrick brick = sheets.brick();
    expect_color(brick, {2, 4, 4}, red, 1.0, 1.0);
    expect_color(brick, {3, 4, 4}, red, 0.5, 1.0);
    for (int x = 4; x < 8; ++x) {
        EXPECT_FALSE(brick.occupied({x, 4, 4})) << "x = " << x;
        expect_color(brick, {x, 4, 4}, glm::dvec3(0.0), 0.0, 0.0);
    }
}

}  // namespace
}  // namespace cairn::renderer
