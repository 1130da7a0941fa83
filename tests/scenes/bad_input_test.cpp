// Broken and hostile files: each must give one error that names the element and the fault, after little work
// and in little memory.
#include <cmath>
#include <functional>
#include <ostream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "base/error.h"
#include "scenes/gltf/limits.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "tests/support/count_news.h"
#include "tests/support/rich_gltf_file.h"
#include "tests/support/scratch_folder.h"

namespace cairn::scenes {
namespace {

using test::Bytes;
using test::GltfFile;
using test::Json;
using test::ScratchFolder;

/// The text of the error, way out included. The test fails if there is no error, or if it takes much work,
/// which is counted in bytes that are allocated, or much memory.
std::string message_of(const std::string& path, const LoadOptions& options = {}) {
    const auto peak_mib = [] {
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        return usage.ru_maxrss / 1024;
    };
    const long peak_before = peak_mib();
    const std::size_t bytes_before = test::new_bytes();
    std::string message;
    try {
        const Scene scene = load(path, options);
        (void)take_snapshot(scene);
        ADD_FAILURE() << "it was loaded";
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::input) << error.what();
        EXPECT_FALSE(error.way_out().empty()) << error.what();
        message = std::string(error.what()) + "\n" + error.way_out();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        EXPECT_LT(std::string(error.what()).size(), 500U) << error.what();
    }
    EXPECT_LT((test::new_bytes() - bytes_before) >> 20U, 2000U) << message;
    EXPECT_LT(peak_mib() - peak_before, 500) << message;
    return message;
}

std::string message_of(const Bytes& file, const LoadOptions& options = {}) {
    const ScratchFolder folder;
    test::write_bytes(folder.file("bad.glb"), file.data(), file.size());
    return message_of(folder.file("bad.glb"), options);
}

#define EXPECT_HOLDS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST(BadInput, TheRichFileItselfIsGood) {
    const ScratchFolder folder;
    test::rich_gltf_file().write_glb(folder.file("good.glb"));
    const Scene scene = load(folder.file("good.glb"));
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front().text;
    EXPECT_EQ(take_snapshot(scene).triangle_count, 6U);
    EXPECT_EQ(take_snapshot(scene, {0.5, 0, std::nullopt}).triangle_count, 6U);
}

/// A change that breaks the rich file, and a text that the message must hold.
struct Spoiled {
    const char* name;
    std::function<void(GltfFile&)> spoil;
    std::vector<const char*> parts;
};

void PrintTo(const Spoiled& spoiled, std::ostream* out) {
    *out << spoiled.name;
}

/// Sets one value of the JSON, by its JSON pointer.
std::function<void(GltfFile&)> set(const char* pointer, const Json& value) {
    return [=](GltfFile& file) { file.json[Json::json_pointer(pointer)] = value; };
}

/// Overwrites four bytes of an accessor's data.
std::function<void(GltfFile&)> poke(std::size_t accessor, std::size_t offset, float value) {
    return [=](GltfFile& file) {
        const std::size_t view = file.json["accessors"][accessor]["bufferView"];
        const std::size_t start = file.json["bufferViews"][view]["byteOffset"];
        std::memcpy(&file.binary[start + offset], &value, sizeof(value));
    };
}

std::function<void(GltfFile&)> erase(const char* parent, const char* key) {
    return [=](GltfFile& file) { file.json[Json::json_pointer(parent)].erase(key); };
}

class BadInput : public testing::TestWithParam<Spoiled> {};

TEST_P(BadInput, IsRefusedWithAMessageThatNamesIt) {
    GltfFile file = test::rich_gltf_file();
    GetParam().spoil(file);
    const std::string message = message_of(file.glb());
    EXPECT_HOLDS(message, "bad.glb");
    for (const char* part : GetParam().parts)
        EXPECT_HOLDS(message, part);
}

const float infinite = INFINITY;

