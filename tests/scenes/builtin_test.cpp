#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "base/error.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "scenes/write_glb.h"
#include "tests/support/scratch_folder.h"

namespace cairn::scenes {
namespace {

using test::ScratchFolder;

std::vector<std::string> all_names() {
    std::vector<std::string> names;
    for (const Builtin& builtin : builtins()) {
        names.emplace_back(builtin.name);
    }
    return names;
}

/// FNV-1a over the bytes of the elements.
template <class Element>
std::uint64_t hash_of(const std::vector<Element>& elements, std::uint64_t hash = 0xCBF29CE484222325U) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(elements.data());
    for (std::size_t i = 0; i < elements.size() * sizeof(Element); ++i) {
        hash = (hash ^ bytes[i]) * 0x100000001B3U;
    }
    return hash;
}

std::uint64_t hash_of(const Scene& scene) {
    std::uint64_t hash = 0xCBF29CE484222325U;
    for (const Mesh& mesh : scene.meshes) {
        for (const Primitive& primitive : mesh.primitives) {
            hash = hash_of(primitive.indices, hash);
            hash = hash_of(primitive.positions, hash);
            hash = hash_of(primitive.normals, hash);
            hash = hash_of(primitive.texcoords, hash);
            hash = hash_of(primitive.colors, hash);
        }
    }
    for (const Image& image : scene.images) {
        hash = hash_of(image.rgba, hash);
    }
    return hash;
}

class EveryBuiltin : public testing::TestWithParam<std::string> {
protected:
    Scene scene_ = make_builtin(GetParam());
    template <class Check>
    void for_each_primitive(const Check& check) const {
        for (const Mesh& mesh : scene_.meshes) {
            for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
                check(mesh.primitives[i], "mesh \"" + mesh.name + "\", primitive " + std::to_string(i));
            }
        }
    }
};
INSTANTIATE_TEST_SUITE_P(Scenes, EveryBuiltin, testing::ValuesIn(all_names()), [](const auto& test) {
    std::string name = test.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

TEST_P(EveryBuiltin, HasOneEntryAVertexAndIndicesInRange) {
    for_each_primitive([](const Primitive& primitive, const std::string& where) {
        const std::size_t count = primitive.positions.size();
        EXPECT_EQ(primitive.indices.size() % 3, 0U) << where;
        EXPECT_LT(*std::max_element(primitive.indices.begin(), primitive.indices.end()), count) << where;
        for (const std::size_t size :
             {primitive.normals.size(), primitive.texcoords.size(), primitive.colors.size()}) {
            EXPECT_TRUE(size == 0 || size == count)
                << where << ": " << size << " entries, " << count << " vertices";
        }
    });
}

TEST_P(EveryBuiltin, HasUnitNormalsOnTheSideThatTrianglesFace) {
    for_each_primitive([](const Primitive& primitive, const std::string& where) {
        if (primitive.normals.empty()) return;
        for (std::size_t i = 0; i < primitive.normals.size(); ++i) {
            ASSERT_NEAR(glm::length(primitive.normals[i]), 1.0F, 1e-5F) << where << ", vertex " << i;
        }
        for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
            const std::uint32_t* corner = &primitive.indices[i];
            const glm::vec3 first = primitive.positions[corner[0]];
            const glm::vec3 face =
                glm::cross(primitive.positions[corner[1]] - first, primitive.positions[corner[2]] - first);
            const glm::vec3 normal =
                primitive.normals[corner[0]] + primitive.normals[corner[1]] + primitive.normals[corner[2]];
            ASSERT_GT(glm::dot(face, normal), 0.0F) << where << ", triangle " << i / 3;
        }
    });
}

TEST_P(EveryBuiltin, HasNoTriangleWithoutArea) {
    for_each_primitive([](const Primitive& primitive, const std::string& where) {
        for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
            const std::uint32_t* corner = &primitive.indices[i];
            const glm::dvec3 first(primitive.positions[corner[0]]);
            const glm::dvec3 face = glm::cross(glm::dvec3(primitive.positions[corner[1]]) - first,
                                               glm::dvec3(primitive.positions[corner[2]]) - first);
            ASSERT_GT(glm::length(face), 0.0) << where << ", triangle " << i / 3;
        }
    });
}

