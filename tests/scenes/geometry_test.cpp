// Primitives, accessors and materials, with files that the tests write.
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "tests/support/gltf_file.h"
#include "tests/support/scratch_folder.h"

namespace cairn::scenes {
namespace {

using test::Bytes;
using test::GltfFile;
using test::Json;
using test::ScratchFolder;

const std::vector<float> square = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

Scene load_glb(const GltfFile& file) {
    const ScratchFolder folder;
    file.write_glb(folder.file("test.glb"));
    return load(folder.file("test.glb"));
}

const Primitive& first(const Scene& scene) {
    return scene.meshes.at(0).primitives.at(0);
}

std::vector<std::uint32_t> indices_of_mode(int mode, const std::vector<std::uint16_t>& indices) {
    GltfFile file;
    const int positions = file.add_accessor(square, "VEC3");
    file.add_mesh({{"attributes", {{"POSITION", positions}}},
                   {"mode", mode},
                   {"indices", file.add_accessor(indices, "SCALAR")}});
    return first(load_glb(file)).indices;
}

using Indices = std::vector<std::uint32_t>;

TEST(Geometry, ModesBecomeLists) {
    EXPECT_EQ(indices_of_mode(0, {3, 1}), (Indices{3, 1}));
    EXPECT_EQ(indices_of_mode(1, {0, 1, 2, 3, 0}), (Indices{0, 1, 2, 3}));
    EXPECT_EQ(indices_of_mode(2, {0, 1, 2}), (Indices{0, 1, 1, 2, 2, 0}));
    EXPECT_EQ(indices_of_mode(3, {0, 1, 2}), (Indices{0, 1, 1, 2}));
    EXPECT_EQ(indices_of_mode(4, {0, 1, 2, 3, 0}), (Indices{0, 1, 2}));
    EXPECT_EQ(indices_of_mode(5, {0, 1, 3, 2, 0}), (Indices{0, 1, 3, 1, 2, 3, 3, 2, 0}));
    EXPECT_EQ(indices_of_mode(6, {0, 1, 2, 3}), (Indices{0, 1, 2, 0, 2, 3}));
}

TEST(Geometry, TooFewVerticesDrawNothing) {
    for (const int mode : {1, 2, 3, 4, 5, 6}) {
        GltfFile file;
        const int positions = file.add_accessor(std::vector<float>{0, 0, 0}, "VEC3");
        file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"mode", mode}});
        EXPECT_TRUE(take_snapshot(load_glb(file)).items.empty()) << "mode " << mode;
    }
}

template <typename Number>
Indices with_index_type() {
    GltfFile file;
    const int positions = file.add_accessor(square, "VEC3");
    const int indices = file.add_accessor(std::vector<Number>{0, 1, 2, 0, 2, 3}, "SCALAR");
    file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    return first(load_glb(file)).indices;
}

TEST(Geometry, EveryIndexTypeIsRead) {
    const Indices expected = {0, 1, 2, 0, 2, 3};
    EXPECT_EQ(with_index_type<std::uint8_t>(), expected);
    EXPECT_EQ(with_index_type<std::uint16_t>(), expected);
    EXPECT_EQ(with_index_type<std::uint32_t>(), expected);
}