const Spoiled structure[] = {
    {"NoAsset", erase("", "asset"), {"\"asset\" is missing"}},
    {"OldVersion", set("/asset/version", "1.0"), {"version \"1.0\""}},
    {"NewerMinVersion", set("/asset/minVersion", "2.1"), {"minVersion"}},
    {"ArrayThatIsNone", set("/meshes", 7), {"\"meshes\"", "an array", "7"}},
    {"ElementThatIsNoObject", set("/nodes/1", "x"), {"node 1", "an object"}},
    {"AttributesMissing",
     erase("/meshes/0/primitives/0", "attributes"),
     {"mesh 0 \"ear\", primitive 0", "\"attributes\" is missing"}},
    {"NegativeIndex", set("/nodes/0/mesh", -1), {"node 0 \"body\"", "\"mesh\"", "-1"}},
    {"FractionalIndex", set("/nodes/0/mesh", 0.5), {"\"mesh\"", "0.5"}},
    {"HugeIndex", set("/nodes/0/mesh", 18446744073709551615ULL), {"\"mesh\"", "2 meshes"}},
    {"MeshOutOfRange", set("/nodes/0/mesh", 2), {"node 0 \"body\"", "\"mesh\" is 2", "2 meshes"}},
    {"SkinOutOfRange", set("/nodes/0/skin", 1), {"\"skin\" is 1"}},
    {"CameraOutOfRange", set("/nodes/2/camera", 9), {"node 2", "\"camera\" is 9"}},
    {"LightOutOfRange",
     set("/nodes/2/extensions/KHR_lights_punctual/light", 1),
     {"node 2", "\"light\" is 1"}},
    {"ChildOutOfRange", set("/nodes/1/children/0", 44), {"node 1", "\"children\" is 44"}},
    {"SceneNodeOutOfRange", set("/scenes/0/nodes/0", 44), {"scene 0"}},
    {"SceneOutOfRange", set("/scene", 5), {"\"scene\" is 5"}},
    {"MaterialOutOfRange", set("/meshes/0/primitives/0/material", 1), {"primitive 0", "\"material\" is 1"}},
    {"AttributeOutOfRange", set("/meshes/0/primitives/0/attributes/NORMAL", 99), {"\"NORMAL\" is 99"}},
    {"IndicesOutOfRange", set("/meshes/0/primitives/0/indices", 99), {"\"indices\" is 99"}},
    {"TargetOutOfRange", set("/meshes/0/primitives/0/targets/0/POSITION", 99), {"\"POSITION\" is 99"}},
    {"TextureOutOfRange",
     set("/materials/0/pbrMetallicRoughness/baseColorTexture/index", 1),
     {"material 0 \"leaf\"", "\"index\" is 1"}},
    {"ImageOutOfRange", set("/textures/0/source", 3), {"texture 0", "\"source\" is 3"}},
    {"SamplerOutOfRange", set("/textures/0/sampler", 3), {"texture 0", "\"sampler\" is 3"}},
    {"ImageViewOutOfRange", set("/images/0/bufferView", 300), {"image 0 \"bark\"", "\"bufferView\" is 300"}},
    {"BufferOutOfRange", set("/bufferViews/0/buffer", 1), {"buffer view 0", "\"buffer\" is 1"}},
    {"ViewOutOfRange", set("/accessors/0/bufferView", 99), {"accessor 0", "\"bufferView\" is 99"}},
    {"JointOutOfRange", set("/skins/0/joints/0", 99), {"skin 0", "\"joints\" is 99"}},
    {"ChannelSamplerOutOfRange",
     set("/animations/0/channels/0/sampler", 1),
     {"animation 0 \"wave\", channel 0", "\"sampler\" is 1"}},
    {"ChannelNodeOutOfRange",
     set("/animations/0/channels/0/target/node", 99),
     {"channel 0, target", "\"node\" is 99"}},
    {"KeyTimesOutOfRange", set("/animations/0/samplers/0/input", 99), {"sampler 0", "\"input\" is 99"}},
};
INSTANTIATE_TEST_SUITE_P(Structure, BadInput, testing::ValuesIn(structure),
                         [](const auto& test_info) { return test_info.param.name; });

