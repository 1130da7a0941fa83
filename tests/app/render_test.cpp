// `cairn render`, from the command line to the PNG.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>
#include <utility>
#include <vector>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <gtest/gtest.h>
#include <stb/stb_image.h>

#include "tests/support/command.h"
#include "tests/support/gltf_file.h"
#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

struct Picture {
    int width = 0;
    int height = 0;
    int channels = 0;
    std::vector<std::uint8_t> values;

    explicit Picture(const std::string& path) {
        std::uint8_t* const loaded = stbi_load(path.c_str(), &width, &height, &channels, 0);
        if (loaded == nullptr) throw std::runtime_error(path + ": no PNG");
        values.assign(loaded, loaded + std::ptrdiff_t(width) * height * channels);
        stbi_image_free(loaded);
    }
    [[nodiscard]] std::vector<std::uint8_t> at(int x, int y) const {
        const auto first = values.begin() + (std::ptrdiff_t(y) * width + x) * channels;
        return {first, first + channels};
    }
    [[nodiscard]] std::size_t color_count() const {
        std::set<std::vector<std::uint8_t>> colors;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x)
                colors.insert(at(x, y));
        }
        return colors.size();
    }
    [[nodiscard]] double brightness() const {
        double sum = 0.0;
        for (const std::uint8_t value : values)
            sum += value;
        return sum / double(values.size());
    }
};

int largest_difference(const Picture& a, const Picture& b) {
    if (a.values.size() != b.values.size()) return 256;
    int largest = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        largest = std::max(largest, std::abs(a.values[i] - b.values[i]));
    return largest;
}

/// Renders with more options, and reads the picture back.
Picture picture_of(const ScratchFolder& folder, const std::string& scene,
                   const std::vector<std::string>& options) {
    std::vector<std::string> run = {"render", scene,   "-o",     folder.file("picture.png"),
                                    "--size", "96x64", "--quiet"};
    run.insert(run.end(), options.begin(), options.end());
    const Answer answer = cairn(run);
    EXPECT_EQ(answer.code, 0) << answer;
    return Picture(folder.file("picture.png"));
}

TEST(AppRender, WritesAPictureOfTheSceneAndItsFigures) {
    const ScratchFolder folder;
    const auto figures = cairn_json(
        {"render", "builtin:knot", "--size", "160x120", "--measure", "-o", folder.file("knot.png")});
    for (const char* key :
         {"frame_ms", "first_frame_ms", "passes", "bricks_produced", "bricks_resident", "node_pool_bytes",
          "brick_pool_bytes", "peak_rss_bytes", "driver", "load_ms", "context_ms", "setup_ms", "write_ms"}) {
        EXPECT_TRUE(figures.contains(key)) << key << " is not in " << figures.dump();
    }
    EXPECT_GT(figures["passes"], 0);
    EXPECT_GT(figures["bricks_produced"], 0);
    const Picture picture(folder.file("knot.png"));
    EXPECT_EQ(picture.width, 160);
    EXPECT_EQ(picture.height, 120);
    EXPECT_EQ(picture.channels, 3) << "the background is blended in, so there is no alpha";
    EXPECT_GT(picture.color_count(), 50U);
    EXPECT_EQ(picture.at(0, 0), picture.at(159, 119)) << "the default camera leaves a margin";
    EXPECT_EQ(folder.file_count(), 1U);
}

TEST(AppRender, DefaultOutputIsInTheWorkingFolder) {
    const ScratchFolder folder;
    const Answer answer = cairn({"render", "builtin:cornell", "--size", "16x16"}, {.folder = folder.path()});
    EXPECT_EQ(answer.code, 0) << answer;
    EXPECT_NE(answer.out.find("cairn.png"), std::string::npos) << answer;
    EXPECT_EQ(Picture(folder.file("cairn.png")).width, 16);
}

