// Mip levels of textures against means that can be computed by hand.
#include "voxelizer/surface/texture_mips.h"

#include <gtest/gtest.h>

#include "optics/srgb.h"

namespace cairn::voxelizer {
namespace {

constexpr std::uint32_t texel(std::uint32_t r, std::uint32_t g, std::uint32_t b, std::uint32_t a = 255) {
    return r | g << 8U | b << 16U | a << 24U;
}
constexpr std::uint32_t black = texel(0, 0, 0);
constexpr std::uint32_t white = texel(255, 255, 255);

/// The code of a share of full light.
std::uint32_t code(double linear) {
    return optics::srgb8_from_linear(linear);
}

TEST(TextureMips, MeansAreTakenInLinearLight) {
    const std::vector<std::uint32_t> checks = {white, black, black, white};
    const std::uint32_t half = code(0.5);
    EXPECT_EQ(mips_of(checks, {2, 2}, 0), std::vector<std::uint32_t>{texel(half, half, half)});
    EXPECT_EQ(half, 188U) << "and not 128, the mean of the codes";
}

TEST(TextureMips, OneColourStaysThatColourAtEveryLevel) {
    for (const std::uint32_t color : {texel(1, 2, 3), texel(200, 100, 7), white, black}) {
        const std::vector<std::uint32_t> image(13UL * 6UL, color);
        const std::vector<std::uint32_t> mips = mips_of(image, {13, 6}, 0);
        ASSERT_EQ(mips.size(), mip_texels({13, 6}));
        EXPECT_EQ(mips.size(), 6U * 3U + 3U * 1U + 1U);
        for (const std::uint32_t mip : mips)
            EXPECT_EQ(mip, color);
    }
}

TEST(TextureMips, OddSizesCountPartsOfTexels) {
    // Five columns under two: 1 + 1 + 1/2 of 2.5.
    const std::vector<std::uint32_t> row = {white, black, white, black, black};
    const std::vector<std::uint32_t> mips = mips_of(row, {5, 1}, 0);
    ASSERT_EQ(mips.size(), 3U);
    EXPECT_EQ(mips[0] & 255U, code(1.5 / 2.5));
    EXPECT_EQ(mips[1] & 255U, code(0.5 / 2.5));
    EXPECT_EQ(mips[2] & 255U, code(2.0 / 5.0));
    const std::vector<std::uint32_t> three = {white, black, black};
    EXPECT_EQ(mips_of(three, {1, 3}, 0).back() & 255U, code(1.0 / 3.0));
}

TEST(TextureMips, ATextureOfOneTexelHasNone) {
    EXPECT_EQ(mip_texels({1, 1}), 0U);
    EXPECT_TRUE(mips_of(std::vector<std::uint32_t>{white}, {1, 1}, 0).empty());
}

TEST(TextureMips, WhatAMaskHidesIsInNoMean) {
    const std::uint32_t green = texel(0, 200, 0, 128);
    const std::uint32_t magenta = texel(255, 0, 255, 127);
    std::vector<std::uint32_t> image(8UL * 8UL, magenta);
    image[0] = green;          // one of 64
    image[8 * 4 + 5] = green;  // and another one, in another quarter
    const std::vector<std::uint32_t> mips = mips_of(image, {8, 8}, 128);
    ASSERT_EQ(mips.size(), 16U + 4U + 1U);
    for (const std::uint32_t mip : mips) {
        const std::uint32_t alpha = mip >> 24U;
        EXPECT_EQ(mip & 0xFFFFFFU, alpha > 0 ? green & 0xFFFFFFU : 0U);
    }
    EXPECT_EQ(mips[0] >> 24U, 64U) << "a quarter of the first texel is kept";
    EXPECT_EQ(mips[1] >> 24U, 0U);
    EXPECT_EQ(mips.back() >> 24U, 8U) << "2 of 64";
    image.assign(image.size(), green);
    EXPECT_EQ(mips_of(image, {8, 8}, 128).back() >> 24U, 255U);
}

TEST(TextureMips, TheLeastThatIsKeptDoesNotRoundToNothing) {
    std::vector<std::uint32_t> image(64UL * 64UL, texel(255, 0, 255, 0));
    image[100] = texel(10, 20, 30, 255);
    const std::uint32_t last = mips_of(image, {64, 64}, 1).back();
    EXPECT_EQ(last, texel(10, 20, 30, 1));
}

TEST(TextureMips, FilledLevelsHaveNoHiddenColourButTheImagesAlphas) {
    const std::uint32_t green = texel(0, 200, 0, 255);
    const std::uint32_t magenta = texel(255, 0, 255, 17);
    std::vector<std::uint32_t> image(6UL * 5UL, magenta);
    image[6 * 4 + 5] = green;
    const std::vector<std::uint32_t> levels = filled_levels(image, {6, 5}, 128);
    ASSERT_EQ(levels.size(), image.size() + mip_texels({6, 5}));
    for (std::size_t i = 0; i < levels.size(); ++i) {
        EXPECT_EQ(levels[i] & 0xFFFFFFU, green & 0xFFFFFFU) << "texel " << i;
        if (i < image.size()) {
            EXPECT_EQ(levels[i] >> 24U, image[i] >> 24U);
        }
    }
    EXPECT_EQ(filled_levels(image, {6, 5}, 0)[0], magenta) << "without a mask nothing is hidden";
}

}  // namespace
}  // namespace cairn::voxelizer