const Spoiled nodes[] = {
    {"Cycle", set("/nodes/2/children", {1}), {"node 1", "its own ancestor"}},
    {"SelfCycle", set("/nodes/0/children", {0}), {"node 0 \"body\"", "its own ancestor"}},
    {"TwoParents", set("/nodes/0/children", {2}), {"node 2", "child of node 0 and of node 1"}},
    {"ChildTwice", set("/nodes/1/children", {2, 2}), {"node 2", "child of node 1"}},
    {"RootWithAParent", set("/scenes/0/nodes", {0, 2}), {"scene 0", "node 2"}},
    {"RootTwice", set("/scenes/0/nodes", {0, 0}), {"scene 0", "twice"}},
    {"InfiniteTranslation",
     [](GltfFile& f) {
         f.json["nodes"][1]["translation"] = {1e308, 0, 0};
         f.json["nodes"][2]["translation"] = {1e308, 0, 0};
     },
     {"node 0 \"body\"", "infinity"}},
    {"ShortMatrix", set("/nodes/3/matrix", {1, 2, 3}), {"node 3", "\"matrix\" holds 3"}},
    {"ProjectiveMatrix", set("/nodes/3/matrix/3", 1), {"node 3", "no affine transform"}},
    {"MatrixOfStrings", set("/nodes/3/matrix/3", "1"), {"node 3", "numbers"}},
    {"InstanceAttributeOfWrongWidth",
     set("/nodes/3/extensions/EXT_mesh_gpu_instancing/attributes/SCALE", 2),
     {"EXT_mesh_gpu_instancing", "SCALE"}},
    {"InstanceAttributesOfDifferentCounts",
     set("/nodes/3/extensions/EXT_mesh_gpu_instancing/attributes/SCALE", 0),
     {"EXT_mesh_gpu_instancing", "elements"}},
    {"JointThatTheSkinLacks", set("/skins/0/joints", {1}), {"node 0 \"body\"", "joint 1"}},
    {"FewerInverseMatricesThanJoints", set("/skins/0/joints", {1, 2, 0}), {"skin 0", "2 matrices for 3"}},
    {"InverseMatricesOfAnotherType", set("/skins/0/inverseBindMatrices", 0), {"skin 0", "MAT4"}},
    {"UnknownCamera", set("/cameras/0/type", "fisheye"), {"fisheye"}},
};
INSTANTIATE_TEST_SUITE_P(Nodes, BadInput, testing::ValuesIn(nodes),
                         [](const auto& test_info) { return test_info.param.name; });

