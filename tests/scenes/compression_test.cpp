// Draco and meshopt, with streams that the tests encode.
#include <cmath>
#include <memory>
#include <string>

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include "base/error.h"
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

Scene load_glb(const GltfFile& file) {
    const ScratchFolder folder;
    file.write_glb(folder.file("test.glb"));
    return load(folder.file("test.glb"));
}

/// Two triangles, uncompressed positions and 8-bit colours, by either of Draco's two methods.
GltfFile with_draco(draco::MeshEncoderMethod method, bool metadata = false) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2);
    const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int colors = builder.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8);
    const float p[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.25F}, {0, 1, 0}};
    const std::uint8_t c[4][4] = {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {9, 8, 7, 6}};
    const int faces[2][3] = {{0, 1, 2}, {0, 2, 3}};
    for (int f = 0; f < 2; ++f) {
        const int* face = faces[f];
        builder.SetAttributeValuesForFace(positions, draco::FaceIndex(static_cast<std::uint32_t>(f)),
                                          p[face[0]], p[face[1]], p[face[2]]);
        builder.SetAttributeValuesForFace(colors, draco::FaceIndex(static_cast<std::uint32_t>(f)), c[face[0]],
                                          c[face[1]], c[face[2]]);
    }
    const auto mesh = builder.Finalize();
    if (metadata) {
        auto names = std::make_unique<draco::GeometryMetadata>();
        names->AddEntryString("name", "ear");
        names->AddSubMetadata("part", std::make_unique<draco::Metadata>());
        auto of_colors = std::make_unique<draco::AttributeMetadata>();
        of_colors->AddEntryInt("kind", 7);
        mesh->AddMetadata(std::move(names));
        mesh->AddAttributeMetadata(colors, std::move(of_colors));
    }
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());

    GltfFile file;
    const int view = file.add_view(Bytes(buffer.data(), buffer.data() + buffer.size()));
    file.add("accessors", {{"componentType", 5125}, {"count", 6}, {"type", "SCALAR"}});
    file.add("accessors", {{"componentType", 5126}, {"count", mesh->num_points()}, {"type", "VEC3"}});
    file.add(
        "accessors",
        {{"componentType", 5121}, {"count", mesh->num_points()}, {"type", "VEC4"}, {"normalized", true}});
    const Json packed = {{"bufferView", view},
                         {"attributes",
                          {{"POSITION", mesh->attribute(positions)->unique_id()},
                           {"COLOR_0", mesh->attribute(colors)->unique_id()}}}};
    file.add_mesh({{"indices", 0},
                   {"attributes", {{"POSITION", 1}, {"COLOR_0", 2}}},
                   {"extensions", {{"KHR_draco_mesh_compression", packed}}}});
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return file;
}

void expect_the_square(const GltfFile& file) {
    const Scene scene = load_glb(file);
    const Primitive& primitive = scene.meshes.at(0).primitives.at(0);
    ASSERT_EQ(primitive.element_count(), 2U);
    bool found = false;
    for (const std::uint32_t index : primitive.indices)
        if (primitive.positions[index] == glm::vec3(1, 1, 0.25F)) {
            found = true;
            EXPECT_EQ(primitive.colors[index], glm::u16vec4(0, 0, 65535, 65535));
        }
    EXPECT_TRUE(found);
}

TEST(Draco, BothMethodsGiveTheMesh) {
    expect_the_square(with_draco(draco::MESH_SEQUENTIAL_ENCODING));
    expect_the_square(with_draco(draco::MESH_EDGEBREAKER_ENCODING));
}

TEST(Draco, MetadataIsPassedOver) {
    expect_the_square(with_draco(draco::MESH_SEQUENTIAL_ENCODING, true));
    expect_the_square(with_draco(draco::MESH_EDGEBREAKER_ENCODING, true));
}

void expect_refused(const GltfFile& file, const std::string& part) {
    try {
        (void)load_glb(file);
        ADD_FAILURE() << "loaded, though: " << part;
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::input);
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

TEST(Draco, CountsThatContradictTheAccessorsAreRefused) {
    GltfFile file = with_draco(draco::MESH_EDGEBREAKER_ENCODING);
    file.json["accessors"][1]["count"] = 5000;
    expect_refused(file, "the stream has 4 vertices");
    file = with_draco(draco::MESH_EDGEBREAKER_ENCODING);
    file.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]
             ["COLOR_0"] = 77;
    expect_refused(file, "no attribute of id 77");
}

