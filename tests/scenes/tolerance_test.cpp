// What glTF forbids, or what not every reader knows, and others still read: the shape is read, and a warning
// says what is missing. Each file is the twin of one that somebody exported.
#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

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

#define EXPECT_HOLDS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

/// A triangle with texture coordinates and one material, whose texture is the picture "lost.png".
GltfFile textured(const char* alpha_mode = "OPAQUE") {
    GltfFile file;
    const int positions = file.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int texcoords = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2");
    file.add("images", {{"uri", "lost.png"}});
    file.add("textures", {{"source", 0}});
    file.add("materials", {{"name", "leaf"},
                           {"alphaMode", alpha_mode},
                           {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    file.add_mesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", texcoords}}}, {"material", 0}});
    return file;
}

Scene load_glb(const GltfFile& file, const LoadOptions& options = {}) {
    const ScratchFolder folder;
    file.write_glb(folder.file("a.glb"));
    return load(folder.file("a.glb"), options);
}

/// The text of the error, way out included, that loading the file gives.
std::string failure_of(const GltfFile& file, const LoadOptions& options = {}, Fault fault = Fault::input) {
    try {
        (void)take_snapshot(load_glb(file, options));
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), fault) << error.what();
        return std::string(error.what()) + "\n" + error.way_out();
    }
    ADD_FAILURE() << "it was loaded";
    return {};
}

/// The one warning of a scene, which must be of the kind.
std::string the_warning(const Scene& scene, bool alters) {
    if (scene.warnings.size() != 1) {
        for (const Warning& warning : scene.warnings)
            ADD_FAILURE() << warning.text;
        EXPECT_EQ(scene.warnings.size(), 1U);
        return {};
    }
    EXPECT_EQ(scene.warnings[0].alters, alters) << scene.warnings[0].text;
    return scene.warnings[0].text;
}

/// Ways in which a base colour has no picture, and the word that the message must hold.
struct Pictureless {
    const char* name;
    std::function<void(GltfFile&)> spoil;
    const char* part;
};
void PrintTo(const Pictureless& lost, std::ostream* out) {
    *out << lost.name;
}

void use_texture_extension(GltfFile& file, const char* name) {
    file.json["textures"][0] = {{"extensions", {{name, {{"source", 0}}}}}};
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {name};
}

const Pictureless lost_pictures[] = {
    {"NoFile", [](GltfFile&) {}, "lost.png"},
    {"Webp",
     [](GltfFile& file) {
         file.json["images"][0] = {
             {"uri", "data:image/webp;base64,UklGRhoAAABXRUJQVlA4TA4AAAAvAAAAAAcQEREREf8AAAA="}};
     },
     "image 0"},
    {"NoBytes",
     [](GltfFile& file) {
         file.json["images"][0] = {{"uri", "data:,"}};
     },
     "image 0"},
    {"NeitherUriNorView",
     [](GltfFile& file) {
         file.json["images"][0] = {{"name", "bark"}};
     },
     "bark"},
    {"ABackslashOutOfTheFolder",
     [](GltfFile& file) {
         file.json["images"][0] = {{"uri", "..\\bark.png"}};
     },
     "bark"},
    {"NoSource", [](GltfFile& file) { file.json["textures"][0] = Json::object(); }, "names no picture"},
    {"Basisu", [](GltfFile& file) { use_texture_extension(file, "KHR_texture_basisu"); }, "KTX2"},
    {"WebpByExtension", [](GltfFile& file) { use_texture_extension(file, "EXT_texture_webp"); }, "WebP"},
};

class LostPicture : public testing::TestWithParam<Pictureless> {
protected:
    [[nodiscard]] static GltfFile spoiled(const char* alpha_mode) {
        GltfFile file = textured(alpha_mode);
        GetParam().spoil(file);
        return file;
    }
};

TEST_P(LostPicture, OfAnOpaqueMaterialLeavesTheShape) {
    const Scene scene = load_glb(spoiled("OPAQUE"));
    EXPECT_EQ(take_snapshot(scene).triangle_count, 1U);
    EXPECT_EQ(scene.materials.at(0).texture, -1);
    const auto tells = [](const Warning& warning) {
        return warning.alters && warning.text.find(GetParam().part) != std::string::npos;
    };
    EXPECT_TRUE(std::ranges::any_of(scene.warnings, tells));
}

TEST_P(LostPicture, OfAMaskIsAnError) {
    const std::string message = failure_of(spoiled("MASK"));
    EXPECT_HOLDS(message, GetParam().part);
    EXPECT_HOLDS(message, "mask");
    EXPECT_HOLDS(message, "leaf");
}

TEST_P(LostPicture, IsAnErrorWhereTheFileIsReadStrictly) {
    EXPECT_HOLDS(failure_of(spoiled("OPAQUE"), {.strict = true}), GetParam().part);
}

TEST_P(LostPicture, OfAMaterialThatNoMeshHasIsNotLookedAt) {
    for (const char* mode : {"OPAQUE", "MASK"}) {
        GltfFile file = spoiled(mode);
        file.json["meshes"][0]["primitives"][0].erase("material");
        const Scene scene = load_glb(file, {.strict = true});
        for (const Warning& warning : scene.warnings)
            EXPECT_FALSE(warning.alters) << warning.text;
        // Nor if a mesh has it that no node places.
        file = spoiled(mode);
        file.json["nodes"][0].erase("mesh");
        EXPECT_NO_THROW((void)load_glb(file, {.strict = true}));
    }
}

INSTANTIATE_TEST_SUITE_P(All, LostPicture, testing::ValuesIn(lost_pictures),
                         [](const auto& param) { return std::string(param.param.name); });

TEST(Tolerance, APictureOfOneMaterialIsLostForAnother) {
    GltfFile file = textured("OPAQUE");
    file.add("materials", file.json["materials"][0]);
    Json second = file.json["meshes"][0]["primitives"][0];
    second["material"] = 1;
    file.json["meshes"][0]["primitives"].push_back(second);
    EXPECT_HOLDS(the_warning(load_glb(file), true), "lost.png");  // the file is told once
    file.json["materials"][1]["alphaMode"] = "MASK";
    EXPECT_HOLDS(failure_of(file), "material 1");
}

TEST(Tolerance, ExtensionsWithoutAShapeMayBeRequired) {
    for (const char* name : {"EXT_mesh_features", "VRM", "VRMC_vrm", "EXT_structural_metadata"}) {
        GltfFile file = textured();
        file.json["materials"][0].erase("pbrMetallicRoughness");
        file.json["extensionsUsed"] = file.json["extensionsRequired"] = {name};
        EXPECT_HOLDS(the_warning(load_glb(file), false), name);
    }
}

GltfFile triangle() {
    GltfFile file = textured();
    for (const char* part : {"materials", "textures", "images"})
        file.json.erase(part);
    file.json["meshes"][0]["primitives"][0].erase("material");
    return file;
}

TEST(Visibility, HidesANodeAndItsDescendants) {
    for (const bool required : {false, true}) {
        GltfFile file = triangle();
        file.json["extensionsUsed"] = {"KHR_node_visibility"};
        if (required) file.json["extensionsRequired"] = {"KHR_node_visibility"};
        file.json["nodes"] = {{{"children", {1}}}, {{"mesh", 0}}, {{"mesh", 0}, {"translation", {5, 0, 0}}}};
        file.json["scenes"][0]["nodes"] = {0, 2};
        EXPECT_EQ(take_snapshot(load_glb(file)).triangle_count, 2U);
        const auto hide = [&](int node, bool visible) {
            file.json["nodes"][std::size_t(node)]["extensions"]["KHR_node_visibility"]["visible"] = visible;
        };
        hide(0, false);
        const Scene scene = load_glb(file);
        EXPECT_TRUE(scene.warnings.empty());
        const Snapshot snapshot = take_snapshot(scene);
        EXPECT_EQ(snapshot.triangle_count, 1U);
        EXPECT_EQ(snapshot.bounds.low.x, 5.0);
        hide(1, true);  // a hidden parent hides it all the same
        EXPECT_EQ(take_snapshot(load_glb(file)).triangle_count, 1U);
        hide(2, false);
        EXPECT_EQ(take_snapshot(load_glb(file)).triangle_count, 0U);
    }
}

/// The triangle, moved along x from 0 to 4 within two seconds, by a channel with this target.
GltfFile moved(const Json& target, const std::vector<float>& times = {0, 2},
               const std::vector<float>& places = {0, 0, 0, 4, 0, 0}) {
    GltfFile file = triangle();
    const int input = file.add_accessor(times, "SCALAR");
    const int output = file.add_accessor(places, "VEC3");
    file.add("animations", {{"channels", {{{"sampler", 0}, {"target", target}}}},
                            {"samplers", {{{"input", input}, {"output", output}}}}});
    file.json["extensionsUsed"] = {"KHR_animation_pointer"};
    return file;
}

Json pointer_to(const std::string& pointer) {
    return {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
}

TEST(AnimationPointer, MovesANodeAsAPathWould) {
    const Scene by_pointer = load_glb(moved(pointer_to("/nodes/0/translation")));
    const Scene by_path = load_glb(moved({{"node", 0}, {"path", "translation"}}));
    EXPECT_TRUE(by_pointer.warnings.empty());
    for (const double seconds : {0.0, 0.5, 1.0, 2.0}) {
        const When when{seconds, 0, std::nullopt};
        EXPECT_EQ(take_snapshot(by_pointer, when).bounds.low.x, 2.0 * seconds);
        EXPECT_EQ(take_snapshot(by_path, when).bounds.low.x, 2.0 * seconds);
    }
}

TEST(AnimationPointer, ToAnythingElseIsAWarningThatNamesIt) {
    for (const char* pointer :
         {"/nodes/7/translation", "/materials/0/emissiveFactor", "/nodes/0/translation/x", "",
          "/nodes/0/extensions/KHR_node_visibility/visible", "/nodes/99999999999999999999/scale"}) {
        const Scene scene = load_glb(moved(pointer_to(pointer)));
        EXPECT_HOLDS(the_warning(scene, false), pointer);
        EXPECT_EQ(take_snapshot(scene, {1.0, 0, std::nullopt}).bounds.low.x, 0.0);
    }
}

TEST(Tolerance, EqualKeyTimesJumpToTheLastOfThem) {
    const Scene scene = load_glb(
        moved({{"node", 0}, {"path", "translation"}}, {0, 1, 1, 2}, {0, 0, 0, 1, 0, 0, 5, 0, 0, 6, 0, 0}));
    EXPECT_HOLDS(the_warning(scene, false), "equal");
    const auto x_at = [&](double seconds) {
        return take_snapshot(scene, {seconds, 0, std::nullopt}).bounds.low.x;
    };
    EXPECT_EQ(x_at(0.5), 0.5);
    EXPECT_EQ(x_at(1.0), 5.0);
    EXPECT_EQ(x_at(1.5), 5.5);
    // At the end, too, and for all keys alike.
    const Scene at_once = load_glb(moved({{"node", 0}, {"path", "translation"}}, {0, 0}));
    EXPECT_EQ(take_snapshot(at_once, {0.0, 0, std::nullopt}).bounds.low.x, 4.0);
    EXPECT_HOLDS(failure_of(moved({{"node", 0}, {"path", "translation"}}, {1, 0})), "must increase");
}

TEST(Tolerance, PrimitivesWithoutTargetsStandBesideThoseWithThem) {
    GltfFile file = triangle();
    const int moves = file.add_accessor(std::vector<float>{2, 0, 0, 2, 0, 0, 2, 0, 0}, "VEC3");
    Json morphed = file.json["meshes"][0]["primitives"][0];
    morphed["targets"] = {{{"POSITION", moves}}};
    for (const bool first : {false, true}) {
        GltfFile mixed = file;
        auto& primitives = mixed.json["meshes"][0]["primitives"];
        primitives.insert(first ? primitives.begin() : primitives.end(), morphed);
        mixed.json["meshes"][0]["weights"] = {0.5};
        const Scene scene = load_glb(mixed);
        EXPECT_HOLDS(the_warning(scene, false), "morph targets");
        const Snapshot snapshot = take_snapshot(scene);
        EXPECT_EQ(snapshot.triangle_count, 2U);
        EXPECT_EQ(snapshot.bounds.low.x, 0.0);
        EXPECT_EQ(snapshot.bounds.high.x, 2.0);
    }
}

TEST(Tolerance, WeightsWithoutTargetsMoveNothing) {
    GltfFile file = triangle();
    file.json["meshes"][0]["weights"] = {0.0, 1.0};
    EXPECT_HOLDS(the_warning(load_glb(file), false), "2 weights for 0 morph targets");
    file = triangle();
    file.json["nodes"][0]["weights"] = {1.0};
    const Scene scene = load_glb(file);
    EXPECT_HOLDS(the_warning(scene, false), "node 0");
    EXPECT_EQ(take_snapshot(scene).bounds.high.x, 1.0);
}

TEST(Tolerance, ADamagedMeshThatNoNodePlacesIsLeftOut) {
    GltfFile file = triangle();
    const int indices = file.add_accessor(std::vector<std::uint16_t>{0, 1, 99}, "SCALAR");
    Json broken = file.json["meshes"][0];
    broken["primitives"][0]["indices"] = indices;
    broken["name"] = "spare";
    file.add("meshes", broken);
    const Scene scene = load_glb(file);
    EXPECT_HOLDS(the_warning(scene, false), "index 2 is 99");
    EXPECT_EQ(scene.meshes.at(1).name, "spare");
    EXPECT_TRUE(scene.meshes[1].primitives.empty());
    EXPECT_EQ(take_snapshot(scene).triangle_count, 1U);
    file.json["nodes"][0]["mesh"] = 1;
    EXPECT_HOLDS(failure_of(file), "index 2 is 99");
}

TEST(Tolerance, ALightOfAnUnknownTypeDoesNotShine) {
    GltfFile file = triangle();
    file.json["extensionsUsed"] = {"KHR_lights_punctual"};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "area"}}, {{"type", "point"}}};
    for (int light = 0; light < 2; ++light)
        file.add_root({{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    const Scene scene = load_glb(file);
    EXPECT_HOLDS(the_warning(scene, false), "\"area\"");
    ASSERT_EQ(take_snapshot(scene).lights.size(), 1U);
    EXPECT_EQ(take_snapshot(scene).lights[0].light.type, Light::Type::point);
}

TEST(Uris, ABackslashDividesFolders) {
    const ScratchFolder folder;
    const GltfFile file = triangle();
    std::filesystem::create_directory(folder.file("sub"));
    test::write_bytes(folder.file("sub/d.bin"), file.binary.data(), file.binary.size());
    for (const char* uri : {"sub\\d.bin", ".\\sub\\d.bin", "sub/..\\sub\\d.bin"}) {
        test::write_text(folder.file("a.gltf"), file.with_buffer(uri).dump());
        EXPECT_EQ(take_snapshot(load(folder.file("a.gltf"))).triangle_count, 1U) << uri;
    }
    for (const char* uri : {"..\\d.bin", "sub\\..\\..\\d.bin", "\\d.bin", "C:\\d.bin"}) {
        test::write_text(folder.file("a.gltf"), file.with_buffer(uri).dump());
        EXPECT_THROW((void)load(folder.file("a.gltf")), Error) << uri;
    }
}

TEST(Uris, Base64MayBePercentEncoded) {
    GltfFile file = triangle();
    file.json["accessors"].erase(1);
    file.json["bufferViews"].erase(1);
    file.json["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
    file.binary.clear();
    // 36 bytes: (0,0,0) (1,0,0) (0,1,0)
    file.json["buffers"] = {
        {{"byteLength", 36},
         {"uri",
          "data:application/octet-stream;base64,AAAAAAAAAAAA%41AAAAACAPwAAAAAAAAAAAAAAAA%41AgD8AAAAA"}}};
    EXPECT_EQ(take_snapshot(load_glb(file)).bounds.high, glm::dvec3(1, 1, 0));
}

TEST(Links, OutOfTheFolderAreRefusedUnlessPathsAreTrusted) {
    const ScratchFolder folder;
    const GltfFile file = triangle();
    std::filesystem::create_directories(folder.file("scene/sub"));
    std::filesystem::create_directory(folder.file("elsewhere"));
    for (const char* place : {"elsewhere/d.bin", "scene/sub/d.bin"})
        test::write_bytes(folder.file(place), file.binary.data(), file.binary.size());
    std::filesystem::create_symlink("../elsewhere/d.bin", folder.file("scene/out.bin"));
    std::filesystem::create_symlink("sub/d.bin", folder.file("scene/in.bin"));
    std::filesystem::create_directory_symlink("../elsewhere", folder.file("scene/folder"));
    std::filesystem::create_directory_symlink("scene", folder.file("linked"));
    const auto message_of = [&](const std::string& uri, bool trust, const char* scene) -> std::string {
        test::write_text(folder.file("scene/a.gltf"), file.with_buffer(uri).dump());
        try {
            (void)load(folder.file(scene), {.trust_paths = trust});
        } catch (const Error& error) {
            return std::string(error.what()) + "\n" + error.way_out();
        }
        return {};
    };
    for (const char* scene : {"scene/a.gltf", "linked/a.gltf"}) {
        EXPECT_EQ(message_of("in.bin", false, scene), "");
        for (const char* uri : {"out.bin", "folder/d.bin"}) {
            const std::string message = message_of(uri, false, scene);
            EXPECT_HOLDS(message, "a link out of the folder");
            EXPECT_HOLDS(message, "LoadOptions::trust_paths");
            EXPECT_EQ(message_of(uri, true, scene), "");
        }
    }
}

TEST(Links, APipeOrAFolderIsNamedAndNotWaitedFor) {
    const ScratchFolder folder;
    const GltfFile file = triangle();
    ASSERT_EQ(mkfifo(folder.file("d.bin").c_str(), 0600), 0);
    std::filesystem::create_directory(folder.file("sub"));
    for (const auto& [uri, part] : {std::pair("d.bin", "a pipe"), std::pair("sub", "a folder")}) {
        test::write_text(folder.file("a.gltf"), file.with_buffer(uri).dump());
        try {
            (void)load(folder.file("a.gltf"));
            ADD_FAILURE() << uri << " was read";
        } catch (const Error& error) {
            EXPECT_HOLDS(std::string(error.what()), part);
        }
    }
    ASSERT_EQ(mkfifo(folder.file("pipe.glb").c_str(), 0600), 0);
    EXPECT_THROW((void)load(folder.file("pipe.glb")), Error);
}

/// A file that passes a limit, with the limit's name and the least number that lets it pass.
struct Passing {
    const char* limit;
    std::uint64_t needed;
    std::function<void(GltfFile&)> grow;
};
void PrintTo(const Passing& passing, std::ostream* out) {
    *out << passing.limit;
}

const Passing passing[] = {
    {"elements", 1'000'001,
     [](GltfFile& file) {
         file.json["nodes"] = Json(1'000'001, Json::object());
         file.json["scenes"][0]["nodes"] = {0};
     }},
    {"materials", 20'001, [](GltfFile& file) { file.json["materials"] = Json(20'001, Json::object()); }},
    {"primitives", 4'002'000,
     [](GltfFile& file) {
         Json& primitives = file.json["meshes"][0]["primitives"];
         primitives = Json(2001, primitives[0]);
         file.json["nodes"] = Json(2000, {{"mesh", 0}});
         file.json["scenes"][0]["nodes"] = Json::array();
         for (int node = 0; node < 2000; ++node)
             file.json["scenes"][0]["nodes"].push_back(node);
     }},
};

class OverALimit : public testing::TestWithParam<Passing> {};

TEST_P(OverALimit, IsToldWhichAndByHowMuch) {
    GltfFile file = triangle();
    GetParam().grow(file);
    const std::string wanted = fmt::format("LoadOptions::limits {}={}", GetParam().limit, GetParam().needed);
    EXPECT_HOLDS(failure_of(file), wanted);
    LoadOptions options;
    for (const LimitName& limit : limit_names())
        if (limit.name == GetParam().limit) options.limits.*limit.value = GetParam().needed;
    EXPECT_NO_THROW((void)take_snapshot(load_glb(file, options)));
}

INSTANTIATE_TEST_SUITE_P(All, OverALimit, testing::ValuesIn(passing),
                         [](const auto& param) { return std::string(param.param.limit); });

TEST(Limits, OfFilesJsonAndPicturesAreTold) {
    GltfFile file = textured();
    const Bytes picture = test::PngWriter::make(2, 2, 8, Bytes(2 * (1 + 2 * 4)));
    file.json["images"][0] = {{"bufferView", file.add_view(picture)}};
    EXPECT_NO_THROW((void)load_glb(file));
    const auto with = [](std::uint64_t Limits::*limit, std::uint64_t value) {
        LoadOptions options;
        options.limits.*limit = value;
        options.strict = true;  // else a picture is a warning
        return options;
    };
    EXPECT_HOLDS(failure_of(file, with(&Limits::file_bytes, 100)), "file-bytes=");
    EXPECT_HOLDS(failure_of(file, with(&Limits::json_values, 10)), "json-values=");
    EXPECT_HOLDS(failure_of(file, with(&Limits::image_bytes, 15)), "image-bytes=16");
    EXPECT_NO_THROW((void)load_glb(file, with(&Limits::image_bytes, 16)));
    const ScratchFolder folder;
    file.write_gltf(folder.file("a.gltf"));
    try {
        (void)load(folder.file("a.gltf"), with(&Limits::json_bytes, 100));
        ADD_FAILURE() << "it was loaded";
    } catch (const Error& error) {
        EXPECT_HOLDS(error.way_out(), "json-bytes=");
    }
}

}  // namespace
}  // namespace cairn::scenes