const Spoiled bytes[] = {
    {"ViewPastItsBuffer", set("/bufferViews/0/byteLength", 1'000'000), {"buffer view 0", "buffer 0 holds"}},
    {"ViewOffsetOverflow", set("/bufferViews/0/byteOffset", (1ULL << 53U)), {"buffer view 0"}},
    {"AccessorPastItsView",
     set("/accessors/0/count", 5),
     {"accessor 0", "ends at byte 60, its buffer view holds 48"}},
    {"AccessorOffsetPastItsView", set("/accessors/0/byteOffset", 4), {"accessor 0", "ends at byte 52"}},
    {"AccessorCountOverflow",
     set("/accessors/0/count", (1ULL << 53U)),
     {"accessor 0", "buffer view holds 48"}},
    {"AccessorOffsetOverflow", set("/accessors/0/byteOffset", (1ULL << 53U)), {"accessor 0"}},
    {"CountBeyondWholeNumbers", set("/accessors/0/count", 1e300), {"accessor 0", "\"count\""}},
    {"NegativeCount", set("/accessors/0/count", -4), {"accessor 0", "\"count\""}},
    {"StrideTooSmall", set("/bufferViews/0/byteStride", 8), {"accessor 0", "12 bytes", "is 8"}},
    {"OddStride", set("/bufferViews/1/byteStride", 6), {"byteStride"}},
    {"UnknownComponentType", set("/accessors/0/componentType", 5124), {"accessor 0", "5124"}},
    {"ComponentTypeOutOfRange", set("/accessors/0/componentType", 5128), {"accessor 0", "5128"}},
    {"UnknownAccessorType", set("/accessors/0/type", "VEC9"), {"VEC9"}},
    {"PositionsOfTwoComponents",
     set("/meshes/0/primitives/0/attributes/POSITION", 2),
     {"primitive 0", "2 components"}},
    {"AttributeOfAnotherCount", set("/accessors/2/count", 3), {"accessor 2", "3 elements, POSITION has 4"}},
    {"IndicesThatAreFloats",
     set("/meshes/0/primitives/0/indices", 10),
     {"primitive 0", "cannot be an index"}},
    {"IndicesThatAreVectors", set("/meshes/0/primitives/0/indices", 0), {"indices must be SCALAR"}},
    {"IndexPastTheVertices", poke(8, 0, 3e33F), {"mesh 1, primitive 0", "the primitive has 4 vertices"}},
    {"InfinitePosition", poke(0, 16, infinite), {"mesh 0 \"ear\", primitive 0", "vertex 1 is not finite"}},
    {"NanPosition", poke(0, 44, std::nanf("")), {"vertex 3 is not finite"}},
    {"InfiniteMorphTarget", poke(6, 16, infinite), {"morph target 0", "vertex 1 is not finite"}},
    {"InfiniteInverseMatrix", poke(9, 0, infinite), {"skin 0", "not finite"}},
    {"InfiniteInstance", poke(11, 0, infinite), {"not finite"}},
    {"KeyTimesThatGoBack", poke(10, 0, 2.0F), {"animation 0 \"wave\", channel 0", "key times must increase"}},
    {"KeyTimesBackwards", poke(10, 0, 2.0F), {"key times must increase"}},
    {"NanKeyTime", poke(10, 0, std::nanf("")), {"not finite"}},
    {"KeyValuesTooFew", set("/accessors/11/count", 1), {"holds 3 numbers, its 2 keys need 6"}},
    {"CubicSplineWithoutTangents", set("/animations/0/samplers/0/interpolation", "CUBICSPLINE"), {"need 18"}},
    {"UnknownInterpolation", set("/animations/0/samplers/0/interpolation", "MAGIC"), {"MAGIC"}},
    {"KeyValuesOfWrongWidth",
     set("/animations/0/channels/0/target/path", "rotation"),
     {"3 components, unfit for rotation"}},
    {"UnknownMode", set("/meshes/0/primitives/0/mode", 7), {"\"mode\" is 7"}},
    {"UnknownAlphaMode", set("/materials/0/alphaMode", "GLOW"), {"material 0 \"leaf\"", "GLOW"}},
    {"UnknownWrapMode", set("/samplers/0/wrapS", 1), {"material 0 \"leaf\"", "wrap mode 1"}},
    {"SparseIndexPastTheEnd", set("/accessors/6/count", 3), {"accessor 6", "sparse", "index 1 is 3"}},
    {"SparseCountPastItsViews", set("/accessors/6/sparse/count", 3), {"accessor 6", "sparse indices"}},
    {"SparseIndicesThatAreFloats",
     set("/accessors/6/sparse/indices/componentType", 5126),
     {"sparse", "5126"}},
    {"SparseViewOutOfRange",
     set("/accessors/6/sparse/values/bufferView", 77),
     {"accessor 6, sparse, values", "77"}},
    {"AbsurdZeros",
     [](GltfFile& f) {
         f.json["accessors"][0].erase("bufferView");
         f.json["accessors"][0]["count"] = 2'000'000'000;
     },
     {"more than a file of this size can mean"}},
    {"AbsurdZerosUnindexed",
     [](GltfFile& f) {
         erase("/accessors/0", "bufferView")(f);
         erase("/meshes/1/primitives/0", "indices")(f);
         set("/accessors/0/count", (1ULL << 40U))(f);
     },
     {"more than a file of this size can mean"}},
};
INSTANTIATE_TEST_SUITE_P(Bytes, BadInput, testing::ValuesIn(bytes),
                         [](const auto& test_info) { return test_info.param.name; });

