// Animation, morph targets and skins, with files that the tests write.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "scenes/load.h"
#include "scenes/pose.h"
#include "scenes/snapshot.h"
#include "tests/support/gltf_file.h"
#include "tests/support/scratch_folder.h"

namespace cairn::scenes {
namespace {

using test::GltfFile;
using test::Json;
using test::ScratchFolder;

Scene load_glb(const GltfFile& file) {
    const ScratchFolder folder;
    file.write_glb(folder.file("test.glb"));
    return load(folder.file("test.glb"));
}

GltfFile point(const std::vector<float>& positions = {0, 0, 0}) {
    GltfFile file;
    const int accessor = file.add_accessor(positions, "VEC3");
    file.add_mesh({{"attributes", {{"POSITION", accessor}}}, {"mode", 0}});
    return file;
}

void animate(GltfFile& file, int node, const char* path, const char* interpolation, int times, int values) {
    file.add("animations",
             {{"samplers", {{{"input", times}, {"output", values}, {"interpolation", interpolation}}}},
              {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}});
}

glm::dvec3 place(const Scene& scene, double seconds) {
    return take_snapshot(scene, {seconds, 0, std::nullopt}).bounds.low;
}

TEST(Animation, StepHoldsAndLinearMixes) {
    for (const bool linear : {false, true}) {
        GltfFile file = point();
        const int times = file.add_accessor(std::vector<float>{1, 2, 4}, "SCALAR");
        const int values = file.add_accessor(std::vector<float>{10, 0, 0, 20, 0, 0, 60, 8, 0}, "VEC3");
        animate(file, 0, "translation", linear ? "LINEAR" : "STEP", times, values);
        const Scene scene = load_glb(file);
        EXPECT_EQ(scene.animations.at(0).duration, 4.0);
        EXPECT_EQ(place(scene, -5).x, 10.0);  // clamped to the first key
        EXPECT_EQ(place(scene, 1).x, 10.0);
        EXPECT_EQ(place(scene, 1.75).x, linear ? 17.5 : 10.0);
        EXPECT_EQ(place(scene, 2).x, 20.0);
        EXPECT_EQ(place(scene, 3), linear ? glm::dvec3(40, 4, 0) : glm::dvec3(20, 0, 0));
        EXPECT_EQ(place(scene, 99).x, 60.0);                // clamped to the last
        EXPECT_EQ(take_snapshot(scene).bounds.low.x, 0.0);  // the rest pose
    }
}

TEST(Animation, CubicSplineFollowsTheFormula) {
    GltfFile file = point();
    const int times = file.add_accessor(std::vector<float>{0, 2}, "SCALAR");
    // in-tangent, value, out-tangent of each key
    const int values =
        file.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 3, 0, 0, -5, 0, 0, 4, 0, 0, 0, 0, 0}, "VEC3");
    animate(file, 0, "translation", "CUBICSPLINE", times, values);
    const Scene scene = load_glb(file);
    for (const double seconds : {0.0, 0.5, 1.0, 1.9, 2.0}) {
        const double t = seconds / 2.0;
        const double expected = (2 * t * t * t - 3 * t * t + 1) * 1 + 2 * (t * t * t - 2 * t * t + t) * 3 +
                                (-2 * t * t * t + 3 * t * t) * 4 + 2 * (t * t * t - t * t) * -5;
        EXPECT_NEAR(place(scene, seconds).x, expected, 1e-12) << seconds;
    }
}

TEST(Animation, RotationsTakeTheShortWay) {
    GltfFile file = point({1, 0, 0});
    const auto about_z = [](double angle, float sign) {
        return std::vector<float>{0, 0, sign * static_cast<float>(std::sin(angle / 2)),
                                  sign * static_cast<float>(std::cos(angle / 2))};
    };
    std::vector<float> turns = about_z(0.2, 1);
    const auto second = about_z(1.4, -1);  // the same turn as with +1
    turns.insert(turns.end(), second.begin(), second.end());
    const int times = file.add_accessor(std::vector<float>{0, 1}, "SCALAR");
    animate(file, 0, "rotation", "LINEAR", times, file.add_accessor(turns, "VEC4"));
    const Scene scene = load_glb(file);
    for (const double seconds : {0.0, 0.25, 0.5, 1.0}) {
        const glm::dvec3 at = place(scene, seconds);
        EXPECT_NEAR(std::atan2(at.y, at.x), 0.2 + 1.2 * seconds, 1e-6) << seconds;
        EXPECT_NEAR(glm::length(at), 1.0, 1e-12) << seconds;
    }
}