TEST_P(EveryBuiltin, IsAFewMetresWideAndCentred) {
    const Bounds bounds = take_snapshot(scene_).bounds;
    const glm::dvec3 size = bounds.high - bounds.low;
    const double longest = std::max({size.x, size.y, size.z});
    EXPECT_GT(longest, 1.0);
    EXPECT_LT(longest, 10.0);
    EXPECT_LT(glm::length(bounds.low + bounds.high) / 2.0, 0.25 * longest);
}

TEST_P(EveryBuiltin, IsTheSameEveryTime) {
    EXPECT_EQ(hash_of(scene_), hash_of(make_builtin(GetParam())));
}

TEST_P(EveryBuiltin, HasTheNameThatItWasAskedBy) {
    EXPECT_EQ(scene_.name, "builtin:" + GetParam());
}

TEST_P(EveryBuiltin, ComesBackFromAFileUnchanged) {
    const ScratchFolder folder;
    write_glb(scene_, folder.file("scene.glb"));
    const Scene back = load(folder.file("scene.glb"));
    EXPECT_EQ(hash_of(back), hash_of(scene_));
    EXPECT_TRUE(back.warnings.empty()) << back.warnings.front().text;

    const Snapshot here = take_snapshot(scene_);
    const Snapshot there = take_snapshot(back);
    EXPECT_EQ(there.triangle_count, here.triangle_count);
    EXPECT_EQ(there.bounds.low, here.bounds.low);
    EXPECT_EQ(there.bounds.high, here.bounds.high);
    ASSERT_EQ(there.items.size(), here.items.size());
    for (std::size_t i = 0; i < here.items.size(); ++i) {
        EXPECT_EQ(there.items[i].world_from_mesh, here.items[i].world_from_mesh) << "item " << i;
        EXPECT_EQ(there.items[i].primitive->material, here.items[i].primitive->material) << "item " << i;
    }
    ASSERT_EQ(there.lights.size(), here.lights.size());
    ASSERT_EQ(there.cameras.size(), here.cameras.size());
    for (std::size_t i = 0; i < here.cameras.size(); ++i) {
        EXPECT_EQ(there.cameras[i].camera.yfov, here.cameras[i].camera.yfov);
        EXPECT_EQ(there.cameras[i].world_from_camera, here.cameras[i].world_from_camera);
    }
    ASSERT_EQ(back.materials.size(), scene_.materials.size());
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
        EXPECT_EQ(back.materials[i].base_color, scene_.materials[i].base_color) << scene_.materials[i].name;
        EXPECT_EQ(back.materials[i].alpha_mode, scene_.materials[i].alpha_mode) << scene_.materials[i].name;
        EXPECT_EQ(back.materials[i].double_sided, scene_.materials[i].double_sided)
            << scene_.materials[i].name;
    }
}

std::uint64_t triangle_count(const char* name) {
    const Scene scene = make_builtin(name);
    return take_snapshot(scene).triangle_count;
}

TEST(Builtin, TriangleCountsAreThoseOfTheirDescriptions) {
    EXPECT_EQ(triangle_count("knot"), 52992U);
    EXPECT_EQ(triangle_count("spheres"), 6848U);
    EXPECT_NEAR(static_cast<double>(triangle_count("tree")), 607608.0, 15000.0);
    EXPECT_EQ(triangle_count("cornell"), 32U);
    EXPECT_EQ(triangle_count("needles"), 3000U);
}

/// Every edge belongs to two triangles that run along it in opposite directions.
void expect_closed(const Mesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const Primitive& primitive : mesh.primitives) {
        ASSERT_EQ(mesh.primitives.size(), 1U) << "edges are found by index, which primitives do not share";
        for (std::size_t i = 0; i < primitive.indices.size(); ++i) {
            const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
            ++uses[{primitive.indices[i], primitive.indices[next]}];
        }
    }
    for (const auto& [edge, count] : uses) {
        const auto opposite = uses.find({edge.second, edge.first});
        ASSERT_EQ(count, 1) << mesh.name << ": edge " << edge.first << " to " << edge.second;
        ASSERT_NE(opposite, uses.end()) << mesh.name << ": edge " << edge.first << " to " << edge.second;
    }
}