/// Replaces the bytes of the picture.
std::function<void(GltfFile&)> picture(const Bytes& file_bytes) {
    return [=](GltfFile& file) { file.json["images"][0]["bufferView"] = file.add_view(file_bytes); };
}

Bytes huge_png(std::uint32_t width, std::uint32_t height) {
    return test::PngWriter::make(width, height, 8, Bytes(64));
}

const Spoiled images[] = {
    {"NoPicture", picture({1, 2, 3, 4}), {"image 0 \"bark\"", "cannot be read", "PNG and JPEG"}},
    {"EmptyPicture", picture({}), {"image 0 \"bark\""}},
    {"CutPicture", picture({0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n', 0, 0}), {"image 0 \"bark\""}},
    {"MissingFile",
     set("/images/0", {{"uri", "gone.png"}}),
     {"image 0 \"gone.png\"", "no file \"gone.png\""}},
    {"Neither", set("/images/0", Json::object()), {"image 0", "neither a URI nor a buffer view"}},
    {"SixtyThousandWide", picture(huge_png(60000, 60000)), {"image 0 \"bark\""}},
    {"GigabyteClaimed",
     picture(huge_png(16000, 16000)),
     {"image 0 \"bark\"", "16000 x 16000", "image-bytes"}},
    {"FewerTexelsThanClaimed", picture(huge_png(1000, 1000)), {"image 0 \"bark\"", "cannot be read"}},
};
/// Where the file is read strictly; else a lost picture is a warning (tolerance_test.cpp).
class BadPicture : public BadInput {};

TEST_P(BadPicture, IsRefusedWithAMessageThatNamesIt) {
    GltfFile file = test::rich_gltf_file();
    GetParam().spoil(file);
    const std::string message = message_of(file.glb(), {.strict = true});
    for (const char* part : GetParam().parts)
        EXPECT_HOLDS(message, part);
    file.json["materials"][0]["alphaMode"] = "OPAQUE";
    const ScratchFolder folder;
    file.write_glb(folder.file("bad.glb"));
    const Scene scene = load(folder.file("bad.glb"));
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_TRUE(scene.warnings[0].alters);
    EXPECT_HOLDS(scene.warnings[0].text, GetParam().parts.front());
}

INSTANTIATE_TEST_SUITE_P(Images, BadPicture, testing::ValuesIn(images),
                         [](const auto& test_info) { return test_info.param.name; });

/// A picture of one texel whose data unpacks to 400 MB: deflate's longest matches, all zeros.
TEST(BadInput, APictureThatUnpacksToMoreThanItsSizeIsRefused) {
    // A block of fixed codes: a literal 0, then matches of 258 at distance 1, each 13 bits: code 285 (8 bits,
    // 11000101) and distance 0 (5 bits).
    Bytes deflate = {0x78, 0x01};
    std::uint32_t pending = 0;
    unsigned pending_bits = 0;
    const auto put = [&](std::uint32_t bits, unsigned count) {
        pending |= bits << pending_bits;
        for (pending_bits += count; pending_bits >= 8; pending_bits -= 8, pending >>= 8U)
            deflate.push_back(static_cast<std::uint8_t>(pending));
    };
    put(0b011, 3);
    put(0b00001100, 8);
    for (int i = 0; i < 1'600'000; ++i) {
        put(0b10100011, 8);
        put(0, 5);
    }
    put(0, 16);
    Bytes png = test::PngWriter::make(1, 1, 8, Bytes(5));
    const Bytes length = {
        static_cast<std::uint8_t>(deflate.size() >> 24U), static_cast<std::uint8_t>(deflate.size() >> 16U),
        static_cast<std::uint8_t>(deflate.size() >> 8U), static_cast<std::uint8_t>(deflate.size())};
    constexpr std::size_t idat = 33;  // after the signature and IHDR
    png.resize(idat);
    png.insert(png.end(), length.begin(), length.end());
    for (const char letter : {'I', 'D', 'A', 'T'})
        png.push_back(static_cast<std::uint8_t>(letter));
    png.insert(png.end(), deflate.begin(), deflate.end());
    png.insert(png.end(), {0, 0, 0, 0, 0, 0, 0, 0, 'I', 'E', 'N', 'D', 0, 0, 0, 0});
    GltfFile file = test::rich_gltf_file();
    picture(png)(file);
    EXPECT_HOLDS(message_of(file.glb(), {.strict = true}), "image 0 \"bark\"");
}

Bytes text_file(const std::string& text) {
    return {text.begin(), text.end()};
}

TEST(BadInput, FilesThatAreNoGltf) {
    EXPECT_HOLDS(message_of(Bytes{}), "empty");
    EXPECT_HOLDS(message_of(text_file(" \n\t ")), "empty");
    EXPECT_HOLDS(message_of(text_file("solid teapot")), "neither a .glb nor JSON");
    EXPECT_HOLDS(message_of(text_file("{\"asset\":")), "JSON is broken");
    EXPECT_HOLDS(message_of(text_file("{\"asset\":{\"version\":\"2.0\"},}")), "JSON is broken");
    EXPECT_HOLDS(message_of(text_file("{\"asset\":{\"version\":\"\xFF\xFE\"}}")), "JSON is broken");
    EXPECT_HOLDS(message_of(text_file("{\"asset\":{\"version\":\"2.0\"},\"x\":1e999}")), "JSON is broken");
    EXPECT_HOLDS(message_of(text_file("{}")), "\"asset\" is missing");
    EXPECT_HOLDS(
        message_of(text_file(
            "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":9}],"
            "\"bufferViews\":[{\"buffer\":0,\"byteLength\":9}],"
            "\"accessors\":[{\"bufferView\":0,\"componentType\":5121,\"count\":3,\"type\":\"VEC3\"}],"
            "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}")),
        "neither a URI nor the binary chunk");
}

TEST(BadInput, DeepJsonIsRefusedBeforeItIsParsed) {
    constexpr std::size_t depth = 10'000'000;
    EXPECT_HOLDS(message_of(text_file("{\"extras\":" + std::string(depth, '['))), "nests deeper");
    std::string objects = "{\"extras\":";
    for (int i = 0; i < 1'000'000; ++i)
        objects += "{\"a\":";
    EXPECT_HOLDS(message_of(text_file(objects)), "nests deeper");
}

TEST(BadInput, HugeJsonIsRefusedBeforeItIsParsed) {
    std::string text = "{\"extras\":[0";
    for (int i = 0; i < 5'000'000; ++i)
        text += ",0";
    EXPECT_HOLDS(message_of(text_file(text + "]}")), "json-values=5000003");
    for (const char* array : {"materials", "nodes"}) {
        text = fmt::format("{{\"asset\":{{\"version\":\"2.0\"}},\"{}\":[{{}}", array);
        for (int i = 0; i < 1'100'000; ++i)
            text += ",{}";
        EXPECT_HOLDS(message_of(text_file(text + "]}")), "passes the limit");
    }
}

/// Each length in the container is made wrong in turn, and the file is cut at every byte.
TEST(BadInput, BrokenContainers) {
    const Bytes good = test::rich_gltf_file().glb();
    const std::size_t json_bytes = good[12] | good[13] << 8U;
    const auto with = [&](std::size_t at, std::uint8_t value) {
        Bytes file = good;
        file[at] = value;
        return file;
    };
    EXPECT_HOLDS(message_of(with(4, 1)), "version 1");
    EXPECT_HOLDS(message_of(with(11, 0x7F)), "cut short");
    EXPECT_HOLDS(message_of(with(15, 0x7F)), "a chunk ends at byte");
    EXPECT_HOLDS(message_of(with(16, 'X')), "first chunk is not JSON");
    EXPECT_HOLDS(message_of(with(20 + json_bytes + 3, 0xFF)), "a chunk ends at byte");
    for (std::size_t size = 0; size < good.size(); size += size < 64 ? 1 : 37)
        EXPECT_FALSE(
            message_of(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size))).empty())
            << size;
}

