// Files, nodes, scenes and extensions, with files that the tests write.
#include "scenes/load.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"
#include "scenes/snapshot.h"
#include "tests/support/gltf_file.h"
#include "tests/support/scratch_folder.h"

namespace cairn::scenes {
namespace {

using test::Bytes;
using test::GltfFile;
using test::Json;
using test::ScratchFolder;

GltfFile triangle() {
    GltfFile file;
    const int positions = file.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    file.add_mesh({{"attributes", {{"POSITION", positions}}}});
    return file;
}

Scene load_glb(const GltfFile& file) {
    const ScratchFolder folder;
    file.write_glb(folder.file("test.glb"));
    return load(folder.file("test.glb"));
}

std::string message_of(const std::filesystem::path& path, const LoadOptions& options = {}) {
    try {
        (void)load(path.string(), options);
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::input) << error.what();
        EXPECT_FALSE(error.way_out().empty()) << error.what();
        return error.what();
    }
    ADD_FAILURE() << path << " was loaded";
    return {};
}

#define EXPECT_HOLDS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST(Load, GlbAndGltfAreTheSame) {
    const ScratchFolder folder;
    triangle().write_glb(folder.file("a.glb"));
    triangle().write_gltf(folder.file("b.gltf"));
    for (const char* name : {"a.glb", "b.gltf"}) {
        const Scene scene = load(folder.file(name));
        EXPECT_EQ(scene.name, name);
        EXPECT_EQ(scene.meshes.at(0).primitives.at(0).positions.at(1), glm::vec3(1, 0, 0)) << name;
        EXPECT_EQ(scene.meshes[0].primitives[0].indices, (std::vector<std::uint32_t>{0, 1, 2})) << name;
        EXPECT_TRUE(scene.warnings.empty()) << name;
    }
}

TEST(Load, BuiltinScenesByTheirPrefix) {
    EXPECT_EQ(take_snapshot(load("builtin:knot")).triangle_count, 52992U);
}

TEST(Load, AMissingFileIsNamed) {
    EXPECT_HOLDS(message_of("/nowhere/ear.glb"), "ear.glb");
}

TEST(Load, AFolderIsNoFile) {
    EXPECT_HOLDS(message_of(std::filesystem::temp_directory_path()), "not a regular file");
}

TEST(Load, BuffersMayBeDataUris) {
    GltfFile file = triangle();
    // 36 bytes: (0,0,0) (1,0,0) (0,1,0)
    const std::string base64 = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    file.json["buffers"] =
        Json::array({{{"byteLength", 36}, {"uri", "data:application/octet-stream;base64," + base64}}});
    file.binary.clear();
    EXPECT_EQ(take_snapshot(load_glb(file)).bounds.high, glm::dvec3(1, 1, 0));
}

TEST(Load, UrisAreDecodedAndStayInTheFolder) {
    const ScratchFolder folder;
    GltfFile file = triangle();
    std::filesystem::create_directory(folder.file("sub"));
    std::filesystem::create_directory(folder.file("scene"));
    test::write_bytes(folder.file("sub/out side.bin"), file.binary.data(), file.binary.size());
    test::write_bytes(folder.file("scene/in side.bin"), file.binary.data(), file.binary.size());
    const auto with_uri = [&](const std::string& uri) {
        const std::string text = file.with_buffer(uri).dump();
        test::write_bytes(folder.file("scene/test.gltf"), text.data(), text.size());
        return folder.file("scene/test.gltf");
    };
    for (const char* uri : {"in%20side.bin", "in side.bin", "./in%20side.bin", "x/../in%20side.bin"})
        EXPECT_NO_THROW((void)load(with_uri(uri))) << uri;

    const std::string absolute = folder.file("sub/out side.bin");
    for (const std::string& uri :
         {std::string("../sub/out%20side.bin"), std::string("%2e%2e/sub/out side.bin"),
          std::string("x/../../sub/out side.bin"), absolute}) {
        EXPECT_HOLDS(message_of(with_uri(uri)), "buffer 0") << uri;
        EXPECT_NO_THROW((void)load(with_uri(uri), {.trust_paths = true})) << uri;
    }
    for (const bool trust : {false, true})
        for (const char* uri : {"http://example.org/a.bin", "file:///etc/passwd", "HTTPS:a.bin", "C:/a.bin"})
            EXPECT_HOLDS(message_of(with_uri(uri), {trust}), "scheme") << uri;
    EXPECT_HOLDS(message_of(with_uri("a%00.bin")), "zero byte");
    EXPECT_HOLDS(message_of(with_uri("gone.bin")), "gone.bin");
}