TEST(AppRender, ShadowsDarken) {
    const ScratchFolder folder;
    const double with = picture_of(folder, "builtin:spheres", {"--shadow", "hard"}).brightness();
    const double without = picture_of(folder, "builtin:spheres", {"--shadow", "none"}).brightness();
    EXPECT_LT(with, without);
}

TEST(AppRender, CameraAndLightAreObeyed) {
    const ScratchFolder folder;
    const auto from = [&](const std::string& camera, const std::string& light) {
        return picture_of(folder, "builtin:knot", {"--camera", camera, "--light", light}).values;
    };
    const auto picture = from("0,0,6,0,0,0,40", "3,4,5");
    EXPECT_EQ(picture, from("0,0,6,0,0,0,40", "3,4,5")) << "the same twice";
    EXPECT_NE(picture, from("0,0,6,0,0,0,60", "3,4,5")) << "field of view";
    EXPECT_NE(picture, from("-1,0,6,0,0,0,40", "3,4,5")) << "eye";
    EXPECT_NE(picture, from("0,0,6,0,1,0,40", "3,4,5")) << "target";
    EXPECT_NE(picture, from("0,0,6,0,0,0,40", "-3,4,5")) << "light";
}

TEST(AppRender, LooksStraightDown) {
    const ScratchFolder folder;
    EXPECT_GT(picture_of(folder, "builtin:knot", {"--camera", "0,6,0,0,0,0"}).color_count(), 10U);
    EXPECT_GT(picture_of(folder, "builtin:knot", {"--camera", "0,-6,0,0,0,0"}).color_count(), 10U);
}