TEST(BadInput, ABufferThatIsShorterThanItSays) {
    const ScratchFolder folder;
    GltfFile file = test::rich_gltf_file();
    file.write_gltf(folder.file("bad.gltf"));
    test::write_bytes(folder.file("bad.bin"), file.binary.data(), file.binary.size() / 2);
    EXPECT_HOLDS(message_of(folder.file("bad.gltf")), "buffer 0: \"byteLength\" is");
    std::filesystem::remove(folder.file("bad.bin"));
    EXPECT_HOLDS(message_of(folder.file("bad.gltf")), "no file \"bad.bin\"");
    std::filesystem::create_directory(folder.file("bad.bin"));
    EXPECT_HOLDS(message_of(folder.file("bad.gltf")), "not a regular file");
}

TEST(BadInput, BrokenDataUris) {
    for (const auto& [uri, part] :
         {std::pair("data:application/octet-stream;base64,AA!A", "not base64"),
          std::pair("data:application/octet-stream;base64", "no comma"),
          std::pair("data:,abc", "its data holds 3"), std::pair("", "URI is empty")}) {
        GltfFile file = test::rich_gltf_file();
        file.json["buffers"] = Json::array({{{"byteLength", file.binary.size()}, {"uri", uri}}});
        EXPECT_HOLDS(message_of(file.glb()), part);
    }
}