template <typename Number>
void expect_quantized(bool normalized) {
    constexpr auto most = std::numeric_limits<Number>::max();
    constexpr auto least = std::numeric_limits<Number>::min();
    GltfFile file;
    const std::vector<Number> numbers = {most, 0, 1, 0, least, 1, 0, 0, 0, least, 0, most};
    Bytes padded;  // elements begin at multiples of 4 bytes
    for (std::size_t i = 0; i < numbers.size(); i += 3) {
        const Bytes element =
            test::bytes_of(std::vector<Number>(numbers.begin() + static_cast<std::ptrdiff_t>(i),
                                               numbers.begin() + static_cast<std::ptrdiff_t>(i) + 3));
        padded.insert(padded.end(), element.begin(), element.end());
        while (padded.size() % 4 != 0)
            padded.push_back(0xEE);
    }
    const int view = file.add_view(padded, static_cast<int>(padded.size()) / 4);
    file.add("accessors", {{"bufferView", view},
                           {"componentType", test::component_type<Number>()},
                           {"count", 4},
                           {"type", "VEC3"},
                           {"normalized", normalized}});
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    file.add_mesh({{"attributes", {{"POSITION", 0}}}, {"mode", 0}});
    const auto positions = first(load_glb(file)).positions;
    ASSERT_EQ(positions.size(), 4U);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const double expected =
            normalized ? std::max(static_cast<double>(numbers[i]) / most, -1.0) : numbers[i];
        EXPECT_EQ(positions[i / 3][static_cast<int>(i % 3)], static_cast<float>(expected)) << i;
    }
}

TEST(Geometry, QuantizedPositionsOfEveryTypeAreRead) {
    for (const bool normalized : {false, true}) {
        expect_quantized<std::int8_t>(normalized);
        expect_quantized<std::uint8_t>(normalized);
        expect_quantized<std::int16_t>(normalized);
        expect_quantized<std::uint16_t>(normalized);
    }
}

TEST(Geometry, InterleavedAttributesAreTakenApart) {
    GltfFile file;
    std::vector<float> mixed;
    for (std::size_t v = 0; v < 4; ++v) {
        for (std::size_t c = 0; c < 3; ++c)
            mixed.push_back(square[3 * v + c]);
        for (const float n : {0.0F, 0.0F, 1.0F})
            mixed.push_back(n);
    }
    const int view = file.add_view(test::bytes_of(mixed), 24);
    for (const int offset : {0, 12})
        file.add("accessors", {{"bufferView", view},
                               {"byteOffset", offset},
                               {"componentType", 5126},
                               {"count", 4},
                               {"type", "VEC3"}});
    file.add_mesh({{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}, {"mode", 5}});
    const Scene scene = load_glb(file);
    EXPECT_EQ(first(scene).positions[2], glm::vec3(1, 1, 0));
    EXPECT_EQ(first(scene).normals[3], glm::vec3(0, 0, 1));
}

/// Sparse values over given elements, and over none (which stand for zeros).
TEST(Geometry, SparseAccessorsOverwrite) {
    for (const bool over_zeros : {false, true}) {
        GltfFile file;
        const int accessor = file.add_accessor(square, "VEC3");
        const int indices = file.add_view(test::bytes_of(std::vector<std::uint16_t>{1, 3}));
        const int values = file.add_view(test::bytes_of(std::vector<float>{5, 6, 7, 8, 9, 10}));
        Json& json = file.json["accessors"][static_cast<std::size_t>(accessor)];
        json["sparse"] = {{"count", 2},
                          {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                          {"values", {{"bufferView", values}}}};
        if (over_zeros) json.erase("bufferView");
        file.add_mesh({{"attributes", {{"POSITION", accessor}}}, {"mode", 0}});
        const auto positions = first(load_glb(file)).positions;
        EXPECT_EQ(positions[1], glm::vec3(5, 6, 7));
        EXPECT_EQ(positions[3], glm::vec3(8, 9, 10));
        EXPECT_EQ(positions[2], over_zeros ? glm::vec3(0) : glm::vec3(1, 1, 0));
    }
}

/// A big set of vertices that many primitives share is not copied for each of them.
TEST(Geometry, APrimitiveKeepsOnlyTheVerticesItUses) {
    GltfFile file;
    std::vector<float> many;
    for (int i = 0; i < 3000; ++i)
        many.push_back(static_cast<float>(i));
    const int positions = file.add_accessor(many, "VEC3");
    const int indices = file.add_accessor(std::vector<std::uint16_t>{900, 7, 500, 7, 500, 8}, "SCALAR");
    file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    const Scene scene = load_glb(file);
    EXPECT_EQ(first(scene).positions.size(), 4U);
    EXPECT_EQ(first(scene).positions[first(scene).indices[0]], glm::vec3(2700, 2701, 2702));
    EXPECT_EQ(first(scene).positions[first(scene).indices[5]], glm::vec3(24, 25, 26));
    EXPECT_EQ(take_snapshot(scene).bounds.high, glm::dvec3(2700, 2701, 2702));
}

TEST(Geometry, BoundsLeaveOutVerticesThatNothingUses) {
    GltfFile file;
    const int positions =
        file.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 99, 99, 99}, "VEC3");
    const int indices = file.add_accessor(std::vector<std::uint8_t>{0, 1, 2}, "SCALAR");
    file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    EXPECT_EQ(take_snapshot(load_glb(file)).bounds.high, glm::dvec3(1, 1, 0));
}

