#include "optics/srgb.h"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "base/error.h"
#include "optics/image_mean.h"

namespace cairn::optics {
namespace {

// Values whose root can be taken by hand: (1/2)^2.4 becomes 1/2.
TEST(Srgb, IsTheClosedFormInBothPieces) {
    EXPECT_EQ(srgb_from_linear(0.0), 0.0);
    EXPECT_NEAR(srgb_from_linear(1.0), 1.0, 1e-15);
    EXPECT_DOUBLE_EQ(srgb_from_linear(0.001), 0.01292);
    EXPECT_DOUBLE_EQ(linear_from_srgb(0.01292), 0.001);
    EXPECT_NEAR(srgb_from_linear(std::exp2(-2.4)), 1.055 * 0.5 - 0.055, 1e-15);
    EXPECT_NEAR(srgb_from_linear(std::exp2(-4.8)), 1.055 * 0.25 - 0.055, 1e-15);
    EXPECT_NEAR(linear_from_srgb(1.055 * 0.25 - 0.055), std::exp2(-4.8), 1e-15);
    EXPECT_NEAR(srgb_from_linear(std::exp2(-2.4F)), 1.055F * 0.5F - 0.055F, 1e-6F);
    EXPECT_NEAR(linear_from_srgb(1.055F * 0.25F - 0.055F), std::exp2(-4.8F), 1e-6F);
}

TEST(Srgb, ThePiecesMeetAndGrow) {
    EXPECT_NEAR(srgb_from_linear(0.0031308), srgb_from_linear(std::nextafter(0.0031308, 1.0)), 1e-6);
    EXPECT_NEAR(linear_from_srgb(0.04045), linear_from_srgb(std::nextafter(0.04045, 1.0)), 1e-6);
    for (int i = 0; i < 4096; ++i)
        ASSERT_LT(srgb_from_linear(i / 4096.0), srgb_from_linear((i + 1) / 4096.0)) << i;
}

TEST(Srgb, ClampsWhatIsNoShare) {
    EXPECT_EQ(srgb8_from_linear(-0.5), 0);
    EXPECT_EQ(srgb8_from_linear(7.0F), 255);
}

TEST(Srgb, AllStepsComeBackInBothPrecisions) {
    for (int step = 0; step < 256; ++step) {
        EXPECT_EQ(int(srgb8_from_linear(linear_from_srgb(step / 255.0))), step);
        EXPECT_EQ(int(srgb8_from_linear(linear_from_srgb(float(step) / 255.0F))), step);
    }
}

TEST(Srgb, ColoursAreEncodedChannelByChannel) {
    const glm::u8vec3 color = srgb8_from_linear(glm::vec3(0.0F, 0.2158605F, 1.0F));
    EXPECT_EQ(int(color.r), 0);
    EXPECT_EQ(int(color.g), 128) << "half of the steps for less than a quarter of the light";
    EXPECT_EQ(int(color.b), 255);
}

TEST(ImageMean, OfTwoPicturesIsThatOfTheirLight) {
    Image a{256, 256, {}};
    Image b = a;
    for (int i = 0; i < 256 * 256; ++i) {
        a.rgba.insert(a.rgba.end(), 4, std::uint8_t(i % 256));
        b.rgba.insert(b.rgba.end(), 4, std::uint8_t(i / 256));
    }
    ImageMean mean;
    EXPECT_TRUE(mean.mean().rgba.empty());
    mean.add(a);
    EXPECT_EQ(mean.mean().rgba, a.rgba) << "a single picture is changed";
    mean.add(b);
    EXPECT_EQ(mean.count(), 2);
    const Image both = mean.mean();
    for (std::size_t k = 0; k < both.rgba.size(); ++k) {
        const double x = a.rgba[k] / 255.0;
        const double y = b.rgba[k] / 255.0;
        const bool is_alpha = k % 4 == 3;
        const double light = is_alpha ? 0.5 * (x + y) : 0.5 * (linear_from_srgb(x) + linear_from_srgb(y));
        ASSERT_NEAR(both.rgba[k], 255.0 * (is_alpha ? light : srgb_from_linear(light)), 0.5001)
            << int(a.rgba[k]) << " and " << int(b.rgba[k]);
    }
    EXPECT_THROW(mean.add(Image{1, 1, {0, 0, 0, 0}}), Error);
}

}  // namespace
}  // namespace cairn::optics
