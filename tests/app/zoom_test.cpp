// `cairn render builtin:fractal --zoom K`.

#include <string>

#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

std::string picture_at(const std::string& zoom, const ScratchFolder& folder) {
    const std::string path = folder.file("zoom" + zoom + ".png");
    const Answer answer =
        cairn({"render", "builtin:fractal", "--zoom", zoom, "--size", "80x60", "--quiet", "-o", path});
    EXPECT_EQ(answer.code, 0) << answer;
    return read_text(path);
}

TEST(AppZoom, PicturesOfTheFractalAreTheSameAtEachPowerOfFour) {
    const ScratchFolder folder;
    const std::string first = picture_at("3", folder);
    EXPECT_GT(first.size(), 1000U) << "a picture of nothing?";
    EXPECT_TRUE(picture_at("41", folder) == first);
}

TEST(AppZoom, TheSpongeIsRenderedInItsOwnTreeAndIsNotZoomed) {
    const ScratchFolder folder;
    const std::string path = folder.file("sponge.png");
    const Answer answer =
        cairn({"render", "builtin:sponge", "--size", "48x48", "--max-resolution", "729", "-o", path});
    EXPECT_EQ(answer.code, 0) << answer;
    EXPECT_GT(read_text(path).size(), 1000U) << "a picture of nothing?";
    EXPECT_EQ(cairn({"render", "builtin:sponge", "--zoom", "3"}).code, 2);
    EXPECT_EQ(cairn({"render", "builtin:sponge", "--max-resolution", "20"}).code, 2);
}

TEST(AppZoom, WhatCannotBeZoomedIsRefused) {
    const Answer scene = cairn({"render", "builtin:cornell", "--zoom", "3"});
    EXPECT_EQ(scene.code, 2) << scene;
    EXPECT_NE(scene.err.find("--zoom"), std::string::npos) << scene;
    EXPECT_EQ(cairn({"render", "builtin:fractal", "--zoom", "60"}).code, 2);
    EXPECT_EQ(cairn({"render", "builtin:fractal", "--max-resolution", "64"}).code, 2);
}

}  // namespace
}  // namespace cairn::test