TEST(Draco, AnAbsurdCountInTheStreamIsRefusedBeforeItIsAllocated) {
    GltfFile file = with_draco(draco::MESH_SEQUENTIAL_ENCODING);
    // The number of faces follows 11 bytes of header: make it a varint of 2^31.
    for (const std::size_t at : {11U, 12U, 13U, 14U})
        file.binary[at] = 0x80;
    file.binary[15] = 0x08;
    expect_refused(file, "more than a file of this size can mean");
}

/// Each byte of a stream is broken in turn: that gives an error or a mesh, and nothing else.
TEST(Draco, DamagedStreamsAreRefusedOrRead) {
    for (const auto method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        const GltfFile good = with_draco(method);
        for (std::size_t at = 0; at < good.binary.size(); ++at)
            for (const std::uint8_t flip : {0x01, 0x80, 0xFF}) {
                GltfFile file = good;
                file.binary[at] ^= flip;
                try {
                    (void)load_glb(file);
                } catch (const Error& error) {
                    EXPECT_EQ(error.fault(), Fault::input) << error.what();
                }
            }
    }
}

Json meshopt_extension(int offset, std::size_t length, int stride, int count, const char* mode,
                       const char* filter) {
    return {{"EXT_meshopt_compression",
             {{"buffer", 0},
              {"byteOffset", offset},
              {"byteLength", length},
              {"byteStride", stride},
              {"count", count},
              {"mode", mode},
              {"filter", filter}}}};
}