/// Writes a square in the plane z = 0, with a light of its own.
void write_lit_square(const std::string& path, const Json& light, const Json& node_of_light) {
    GltfFile file;
    const int positions = file.add_accessor<float>({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3");
    file.json["accessors"][0]["min"] = {-1, -1, 0};
    file.json["accessors"][0]["max"] = {1, 1, 0};
    const int indices = file.add_accessor<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
    file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    file.json["extensionsUsed"] = {"KHR_lights_punctual"};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({light});
    Json node = node_of_light;
    node["extensions"]["KHR_lights_punctual"]["light"] = 0;
    file.add_root(node);
    file.write_gltf(path);
}

TEST(AppRender, TheScenesOwnLightGivesItsColorAndDirection) {
    const ScratchFolder folder;
    const std::vector<std::string> front = {"--camera", "0,0,4,0,0,0"};
    // The light shines along -Z of its node: without a rotation, on the side that the camera sees.
    write_lit_square(folder.file("front.gltf"), {{"type", "directional"}, {"color", {1.0, 0.0, 0.0}}},
                     {{"name", "sun"}});
    const std::vector<std::uint8_t> red = picture_of(folder, folder.file("front.gltf"), front).at(48, 32);
    EXPECT_GT(red[0], red[1] + 50) << "red light on a white square";
    EXPECT_EQ(red[1], red[2]);

    const Json point = {{"type", "point"}, {"color", {0.0, 0.0, 1.0}}};
    write_lit_square(folder.file("point.gltf"), point, {{"translation", {0.0, 0.0, 3.0}}});
    const std::vector<std::uint8_t> blue = picture_of(folder, folder.file("point.gltf"), front).at(48, 32);
    EXPECT_GT(blue[2], blue[0] + 50) << "blue light on a white square";
}

TEST(AppRender, AnEmptySceneIsBackground) {
    const ScratchFolder folder;
    write_text(folder.file("empty.gltf"), R"({"asset": {"version": "2.0"}, "scenes": [{}], "scene": 0})");
    EXPECT_EQ(picture_of(folder, folder.file("empty.gltf"), {}).color_count(), 1U);
}

TEST(AppRender, ASmallPoolGivesTheSamePicture) {
    const ScratchFolder folder;
    const Picture roomy = picture_of(folder, "builtin:knot", {});
    const Picture tight = picture_of(folder, "builtin:knot", {"--brick-pool", "4"});
    EXPECT_EQ(largest_difference(roomy, tight), 0);
}

TEST(AppRender, ResolutionIsBounded) {
    const ScratchFolder folder;
    const auto bricks = [&](const char* resolution) {
        return cairn_json({"render", "builtin:knot", "--size", "160x120", "--max-resolution", resolution,
                           "-o", folder.file("a.png")})["bricks_produced"]
            .get<int>();
    };
    EXPECT_LT(bricks("32"), bricks("2048"));
}

TEST(AppRender, WhatIsNotAsAskedForIsTold) {
    const ScratchFolder folder;
    const auto told = [&](const std::vector<std::string>& options) {
        std::vector<std::string> run = {"render", "builtin:cornell",   "--size", "16x12",
                                        "-o",     folder.file("a.png")};
        run.insert(run.end(), options.begin(), options.end());
        const Answer answer = cairn(run);
        EXPECT_EQ(answer.code, 0) << answer;
        run.emplace_back("--quiet");
        EXPECT_EQ(cairn(run).err, "");
        return answer.err;
    };
    const auto expect_told = [&](const std::vector<std::string>& options, const std::string& part) {
        const std::string text = told(options);
        EXPECT_NE(text.find(part), std::string::npos) << text;
        EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    };
    expect_told({"--shadow", "soft"}, "the light has no extent");
    expect_told({"--shadow", "soft", "--light", "0,2,0"}, "the light has no extent");
    expect_told({"--cones"}, "the light has no extent");
    expect_told({"--shadow", "none", "--cones"}, "there are no shadows");
    for (const std::vector<std::string>& met : {std::vector<std::string>{},
                                                {"--max-resolution", "1000"},
                                                {"--shadow", "soft", "--light", "0,2,0,0.3"},
                                                {"--cones", "--light", "0,2,0,0.3"}})
        EXPECT_EQ(told(met), "");
    const Json figures = cairn_json({"render", "builtin:cornell", "--size", "16x12", "--max-resolution",
                                     "1000", "-o", folder.file("a.png")});
    EXPECT_EQ(figures.value("finest_resolution", 0), 1000) << figures;
    const Answer sponge = cairn({"render", "builtin:sponge", "--size", "16x12", "--max-resolution", "1000",
                                 "-o", folder.file("a.png"), "--json", "-"});
    EXPECT_NE(sponge.err.find("at most 729 voxels across"), std::string::npos) << sponge;
    EXPECT_EQ(sponge.json().value("finest_resolution", 0), 729) << sponge;
}

TEST(AppRender, SamplesSmoothThePictureAndAreReported) {
    const ScratchFolder folder;
    const std::vector<std::string> run = {"render", "builtin:cornell",   "--size", "48x36",
                                          "-o",     folder.file("a.png")};
    EXPECT_EQ(cairn_json(run).value("samples", 0), 1);
    const std::size_t colors = Picture(folder.file("a.png")).color_count();
    std::vector<std::string> sampled = run;
    sampled.insert(sampled.end(), {"--samples", "4"});
    EXPECT_EQ(cairn_json(sampled).value("samples", 0), 4);
    EXPECT_GT(Picture(folder.file("a.png")).color_count(), colors) << "no edge is a mean";
    sampled.insert(sampled.end(), {"--frame-budget", "10"});
    const Answer within_budget = cairn(sampled);
    EXPECT_EQ(within_budget.code, 2) << within_budget;
    EXPECT_NE(within_budget.err.find("--samples"), std::string::npos) << within_budget;
}

TEST(AppRender, FramesAreTimedIfThatIsAskedFor) {
    const ScratchFolder folder;
    const std::vector<std::string> run = {"render", "builtin:cornell",   "--size", "16x12",
                                          "-o",     folder.file("a.png")};
    EXPECT_FALSE(cairn_json(run).contains("frame_ms"));
    std::vector<std::string> measured = run;
    measured.emplace_back("--measure");
    EXPECT_TRUE(cairn_json(measured).contains("frame_ms"));
    measured.emplace_back("--quiet");
    const Answer nothing_tells = cairn(measured);
    EXPECT_EQ(nothing_tells.code, 2) << nothing_tells;
    EXPECT_NE(nothing_tells.err.find("--measure"), std::string::npos) << nothing_tells;
}

/// Output of a run of `cairn render`.
struct Rendered {
    Json figures;
    std::string png;  ///< the bytes of the file
};

/// Renders at 96 x 64 pixels with more options.
Rendered rendered(const ScratchFolder& folder, const std::string& scene,
                  const std::vector<std::string>& options) {
    std::vector<std::string> run = {"render", scene, "--size", "96x64", "-o", folder.file("p.png")};
    run.insert(run.end(), options.begin(), options.end());
    const Json figures = cairn_json(run);
    return {figures, read_text(folder.file("p.png"))};
}

TEST(AppRender, TraversalsAndTileQueriesMakeTheSamePictureInAnotherWay) {
    const ScratchFolder folder;
    const auto render = [&](const std::vector<std::string>& options) {
        return rendered(folder, "builtin:knot", options);
    };
    const auto [usual, expected] = render({});
    EXPECT_EQ(usual["tree_n"], 4);
    EXPECT_EQ(usual["brick_m"], 16);
    EXPECT_EQ(usual["traversal"], "mini-stack");
    EXPECT_EQ(usual["tile_query_method"], "list");
    EXPECT_EQ(usual["converged"], true);
    for (const char* traversal : {"restart", "stackless"}) {
        const auto [figures, picture] = render({"--traversal", traversal});
        EXPECT_EQ(figures["traversal"], traversal);
        EXPECT_TRUE(picture == expected) << traversal;
    }
    const auto [blocks, by_blocks] = render({"--tile-queries", "blocks"});
    EXPECT_EQ(blocks["tile_query_method"], "blocks");
    EXPECT_TRUE(by_blocks == expected);
    EXPECT_GT(blocks["passes"], usual["passes"]);
}

TEST(AppRender, TreesHaveTheShapeThatIsAskedFor) {
    const ScratchFolder folder;
    // Both trees have 16 voxels across the scene. Each voxel is several pixels wide, so that neither tree
    // shows coarser voxels anywhere.
    const auto render = [&](const char* resolution, std::vector<std::string> options) {
        options.insert(options.end(), {"--max-resolution", resolution});
        return rendered(folder, "builtin:cornell", options);
    };
    const auto [usual, expected] = render("16", {});
    const auto [binary, picture] = render("16", {"--tree-n", "2", "--brick-m", "8"});
    EXPECT_EQ(binary["tree_n"], 2);
    EXPECT_EQ(binary["brick_m"], 8);
    EXPECT_GT(binary["bricks_produced"], usual["bricks_produced"]);
    EXPECT_TRUE(picture == expected);
    const auto [thirds, other] = render("27", {"--tree-n", "3"});
    EXPECT_EQ(thirds["brick_m"], 27);
}

TEST(AppRender, AFrameWithinABudgetShowsWhatThereIs) {
    const ScratchFolder folder;
    const auto render = [&](const std::vector<std::string>& options) {
        return rendered(folder, "builtin:knot", options);
    };
    const auto [whole, expected] = render({});
    EXPECT_FALSE(whole.contains("frame_budget_ms"));
    const auto [none, picture] = render({"--frame-budget", "0"});
    EXPECT_EQ(none["frame_budget_ms"], 0.0);
    EXPECT_EQ(none["converged"], false);
    EXPECT_LT(none["bricks_produced"], whole["bricks_produced"]);
    EXPECT_FALSE(picture == expected);
    const auto [ample, same] = render({"--frame-budget", "600000"});
    EXPECT_EQ(ample["converged"], true);
    EXPECT_TRUE(same == expected);
}

}  // namespace
}  // namespace cairn::test