/// A node with a matrix keeps the rest of its transform if an animation moves a part of it.
TEST(Animation, AMatrixIsTakenApart) {
    GltfFile file = point({1, 1, 0});
    file.json["nodes"][0]["matrix"] = {0, 2, 0, 0, 3, 0, 0, 0,
                                       0, 0, 1, 0, 5, 6, 7, 1};  // mirrored, turned, scaled
    const int times = file.add_accessor(std::vector<float>{0}, "SCALAR");
    animate(file, 0, "translation", "STEP", times, file.add_accessor(std::vector<float>{0, 0, 9}, "VEC3"));
    const glm::dvec3 at = place(load_glb(file), 0.0);
    EXPECT_NEAR(at.x, 3.0, 1e-12);
    EXPECT_NEAR(at.y, 2.0, 1e-12);
    EXPECT_NEAR(at.z, 9.0, 1e-12);
}

/// A point with two morph targets, the second one sparse.
GltfFile morphed() {
    GltfFile file = point({1, 0, 0, 0, 1, 0});
    const int first = file.add_accessor(std::vector<float>{10, 0, 0, 0, 0, 0}, "VEC3");
    const int indices = file.add_view(test::bytes_of(std::vector<std::uint8_t>{1}));
    const int values = file.add_view(test::bytes_of(std::vector<float>{0, 0, 4}));
    const int second =
        file.add("accessors", {{"componentType", 5126},
                               {"count", 2},
                               {"type", "VEC3"},
                               {"sparse",
                                {{"count", 1},
                                 {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                 {"values", {{"bufferView", values}}}}}});
    file.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", first}}, {{"POSITION", second}}};
    file.json["meshes"][0]["weights"] = {0.5, 0.0};
    return file;
}

TEST(Morph, WeightsOfTheMeshTheNodeAndTheAnimation) {
    GltfFile file = morphed();
    EXPECT_EQ(take_snapshot(load_glb(file)).bounds.high, glm::dvec3(6, 1, 0));
    file.json["nodes"][0]["weights"] = {0.0, 0.25};
    EXPECT_EQ(take_snapshot(load_glb(file)).bounds.high, glm::dvec3(1, 1, 1));
    const int times = file.add_accessor(std::vector<float>{0, 1}, "SCALAR");
    animate(file, 0, "weights", "LINEAR", times, file.add_accessor(std::vector<float>{0, 1, 2, 1}, "SCALAR"));
    const Scene scene = load_glb(file);
    EXPECT_EQ(take_snapshot(scene, {0.5, 0, std::nullopt}).bounds.high, glm::dvec3(11, 1, 4));
    EXPECT_EQ(take_snapshot(scene).bounds.high, glm::dvec3(1, 1, 1));
}

TEST(Morph, NegativeWeightsPullBackAndInstancesShareTheResult) {
    GltfFile file = morphed();
    file.json["nodes"][0]["weights"] = {-1.0, 0.0};
    const int moves = file.add_accessor(std::vector<float>{0, 0, 0, 0, 0, 50}, "VEC3");
    file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", moves}};
    const Scene scene = load_glb(file);
    const Snapshot snapshot = take_snapshot(scene);
    EXPECT_EQ(snapshot.bounds.low, glm::dvec3(-9, 0, 0));
    EXPECT_EQ(snapshot.bounds.high, glm::dvec3(0, 1, 50));
    EXPECT_EQ(snapshot.deformed.size(), 1U);
    ASSERT_EQ(snapshot.items.size(), 2U);
    EXPECT_EQ(snapshot.items[0].positions.data(), snapshot.items[1].positions.data());
}

/// Three points on two joints: on the first, on the second, and half on each. The mesh's node moves, which
/// must not matter.
GltfFile skinned(const std::vector<float>& weights) {
    GltfFile file = point({1, 0, 0, 1, 0, 0, 1, 0, 0});
    auto& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["NORMAL"] = file.add_accessor(std::vector<float>{1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");
    attributes["JOINTS_0"] =
        file.add_accessor(std::vector<std::uint8_t>{0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4");
    attributes["WEIGHTS_0"] = file.add_accessor(weights, "VEC4");
    const int first = file.add_root({{"translation", {10, 0, 0}}});
    const int second = file.add("nodes", {{"translation", {0, 10, 0}}, {"scale", {2, 2, 2}}});
    file.json["nodes"][static_cast<std::size_t>(first)]["children"] = {second};
    std::vector<float> inverse = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    inverse.insert(inverse.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1});
    file.add("skins",
             {{"joints", {first, second}}, {"inverseBindMatrices", file.add_accessor(inverse, "MAT4")}});
    file.json["nodes"][0]["skin"] = 0;
    file.json["nodes"][0]["translation"] = {1000, 1000, 1000};
    return file;
}

TEST(Skin, JointsMoveTheVerticesAndTheNodeDoesNot) {
    const Scene scene = load_glb(skinned({1, 0, 0, 0, 1, 0, 0, 0, 0.5F, 0.5F, 0, 0}));
    const Snapshot snapshot = take_snapshot(scene);
    ASSERT_EQ(snapshot.items.size(), 1U);
    EXPECT_EQ(snapshot.items[0].world_from_mesh, glm::dmat4(1.0));
    const Item& item = snapshot.items[0];
    ASSERT_EQ(item.vertex_count(), 3U);
    EXPECT_EQ(item.world(0), glm::dvec3(11, 0, 0));
    EXPECT_EQ(item.world(1), glm::dvec3(10, 10, 0));  // (1, 0, 0) is moved to the joint's origin
    EXPECT_EQ(item.world(2), glm::dvec3(10.5, 5, 0));
    EXPECT_EQ(snapshot.items[0].normals[1], glm::vec3(1, 0, 0));
}

TEST(Skin, WeightsAreNormalizedAndBadOnesCountAsZero) {
    const float nan = std::nanf("");
    const Scene scene = load_glb(skinned({3, -1, nan, INFINITY, 0.25F, 0, 0, 0, 7, 7, 0, 0}));
    const auto& skin = scene.meshes.at(0).primitives.at(0).skin;
    EXPECT_EQ(skin[0].weights, glm::vec4(1, 0, 0, 0));
    EXPECT_EQ(skin[1].weights, glm::vec4(1, 0, 0, 0));
    EXPECT_EQ(skin[2].weights, glm::vec4(0.5F, 0.5F, 0, 0));
}

TEST(Skin, TheSumOfWeightsIsExactlyOne) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> weight(0.0F, 1.0F);
    for (int turn = 0; turn < 200; ++turn) {
        std::vector<float> given(12);
        for (float& each : given)
            each = random() % 3 == 0 ? weight(random) * 1e-7F : weight(random);
        const Scene scene = load_glb(skinned(given));
        for (const SkinWeights& vertex : scene.meshes.at(0).primitives.at(0).skin) {
            double sum = 0.0;
            for (int c = 0; c < 4; ++c) {
                EXPECT_GE(vertex.weights[c], 0.0F);
                sum += double(vertex.weights[c]);
            }
            EXPECT_EQ(sum, 1.0);
        }
    }
}

TEST(Skin, FarFromTheOriginVerticesKeepTheirPlaces) {
    GltfFile file = skinned({0.3F, 0.7F, 0, 0, 1.0F / 3, 2.0F / 3, 0, 0, 0.123F, 0.877F, 0, 0});
    // Both joints are the same place, so that the mesh is moved as a whole.
    file.json["nodes"][2] = Json::object();
    file.json["skins"][0].erase("inverseBindMatrices");
    for (const double far : {100.0, 6'378'000.0, 1e9}) {
        file.json["nodes"][1]["translation"] = {far, 0.25, -far};
        const Scene scene = load_glb(file);
        const Snapshot snapshot = take_snapshot(scene);
        for (std::size_t vertex = 0; vertex < 3; ++vertex) {
            const glm::dvec3 difference =
                snapshot.items[0].world(vertex) - (glm::dvec3(1, 0, 0) + glm::dvec3(far, 0.25, -far));
            EXPECT_LE(glm::length(difference), far * 1e-15) << far;
        }
    }
}

TEST(Skin, AVertexWithoutWeightsFollowsTheFirstJoint) {
    const Scene scene = load_glb(skinned(std::vector<float>(12, 0.0F)));
    EXPECT_EQ(take_snapshot(scene).items[0].world(2), glm::dvec3(11, 0, 0));
}

TEST(Skin, FurtherSetsOfInfluencesCount) {
    GltfFile file = skinned({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    auto& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_1"] =
        file.add_accessor(std::vector<std::uint16_t>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    attributes["WEIGHTS_1"] =
        file.add_accessor(std::vector<std::uint8_t>{255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4", true);
    const Scene scene = load_glb(file);
    EXPECT_EQ(take_snapshot(scene).items[0].world(0), glm::dvec3(10.5, 5, 0));
}

TEST(Skin, AnimatedJointsCarryTheMesh) {
    GltfFile file = skinned({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    const int times = file.add_accessor(std::vector<float>{0, 1}, "SCALAR");
    animate(file, 1, "translation", "LINEAR", times,
            file.add_accessor(std::vector<float>{0, 0, 0, 0, 0, 8}, "VEC3"));
    const Scene scene = load_glb(file);
    EXPECT_EQ(take_snapshot(scene, {0.5, 0, std::nullopt}).items[0].world(0), glm::dvec3(1, 0, 4));
}

}  // namespace
}  // namespace cairn::scenes
