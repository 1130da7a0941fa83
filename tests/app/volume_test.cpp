// Volumes on the command line.
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "app/options/transfer_option.h"
#include "renderer/open_content.h"
#include "tests/support/command.h"
#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

class VolumeCommand : public ::testing::Test {
protected:
    VolumeCommand() {
        write_text(folder_.path() / "field.mha",
                   std::string("NDims = 3\nDimSize = 64 64 64\nElementType = MET_UCHAR\n"
                               "ElementDataFile = LOCAL\n") +
                       std::string(64 * 64 * 64, '\xC8'));
    }
    [[nodiscard]] std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
    /// Writes a volume of 8 x 4 x 2 samples of 200.
    [[nodiscard]] std::string block() const {
        write_text(
            folder_.path() / "block.mha",
            std::string("NDims = 3\nDimSize = 8 4 2\nElementSpacing = 0.5 1 1\nElementType = MET_UCHAR\n"
                        "ElementDataFile = LOCAL\n") +
                std::string(64, '\xC8'));
        return path("block.mha");
    }

private:
    ScratchFolder folder_;
};

TEST_F(VolumeCommand, InfoTellsSamplesSpacingValuesAndBounds) {
    const nlohmann::json json = cairn_json({"info", block()});
    EXPECT_EQ(json.at("samples"), nlohmann::json({8, 2, 4}));
    EXPECT_EQ(json.at("spacing"), nlohmann::json({0.5, 1.0, 1.0}));
    EXPECT_EQ(json.at("greatest_value"), 255.0);
    EXPECT_EQ(json.at("bounds_low"), nlohmann::json({-0.25, -0.5, -3.5}));
    EXPECT_EQ(json.at("bounds_high"), nlohmann::json({3.75, 1.5, 0.5}));
}

TEST_F(VolumeCommand, RenderMakesAPictureAndCountsVoxels) {
    const nlohmann::json json =
        cairn_json({"render", block(), "--size", "32x24", "--copies", "2", "-o", path("block.png")});
    EXPECT_EQ(json.at("voxels"), nlohmann::json({32, 32, 32}));  // twice the least power of 4 that holds 8
    EXPECT_GT(json.at("bricks_produced").get<int>(), 0);
    EXPECT_TRUE(std::ifstream(path("block.png")).good());
    const nlohmann::json ball =
        cairn_json({"render", "builtin:ball", "--size", "32x24", "--max-resolution", "64", "--transfer",
                    "0:1,1,1:0;1:1,0.5,0:0.3", "-o", path("ball.png")});
    EXPECT_EQ(ball.at("voxels"), nlohmann::json({64, 64, 64}));
}

TEST_F(VolumeCommand, AResolutionThatIsNotMetIsTold) {
    // 64 voxels across, of which a level has 4 times as many as the one above it.
    const std::pair<const char*, int> finest[] = {{"64", 64}, {"63", 16}, {"17", 16}, {"16", 16}};
    for (const auto& [asked, across] : finest) {
        const Answer answer = cairn({"render", path("field.mha"), "--size", "16x12", "--max-resolution",
                                     asked, "-o", path("field.png"), "--json", "-"});
        ASSERT_EQ(answer.code, 0) << answer;
        EXPECT_EQ(answer.json().value("finest_resolution", 0), across) << answer;
        const bool is_told = answer.err.find("at most " + std::to_string(across)) != std::string::npos;
        EXPECT_EQ(is_told, std::to_string(across) != asked) << answer;
    }
    const Answer more = cairn({"render", path("field.mha"), "--size", "16x12", "--max-resolution", "4096",
                               "-o", path("field.png")});
    EXPECT_EQ(more.err, "") << "a volume has no more voxels than samples" << more;
}

TEST_F(VolumeCommand, StepsAndGradientsChangeThePicture) {
    const auto render = [&](const std::vector<std::string>& options) {
        std::vector<std::string> run = {"render",           "builtin:ball", "--size", "48x36",
                                        "--max-resolution", "64",           "-o",     path("ball.png")};
        run.insert(run.end(), options.begin(), options.end());
        const nlohmann::json json = cairn_json(run);
        return std::pair(json, read_text(path("ball.png")));
    };
    const auto [usual, expected] = render({});
    EXPECT_EQ(usual.at("steps_per_voxel"), 2);
    EXPECT_EQ(usual.at("gradient_threshold"), 0.08);
    const auto [same, repeated] = render({"--steps-per-voxel", "2", "--gradient-threshold", "0.08"});
    EXPECT_TRUE(repeated == expected);
    const auto [fine, by_steps] = render({"--steps-per-voxel", "16"});
    EXPECT_EQ(fine.at("steps_per_voxel"), 16);
    EXPECT_FALSE(by_steps == expected);
    const auto [fog, as_fog] = render({"--gradient-threshold", "0"});
    EXPECT_EQ(fog.at("gradient_threshold"), 0.0);
    EXPECT_FALSE(as_fog == expected);
}

TEST(TransferOption, TheDefaultIsTheLibrarys) {
    const std::vector<renderer::ControlPoint> ours = app::parse_transfer(app::default_transfer).points;
    const std::vector<renderer::ControlPoint> theirs = renderer::default_transfer();
    ASSERT_EQ(ours.size(), theirs.size());
    for (std::size_t i = 0; i < ours.size(); ++i) {
        EXPECT_EQ(ours[i].value, theirs[i].value);
        EXPECT_EQ(ours[i].color, theirs[i].color);
        EXPECT_EQ(ours[i].extinction, theirs[i].extinction);
    }
}

TEST_F(VolumeCommand, WhatNeedsSurfacesSaysSo) {
    for (const char* verb : {"voxelize", "check"}) {
        const Answer answer = cairn({verb, "builtin:ball", "-r", "16"});
        EXPECT_EQ(answer.code, 2) << answer;
        EXPECT_NE(answer.err.find("that is a volume"), std::string::npos) << answer;
    }
    const Answer surface = cairn({"render", "builtin:knot", "--transfer", "bone", "-o", path("knot.png")});
    EXPECT_EQ(surface.code, 2) << surface;
    EXPECT_NE(surface.err.find("no volume"), std::string::npos) << surface;
    const Answer moment = cairn({"render", "builtin:ball", "--time", "1", "-o", path("ball.png")});
    EXPECT_EQ(moment.code, 2) << moment;
}

TEST_F(VolumeCommand, BadTransferFunctionsAreWrongUsage) {
    for (const char* text : {"glass", "", "0.5", "0:1,1:1", "0:1,1,1", "0:1,1,1:-1", "2:1,1,1:1",
                             "1:1,1,1:1;0:1,1,1:1", "0:1,1,1:nan", "0:2,1,1:1"}) {
        const Answer answer = cairn({"render", "builtin:ball", "--transfer", text, "-o", path("ball.png")});
        EXPECT_EQ(answer.code, 2) << text << answer;
        EXPECT_FALSE(answer.err.empty()) << text;
    }
}

TEST_F(VolumeCommand, DamagedFileIsABadInput) {
    write_text(path("bad.nii"), "not at all");
    const Answer answer = cairn({"render", path("bad.nii"), "-o", path("bad.png")});
    EXPECT_EQ(answer.code, 3) << answer;
    EXPECT_NE(answer.err.find("bad.nii"), std::string::npos) << answer;
}

}  // namespace
}  // namespace cairn::test