TEST(Geometry, VertexColorsOfEveryTypeKeepSixteenBits) {
    GltfFile file;
    const int positions = file.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0}, "VEC3");
    const int floats = file.add_accessor(std::vector<float>{0, 0.5F, 2, -1, 1, std::nanf("")}, "VEC3");
    const int shorts =
        file.add_accessor(std::vector<std::uint16_t>{0, 32768, 65535, 65535, 1, 2, 3, 0}, "VEC4", true);
    const int bytes =
        file.add_accessor(std::vector<std::uint8_t>{0, 1, 254, 255, 128, 2, 3, 0}, "VEC4", true);
    for (const int colors : {floats, shorts, bytes})
        file.add_mesh({{"attributes", {{"POSITION", positions}, {"COLOR_0", colors}}}, {"mode", 0}});
    const Scene scene = load_glb(file);
    EXPECT_EQ(first(scene).colors[0], glm::u16vec4(0, 32768, 65535, 65535));
    EXPECT_EQ(first(scene).colors[1], glm::u16vec4(0, 65535, 0, 65535));
    EXPECT_EQ(scene.meshes[1].primitives[0].colors[0], glm::u16vec4(0, 32768, 65535, 65535));
    EXPECT_EQ(scene.meshes[1].primitives[0].colors[1], glm::u16vec4(1, 2, 3, 0));
    EXPECT_EQ(scene.meshes[2].primitives[0].colors[0], glm::u16vec4(0, 257, 254 * 257, 65535));
    EXPECT_EQ(scene.meshes[2].primitives[0].colors[1], glm::u16vec4(128 * 257, 2 * 257, 3 * 257, 0));
}

/// A textured square, whose material a test can change.
GltfFile textured(const Json& texture_info) {
    GltfFile file;
    const int positions = file.add_accessor(square, "VEC3");
    const int uv0 = file.add_accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, "VEC2");
    const int uv1 = file.add_accessor(std::vector<std::uint8_t>{0, 0, 51, 0, 51, 51, 0, 51}, "VEC2", true);
    const Bytes png = test::PngWriter::make(2, 1, 8, {0, 255, 0, 0, 255, 0, 0, 255, 128});
    file.add("images", {{"bufferView", file.add_view(png)}, {"mimeType", "image/png"}});
    file.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}});
    file.add("textures", {{"source", 0}, {"sampler", 0}});
    file.add("materials", {{"pbrMetallicRoughness",
                            {{"baseColorFactor", {0.5, 1, 1, 1}}, {"baseColorTexture", texture_info}}},
                           {"alphaMode", "MASK"},
                           {"alphaCutoff", 0.25},
                           {"doubleSided", true}});
    file.add_mesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uv0}, {"TEXCOORD_1", uv1}}},
                   {"material", 0},
                   {"mode", 6}});
    return file;
}