/// A strip of quads in two compressed views, whose own buffer is a fallback that holds nothing.
GltfFile with_meshopt() {
    constexpr int vertex_count = 64;
    std::vector<float> positions;
    for (int i = 0; i < vertex_count; ++i)
        positions.insert(positions.end(), {static_cast<float>(i / 2), static_cast<float>(i % 2), 0.5F});
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i + 2 < vertex_count; ++i)
        indices.insert(indices.end(), {i, i + 1, i + 2});
    Bytes packed_positions(meshopt_encodeVertexBufferBound(vertex_count, 12));
    packed_positions.resize(meshopt_encodeVertexBuffer(packed_positions.data(), packed_positions.size(),
                                                       positions.data(), vertex_count, 12));
    Bytes packed_indices(meshopt_encodeIndexBufferBound(indices.size(), vertex_count));
    packed_indices.resize(meshopt_encodeIndexBuffer(packed_indices.data(), packed_indices.size(),
                                                    indices.data(), indices.size()));

    GltfFile file;
    const auto index_count = static_cast<int>(indices.size());
    file.binary = packed_positions;
    while (file.binary.size() % 4 != 0)
        file.binary.push_back(0);
    const auto offset = static_cast<int>(file.binary.size());
    file.binary.insert(file.binary.end(), packed_indices.begin(), packed_indices.end());
    file.add("bufferViews", {{"buffer", 1},
                             {"byteLength", vertex_count * 12},
                             {"byteStride", 12},
                             {"extensions", meshopt_extension(0, packed_positions.size(), 12, vertex_count,
                                                              "ATTRIBUTES", "NONE")}});
    file.add("bufferViews", {{"buffer", 1},
                             {"byteLength", index_count * 4},
                             {"extensions", meshopt_extension(offset, packed_indices.size(), 4, index_count,
                                                              "TRIANGLES", "NONE")}});
    file.add("accessors",
             {{"bufferView", 0}, {"componentType", 5126}, {"count", vertex_count}, {"type", "VEC3"}});
    file.add("accessors",
             {{"bufferView", 1}, {"componentType", 5125}, {"count", index_count}, {"type", "SCALAR"}});
    file.json["buffers"] = {
        {{"byteLength", file.binary.size()}},
        {{"byteLength", 100'000}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"EXT_meshopt_compression"};
    file.add_mesh({{"indices", 1}, {"attributes", {{"POSITION", 0}}}});
    return file;
}

TEST(Meshopt, ViewsAreUnpackedAndTheFallbackIsNotTouched) {
    const Scene scene = load_glb(with_meshopt());
    const Snapshot snapshot = take_snapshot(scene);
    EXPECT_EQ(snapshot.triangle_count, 62U);
    EXPECT_EQ(snapshot.bounds.low, glm::dvec3(0, 0, 0.5));
    EXPECT_EQ(snapshot.bounds.high, glm::dvec3(31, 1, 0.5));
}

TEST(Meshopt, IsReadByItsKhronosNameToo) {
    GltfFile file = with_meshopt();
    std::string text = file.json.dump();
    for (std::size_t at = text.find("EXT_meshopt"); at != std::string::npos; at = text.find("EXT_meshopt"))
        text.replace(at, 3, "KHR");
    file.json = Json::parse(text);
    const Primitive renamed = load_glb(file).meshes.at(0).primitives.at(0);
    const Primitive usual = load_glb(with_meshopt()).meshes.at(0).primitives.at(0);
    EXPECT_EQ(renamed.positions, usual.positions);
    EXPECT_EQ(renamed.indices, usual.indices);
    EXPECT_FALSE(renamed.indices.empty());
}

TEST(Meshopt, RulesOfTheExtensionAreChecked) {
    const auto with = [](const char* key, const Json& value) {
        GltfFile file = with_meshopt();
        file.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = value;
        return file;
    };
    expect_refused(with("mode", "SQUARES"), "SQUARES");
    expect_refused(with("filter", "OCTAHEDRAL"), "OCTAHEDRAL");
    expect_refused(with("byteStride", 13), "13");
    expect_refused(with("count", 2'000'000'000), "more than a file of this size can mean");
    expect_refused(with("count", 63), "unpacks to 63 elements");
    expect_refused(with("byteLength", 20), "broken");
    expect_refused(with("byteOffset", 1 << 30), "buffer 0 holds");
}

/// Quaternions, octahedral normals and exponential positions, each through its filter.
TEST(Meshopt, FiltersAreUndone) {
    constexpr int count = 16;
    std::vector<float> source;
    for (int i = 0; i < count; ++i)
        source.insert(source.end(), {0.25F * static_cast<float>(i), -3.5F, 100.0F});
    std::vector<std::uint32_t> filtered(count * 3);
    for (std::size_t i = 0; i < source.size(); ++i)  // mantissa times 2^-8
        filtered[i] = 0xF8000000U |
                      (static_cast<std::uint32_t>(static_cast<std::int32_t>(source[i] * 256.0F)) & 0xFFFFFFU);
    Bytes packed(meshopt_encodeVertexBufferBound(count, 12));
    packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), filtered.data(), count, 12));
    std::vector<float> normals;
    for (int i = 0; i < count; ++i)
        normals.insert(normals.end(), {std::cos(0.1F * static_cast<float>(i)),
                                       std::sin(0.1F * static_cast<float>(i)), 0.0F, 0.0F});
    Bytes octahedral(count * 4);
    meshopt_encodeFilterOct(octahedral.data(), count, 4, 8, normals.data());
    Bytes packed_normals(meshopt_encodeVertexBufferBound(count, 4));
    packed_normals.resize(meshopt_encodeVertexBuffer(packed_normals.data(), packed_normals.size(),
                                                     octahedral.data(), count, 4));

    GltfFile file;
    file.binary = packed;
    const auto offset = static_cast<int>(file.binary.size());
    file.binary.insert(file.binary.end(), packed_normals.begin(), packed_normals.end());
    file.add("bufferViews",
             {{"buffer", 0},
              {"byteLength", count * 12},
              {"byteStride", 12},
              {"extensions", meshopt_extension(0, packed.size(), 12, count, "ATTRIBUTES", "EXPONENTIAL")}});
    file.add("bufferViews", {{"buffer", 0},
                             {"byteLength", count * 4},
                             {"byteStride", 4},
                             {"extensions", meshopt_extension(offset, packed_normals.size(), 4, count,
                                                              "ATTRIBUTES", "OCTAHEDRAL")}});
    file.add("accessors", {{"bufferView", 0}, {"componentType", 5126}, {"count", count}, {"type", "VEC3"}});
    file.add("accessors", {{"bufferView", 1},
                           {"componentType", 5120},
                           {"count", count},
                           {"type", "VEC3"},
                           {"normalized", true}});
    file.add_mesh({{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}, {"mode", 0}});
    const Scene scene = load_glb(file);
    const Primitive& primitive = scene.meshes.at(0).primitives.at(0);
    for (std::size_t i = 0; i < count; ++i) {
        EXPECT_NEAR(primitive.positions[i].x, source[3 * i], 0.01F) << i;
        EXPECT_NEAR(primitive.positions[i].z, 100.0F, 0.01F) << i;
        EXPECT_NEAR(primitive.normals[i].y, normals[4 * i + 1], 0.02F) << i;
    }
}

}  // namespace
}  // namespace cairn::scenes