TEST(Extensions, RequiredButUnsupportedIsAnErrorThatNamesIt) {
    GltfFile file = triangle();
    file.json["extensionsUsed"] = {"ACME_teapot", "KHR_texture_transform"};
    file.json["extensionsRequired"] = file.json["extensionsUsed"];
    const ScratchFolder folder;
    file.write_glb(folder.file("a.glb"));
    const std::string message = message_of(folder.file("a.glb"));
    EXPECT_HOLDS(message, "ACME_teapot");
    EXPECT_EQ(message.find("KHR_texture_transform"), std::string::npos) << message;
}

TEST(Extensions, OptionalButUnsupportedIsOneWarning) {
    GltfFile file = triangle();
    file.json["extensionsUsed"] = {"ACME_teapot", "ACME_teapot", "KHR_materials_unlit"};
    file.json["extensionsRequired"] = {"KHR_materials_unlit"};
    const Scene scene = load_glb(file);
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_HOLDS(scene.warnings[0].text, "ACME_teapot");
}

TEST(Nodes, TransformsMultiplyDownTheHierarchy) {
    GltfFile file = triangle();
    const double half = std::numbers::sqrt2 / 2.0;
    file.json["nodes"] = {
        {{"children", {1}}, {"scale", {-2, 3, 1}}},
        {{"children", {2}}, {"translation", {1, 0, 0}}},
        {{"mesh", 0}, {"rotation", {0, 0, half, half}}}};  // a quarter turn: x to y, y to -x
    const Scene scene = load_glb(file);
    const Snapshot snapshot = take_snapshot(scene);
    ASSERT_EQ(snapshot.items.size(), 1U);
    // (1, 0, 0) turns to (0, 1, 0), moves to (1, 1, 0), scales to (-2, 3, 0); (0, 1, 0) to (-1, 0, 0), (0, 0,
    // 0), same.
    EXPECT_NEAR(snapshot.bounds.low.x, -2.0, 1e-12);
    EXPECT_NEAR(snapshot.bounds.high.x, 0.0, 1e-12);
    EXPECT_NEAR(snapshot.bounds.high.y, 3.0, 1e-12);
}

TEST(Nodes, MatrixIsColumnMajor) {
    GltfFile file = triangle();
    file.json["nodes"][0]["matrix"] = {0, 2, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1};
    const Snapshot snapshot = take_snapshot(load_glb(file));
    EXPECT_EQ(snapshot.bounds.low, glm::dvec3(5, 6, 7));
    EXPECT_EQ(snapshot.bounds.high, glm::dvec3(6, 8, 7));
}

TEST(Nodes, ABillionUnitsAwayTheBoundsAreStillExact) {
    GltfFile file = triangle();
    file.json["nodes"][0]["translation"] = {1e9, 0, 0};
    const Snapshot snapshot = take_snapshot(load_glb(file));
    EXPECT_EQ(snapshot.bounds.high.x - snapshot.bounds.low.x, 1.0);
}

TEST(Nodes, AChainOfAHundredThousandIsNoRecursion) {
    GltfFile file = triangle();
    constexpr int depth = 100'000;
    for (int i = 1; i < depth; ++i) {
        file.json["nodes"][static_cast<std::size_t>(i) - 1]["children"] = {i};
        file.json["nodes"].push_back({{"translation", {0, 0, 1}}});
    }
    file.json["nodes"][depth - 1]["mesh"] = 0;
    EXPECT_EQ(take_snapshot(load_glb(file)).bounds.high.z, depth - 1.0);
}