TEST(Builtin, KnotAndSpheresAreClosed) {
    for (const char* name : {"knot", "spheres"}) {
        const Scene scene = make_builtin(name);
        for (const Mesh& mesh : scene.meshes) {
            expect_closed(mesh);
        }
    }
}

TEST(Builtin, SpheresShareTheirMeshes) {
    const Scene scene = make_builtin("spheres");
    EXPECT_EQ(scene.meshes.size(), 10U);
    EXPECT_EQ(take_snapshot(scene).items.size(), 81U);
}

TEST(Builtin, TreeStandsOnTheSameBranchesWithEitherLeaves) {
    const Scene modelled = make_builtin("tree");
    const Scene cards = make_builtin("tree-leaves");
    const Primitive& bark = modelled.meshes[0].primitives[0];
    const Primitive& same_bark = cards.meshes[0].primitives[0];
    EXPECT_EQ(hash_of(bark.positions), hash_of(same_bark.positions));
    EXPECT_EQ(cards.materials[1].alpha_mode, AlphaMode::mask);
    EXPECT_EQ(modelled.meshes[0].primitives[1].element_count() / 8,
              cards.meshes[0].primitives[1].element_count() / 2);
}

TEST(Builtin, LeafTextureHasBothLeafAndHoles) {
    const Scene scene = make_builtin("tree-leaves");
    const Image& image = scene.images.at(0);
    std::size_t kept = 0;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
        kept += image.rgba[i] >= 128 ? 1 : 0;
    }
    const double share = static_cast<double>(kept) / (image.width * image.height);
    EXPECT_GT(share, 0.3);
    EXPECT_LT(share, 0.8);
}

TEST(Builtin, UnknownNameIsAnErrorThatListsTheNames) {
    try {
        static_cast<void>(make_builtin("teapot"));
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::usage);
        EXPECT_NE(std::string(error.what()).find("teapot"), std::string::npos) << error.what();
        EXPECT_NE(error.way_out().find("knot, spheres, tree"), std::string::npos) << error.way_out();
    }
}

/// A scene with everything that write_glb() writes and that no built-in scene has.
Scene make_medley() {
    Scene scene = make_builtin("tree-leaves");
    scene.meshes[0].primitives.resize(1);
    scene.meshes[0].primitives[0].positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {-1, 0.1F, 1e-30F}};
    scene.meshes[0].primitives[0].normals.clear();
    scene.meshes[0].primitives[0].indices = {0, 1, 2, 2, 1, 3};
    Mesh thin;
    thin.name = "thin \xFF";  // not UTF-8
    thin.primitives.resize(3);
    for (Primitive& primitive : thin.primitives) {
        primitive.positions = {{0, 0, 0}, {1, 1, 1}};
        primitive.indices = {0, 1};
    }
    thin.primitives[0].topology = Topology::points;
    thin.primitives[0].material = 1;
    thin.primitives[1].topology = Topology::lines;
    thin.primitives[2].indices.clear();  // draws nothing
    scene.meshes.push_back(std::move(thin));
    scene.meshes.emplace_back().name = "empty";

    Node placed;
    placed.mesh = 1;
    placed.matrix = std::make_unique<glm::dmat4>(1.0);
    (*placed.matrix)[0][0] = -2.5;
    (*placed.matrix)[3] = {1.0, 0.1, 1e6, 1.0};
    scene.nodes.push_back(std::move(placed));
    Node instanced;
    instanced.mesh = 0;
    instanced.trs.scale = {1.0, -0.3, 2.0};
    instanced.trs.rotation = glm::angleAxis(0.7, glm::dvec3(0.0, 0.0, 1.0));
    instanced.instances.resize(3);
    instanced.instances[1].translation = {0.5, 0.25, -8.0};
    instanced.instances[2].rotation = {0.0, 1.0, 0.0, 0.0};
    scene.nodes.push_back(std::move(instanced));
    Node hollow;
    hollow.mesh = 2;
    scene.nodes.push_back(std::move(hollow));
    Node hidden;
    hidden.mesh = 0;
    hidden.visible = false;
    scene.nodes.push_back(std::move(hidden));
    for (int node = 1; node < 5; ++node) {
        scene.scenes[0].nodes.push_back(node);
    }
    scene.materials[1].alpha_cutoff = 0.25F;
    scene.materials[0].alpha_mode = AlphaMode::blend;
    return scene;
}