TEST(BadInput, ABudgetGrowsWithTheInputAndNeverOverflows) {
    MemoryBudget memory(2000);
    gltf::Budget budget("all of it", 1000, memory);
    budget.charge("here", 10, 90);
    EXPECT_THROW(budget.charge("here", 101, 1), Error);
    EXPECT_THROW(budget.charge("here", 1ULL << 62U, 1ULL << 62U), Error);
    EXPECT_NO_THROW(budget.charge("here", 1ULL << 62U, 0));
    EXPECT_NO_THROW(budget.charge("here", 100, 1));
    EXPECT_THROW(budget.charge("here", 1, 1), Error);
    budget.grant(1);
    EXPECT_NO_THROW(budget.charge("here", 256, 1));
    // Whatever was read, the memory is the limit.
    budget.grant(1'000'000);
    EXPECT_NO_THROW(budget.charge("here", 744, 1));
    EXPECT_THROW(budget.charge("here", 1, 1), Error);
}

/// A few kilobytes that describe 10^10 placed primitives.
TEST(BadInput, TooManyPlacedPrimitives) {
    GltfFile file = test::rich_gltf_file();
    const Json primitive = {{"attributes", {{"POSITION", 0}}}};
    for (int i = 0; i < 10'000; ++i)
        file.json["meshes"][1]["primitives"].push_back(primitive);
    for (int i = 0; i < 1'000; ++i)
        file.add_root({{"mesh", 1}});
    EXPECT_HOLDS(message_of(file.glb()), "primitives=");
}

/// A thousand primitives that each unpack the same megabytes.
TEST(BadInput, TheSameVerticesAThousandTimes) {
    GltfFile file;
    const int positions = file.add_accessor(std::vector<float>(300'000, 1.0F), "VEC3");
    const int node = file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"mode", 0}});
    Json& primitives = file.json["meshes"][static_cast<std::size_t>(node)]["primitives"];
    for (int i = 0; i < 1'000; ++i)
        primitives.push_back(primitives[0]);
    EXPECT_HOLDS(message_of(file.glb()), "more than a file of this size can mean");
}

}  // namespace
}  // namespace cairn::scenes