TEST(Nodes, InstancesStandInTheSpaceOfTheirNode) {
    GltfFile file = triangle();
    const int moves = file.add_accessor(std::vector<float>{0, 0, 0, 10, 0, 0, 0, 20, 0}, "VEC3");
    const int scales = file.add_accessor(std::vector<float>{1, 1, 1, 2, 2, 2, 1, -1, 1}, "VEC3");
    const int turns =
        file.add_accessor(std::vector<std::int8_t>{0, 0, 0, 127, 0, 0, 127, 0, 0, 0, 0, 127}, "VEC4", true);
    file.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    file.json["nodes"][0]["translation"] = {100, 0, 0};
    file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", moves}, {"SCALE", scales}, {"ROTATION", turns}};
    const Scene scene = load_glb(file);
    const Snapshot snapshot = take_snapshot(scene);
    ASSERT_EQ(snapshot.items.size(), 3U);
    EXPECT_EQ(snapshot.triangle_count, 3U);
    EXPECT_EQ(snapshot.items[0].positions.data(), snapshot.items[1].positions.data());  // shared
    const auto world = [&](std::size_t item, double x, double y) {
        return glm::dvec3(snapshot.items[item].world_from_mesh * glm::dvec4(x, y, 0, 1));
    };
    EXPECT_EQ(world(0, 1, 0), glm::dvec3(101, 0, 0));
    EXPECT_EQ(world(1, 1, 0), glm::dvec3(108, 0, 0));  // twice as large, turned by half about z
    EXPECT_EQ(world(2, 0, 1), glm::dvec3(100, 19, 0));
}

TEST(Nodes, LightsAndCamerasArePlaced) {
    GltfFile file = triangle();
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_lights_punctual"};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"},
                                                                 {"color", {1, 0.5, 0}},
                                                                 {"intensity", 40},
                                                                 {"range", 9},
                                                                 {"spot", {{"outerConeAngle", 0.5}}}},
                                                                {{"type", "directional"}}};
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}});
    file.add("cameras", {{"type", "orthographic"},
                         {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"znear", 0}, {"zfar", 9}}}});
    file.add_root({{"translation", {0, 7, 0}},
                   {"camera", 1},
                   {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    const Scene scene = load_glb(file);
    const Snapshot snapshot = take_snapshot(scene);
    ASSERT_EQ(snapshot.lights.size(), 1U);
    EXPECT_EQ(snapshot.lights[0].light.type, Light::Type::spot);
    EXPECT_EQ(snapshot.lights[0].light.color, glm::vec3(1, 0.5F, 0));
    EXPECT_EQ(snapshot.lights[0].light.outer_cone, 0.5F);
    EXPECT_EQ(snapshot.lights[0].world_from_light[3], glm::dvec4(0, 7, 0, 1));
    EXPECT_EQ(scene.lights[1].type, Light::Type::directional);
    ASSERT_EQ(snapshot.cameras.size(), 1U);
    EXPECT_FALSE(snapshot.cameras[0].camera.perspective);
    EXPECT_EQ(snapshot.cameras[0].camera.ymag, 3.0);
    EXPECT_EQ(scene.cameras[0].yfov, 0.7);
}

TEST(Scenes, EachShowsItsOwnNodes) {
    GltfFile file = triangle();
    const int far_away = file.add("nodes", {{"mesh", 0}, {"translation", {50, 0, 0}}});
    file.add("scenes", {{"name", "far"}, {"nodes", {far_away, 0}}});
    file.json["scene"] = 1;
    const Scene scene = load_glb(file);
    EXPECT_EQ(take_snapshot(scene).items.size(), 2U);
    EXPECT_EQ(take_snapshot(scene, {0.0, std::nullopt, 0}).bounds.high.x, 1.0);
}

TEST(Scenes, AFileWithoutScenesShowsEverything) {
    GltfFile file = triangle();
    file.json.erase("scenes");
    EXPECT_EQ(take_snapshot(load_glb(file)).items.size(), 1U);
}

TEST(Scenes, AnIndexThatDoesNotExistIsTheCallersFault) {
    const Scene scene = load_glb(triangle());
    for (const When& when :
         {When{0.0, 0, std::nullopt}, When{0.0, std::nullopt, 1}, When{0.0, -1, std::nullopt}}) {
        try {
            (void)take_snapshot(scene, when);
            ADD_FAILURE() << "no error";
        } catch (const Error& error) {
            EXPECT_EQ(error.fault(), Fault::usage) << error.what();
        }
    }
}

TEST(Scenes, ATransformThatLosesAVertexIsAnError) {
    GltfFile file = triangle();
    file.json["nodes"][0]["scale"] = {1e308, 1, 1};
    file.json["nodes"][0]["children"] = {1};
    file.json["nodes"].push_back({{"mesh", 0}, {"scale", {1e308, 1, 1}}});
    const Scene scene = load_glb(file);
    try {
        (void)take_snapshot(scene);
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::input);
        EXPECT_HOLDS(std::string(error.what()), "node 1");
    }
}

}  // namespace
}  // namespace cairn::scenes
