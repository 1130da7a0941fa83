#include "optics/srgb.h"

#include <cmath>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace cairn::optics