TEST(WriteGlb, KeepsPointsLinesMatricesAndInstances) {
    const Scene scene = make_medley();
    const ScratchFolder folder;
    write_glb(scene, folder.file("medley.glb"));
    const Scene back = load(folder.file("medley.glb"));
    const Snapshot here = take_snapshot(scene);
    const Snapshot there = take_snapshot(back);
    EXPECT_EQ(there.triangle_count, here.triangle_count);
    EXPECT_EQ(there.triangle_count, 8U);
    EXPECT_EQ(there.line_count, 1U);
    EXPECT_EQ(there.point_count, 2U);
    EXPECT_EQ(there.bounds.low, here.bounds.low);
    EXPECT_EQ(there.bounds.high, here.bounds.high);
    EXPECT_FALSE(back.nodes.at(4).visible);
    EXPECT_EQ(back.materials[0].alpha_mode, AlphaMode::blend);
    EXPECT_EQ(back.materials[1].alpha_cutoff, 0.25F);
    ASSERT_EQ(back.textures.size(), 1U);
    EXPECT_EQ(back.textures[0].wrap_s, Wrap::clamp_to_edge);
    EXPECT_EQ(back.images.at(0).rgba, scene.images[0].rgba);
}

TEST(WriteGlb, LengthsInTheFileAreThoseOfTheFile) {
    const ScratchFolder folder;
    for (const std::string& name : all_names()) {
        write_glb(make_builtin(name), folder.file("scene.glb"));
        const std::string file = test::read_text(folder.file("scene.glb"));
        const auto word = [&](std::size_t offset) {
            std::uint32_t value = 0;
            std::memcpy(&value, file.data() + offset, sizeof value);
            return value;
        };
        EXPECT_EQ(file.substr(0, 4), "glTF") << name;
        EXPECT_EQ(word(4), 2U) << name;
        EXPECT_EQ(word(8), file.size()) << name;
        EXPECT_EQ(word(12) % 4, 0U) << name;
        EXPECT_EQ(20 + word(12) + 8 + word(20 + word(12)), file.size()) << name;
    }
}

TEST(WriteGlb, AppliesTheTextureTransform) {
    Scene scene = make_builtin("tree-leaves");
    Primitive& leaf = scene.meshes[0].primitives[1];
    leaf.indices = {0, 1, 2};
    scene.meshes[0].primitives.erase(scene.meshes[0].primitives.begin());
    scene.materials[1].uv_from_mesh = glm::mat3(2, 0, 0, 0, 0.5F, 0, 0.25F, 0.75F, 1);
    const ScratchFolder folder;
    write_glb(scene, folder.file("scene.glb"));
    const Scene back = load(folder.file("scene.glb"));
    const glm::vec2 before = scene.meshes[0].primitives[0].texcoords[1];
    EXPECT_EQ(back.meshes[0].primitives[0].texcoords[1],
              glm::vec2(2, 0.5F) * before + glm::vec2(0.25F, 0.75F));
    EXPECT_EQ(back.materials[1].uv_from_mesh, glm::mat3(1.0F));
}

TEST(WriteGlb, FaultLeavesWhatStoodThere) {
    const ScratchFolder folder;
    write_glb(make_builtin("cornell"), folder.file("scene.glb"));
    const auto size = std::filesystem::file_size(folder.file("scene.glb"));
    Scene broken = make_builtin("knot");
    broken.meshes[0].primitives[0].positions[7].y = std::nanf("");
    EXPECT_THROW(write_glb(broken, folder.file("scene.glb")), Error);
    EXPECT_EQ(std::filesystem::file_size(folder.file("scene.glb")), size);
    EXPECT_THROW(write_glb(make_builtin("knot"), folder.path() / "missing" / "scene.glb"), Error);
}

}  // namespace
}  // namespace cairn::scenes
