// Files at the ends of what floats can say: the same answer from every verb, and never a crash.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/gltf_file.h"
#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

constexpr float huge = 3e38F;

struct Extreme {
    const char* name;
    float scale = 1.0F;     ///< of the square's positions
    float texcoord = 1.0F;  ///< texture coordinates are plus and minus this one
    int wrap = 10497;       ///< repeat
    Json transform = {};    ///< KHR_texture_transform
    const char* mode = "MASK";
    bool is_degenerate = false;
    bool has_picture = true;  ///< whether rays can see it, so that every verb draws it

    friend void PrintTo(const Extreme& extreme, std::ostream* out) { *out << extreme.name; }

    [[nodiscard]] GltfFile file() const {
        GltfFile out;
        std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
        for (float& p : positions)
            p *= scale;
        const float t = texcoord;
        const int texels = out.add_view(PngWriter::make(1, 1, 8, {0, 255, 128, 0, 200}));
        Json texture = {{"index", 0}};
        if (!transform.is_null()) texture["extensions"] = {{"KHR_texture_transform", transform}};
        out.json["extensionsUsed"] = {"KHR_texture_transform"};
        out.add("images", {{"bufferView", texels}, {"mimeType", "image/png"}});
        out.add("samplers", {{"wrapS", wrap}, {"wrapT", wrap}});
        out.add("textures", {{"source", 0}, {"sampler", 0}});
        out.add("materials",
                {{"alphaMode", mode}, {"pbrMetallicRoughness", {{"baseColorTexture", texture}}}});
        const std::vector<std::uint16_t> corners =
            is_degenerate ? std::vector<std::uint16_t>(30, 3) : std::vector<std::uint16_t>{0, 1, 2, 2, 1, 3};
        const int at = out.add_accessor(positions, "VEC3");
        const int coordinates = out.add_accessor(std::vector<float>{t, t, -t, t, t, -t, -t, -t}, "VEC2");
        const int indices = out.add_accessor(corners, "SCALAR");
        out.add_mesh({{"attributes", {{"POSITION", at}, {"TEXCOORD_0", coordinates}}},
                      {"indices", indices},
                      {"material", 0}});
        return out;
    }
};

class Extremes : public testing::TestWithParam<Extreme> {};

TEST_P(Extremes, EndWithAnAnswerByEveryVerbThatReadsThem) {
    const ScratchFolder folder;
    const std::string file = folder.file("extreme.glb");
    GetParam().file().write_glb(file);
    EXPECT_EQ(cairn({"info", file}).code, 0);
    EXPECT_EQ(cairn({"export", file, "--quiet", "-o", folder.file("o.glb")}).code, 0);
    EXPECT_EQ(cairn({"voxelize", file, "-r", "16", "--quiet", "-o", folder.file("o.vdb")}).code, 0);
    EXPECT_EQ(cairn({"check", file, "-r", "16", "--quiet"}).code, 0);
    const std::vector<std::vector<std::string>> pictures = {
        {"render", "-o", folder.file("o.png"), "--max-resolution", "64"},
        {"shadow", "--method", "embree"},
        {"shadow", "--method", "voxel"},
        {"shadow", "--method", "pyramid"},
        {"shadow", "--method", "soft-shadow-map", "--occluders", "0", "--ground", "--light", "3,5,4",
         "--light-size", "1,1"},
        {"shadow", "--method", "embree", "--ground", "--light", "3,5,4,1"},
        {"shadow", "--method", "voxel", "--compare", "embree"}};
    for (std::vector<std::string> picture : pictures) {
        picture.insert(picture.end(), {file, "--size", "16x12", "--quiet"});
        const Answer answer = cairn(picture);
        if (GetParam().has_picture) {
            EXPECT_EQ(answer.code, 0) << fmt::format("{}", fmt::join(picture, " ")) << answer;
        } else {
            EXPECT_TRUE(answer.code == 2 || answer.code == 3)
                << fmt::format("{}", fmt::join(picture, " ")) << answer;
            EXPECT_TRUE(answer.err.starts_with("error: ")) << answer;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, Extremes,
    testing::Values(
        Extreme{.name = "TexcoordsNearInfinity", .texcoord = huge},
        Extreme{.name = "TexcoordsPastInfinity", .texcoord = huge, .transform = {{"scale", {10, 10}}}},
        Extreme{.name = "TexcoordsPastInfinityOpaque",
                .texcoord = huge,
                .transform = {{"scale", {10, 10}}},
                .mode = "OPAQUE"},
        Extreme{.name = "TexcoordsPastInfinityMirrored",
                .texcoord = huge,
                .wrap = 33648,
                .transform = {{"scale", {1e30, 1e30}}, {"offset", {-1e38, 1e38}}}},
        Extreme{.name = "TexcoordsPastInfinityClamped",
                .texcoord = huge,
                .wrap = 33071,
                .transform = {{"scale", {1e30, 1e30}}}},
        Extreme{.name = "TexcoordsOf1e10", .texcoord = 1e10F},
        Extreme{.name = "PositionsOf1e17", .scale = 1e17F, .mode = "OPAQUE", .has_picture = false},
        Extreme{.name = "PositionsOf1e19", .scale = 1e19F, .mode = "OPAQUE", .has_picture = false},
        Extreme{.name = "APointAt1e38",
                .scale = 1e38F,
                .mode = "OPAQUE",
                .is_degenerate = true,
                .has_picture = false}),
    [](const auto& param) { return param.param.name; });

}  // namespace
}  // namespace cairn::test