TEST(Materials, BaseColorTextureWithItsSampler) {
    const Scene scene = load_glb(textured({{"index", 0}}));
    const Material& material = scene.materials.at(0);
    EXPECT_EQ(material.base_color, glm::vec4(0.5F, 1, 1, 1));
    EXPECT_EQ(material.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(material.alpha_cutoff, 0.25F);
    EXPECT_TRUE(material.double_sided);
    const Texture& texture = scene.textures.at(static_cast<std::size_t>(material.texture));
    EXPECT_EQ(texture.wrap_s, Wrap::clamp_to_edge);
    EXPECT_EQ(texture.wrap_t, Wrap::mirrored_repeat);
    const Image& image = scene.images.at(static_cast<std::size_t>(texture.image));
    EXPECT_EQ(image.width, 2);
    EXPECT_EQ(image.rgba, (Bytes{255, 0, 0, 255, 0, 0, 255, 128}));
    EXPECT_EQ(first(scene).texcoords[2], glm::vec2(1, 1));
    EXPECT_EQ(material.uv_from_mesh, glm::mat3(1.0F));
}

TEST(Materials, TextureTransformOverridesTheTexCoordSet) {
    const double quarter = std::numbers::pi / 2.0;
    const Json transform = {
        {"offset", {0.5, 0.25}}, {"rotation", quarter}, {"scale", {2, 3}}, {"texCoord", 1}};
    const Scene scene =
        load_glb(textured({{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}));
    EXPECT_FLOAT_EQ(first(scene).texcoords[1].x, 0.2F);  // of set 1
    // Scaled to (2, 0); turned counter-clockwise, with v downwards, to (0, -2); moved.
    const glm::vec3 uv = scene.materials.at(0).uv_from_mesh * glm::vec3(1, 0, 1);
    EXPECT_NEAR(uv.x, 0.5F, 1e-6F);
    EXPECT_NEAR(uv.y, -1.75F, 1e-6F);
}

TEST(Materials, ImagesThatNoBaseColorUsesAreNotRead) {
    GltfFile file = textured({{"index", 0}});
    file.add("images", {{"uri", "missing.ktx2"}});
    file.add("textures", {{"source", 1}});
    file.json["materials"][0]["normalTexture"] = {{"index", 1}};
    const Scene scene = load_glb(file);
    EXPECT_EQ(scene.images.size(), 1U);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(Materials, SixteenBitImagesAreReduced) {
    GltfFile file = textured({{"index", 0}});
    const Bytes png = test::PngWriter::make(1, 1, 16, {0, 0x80, 0x12, 0xFF, 0xFF, 0, 0, 0xFF, 0xFF});
    file.json["images"][0]["bufferView"] = file.add_view(png);
    EXPECT_EQ(load_glb(file).images.at(0).rgba, (Bytes{0x80, 0xFF, 0, 0xFF}));
}

TEST(Materials, SpecularGlossinessGivesTheBaseColor) {
    GltfFile file = textured({{"index", 0}});
    file.json["extensionsRequired"] = {"KHR_materials_pbrSpecularGlossiness"};
    file.json["materials"][0]["extensions"] = {
        {"KHR_materials_pbrSpecularGlossiness",
         {{"diffuseFactor", {0.1, 0.2, 0.3, 0.4}}, {"diffuseTexture", {{"index", 0}}}}}};
    const Scene scene = load_glb(file);
    EXPECT_EQ(scene.materials[0].base_color, glm::vec4(0.1F, 0.2F, 0.3F, 0.4F));
    EXPECT_EQ(scene.materials[0].texture, 0);
}

TEST(Materials, NormalsAndTexcoordsThatAreNotFiniteAreMendedWithAWarning) {
    GltfFile file = textured({{"index", 0}});
    const float nan = std::nanf("");
    file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        file.add_accessor(std::vector<float>{0, nan, 1, 0, 1, 1, 0, 1}, "VEC2");
    const Scene scene = load_glb(file);
    EXPECT_EQ(first(scene).texcoords[0], glm::vec2(0));
    EXPECT_EQ(scene.warnings.size(), 1U);
}

}  // namespace
}  // namespace cairn::scenes
