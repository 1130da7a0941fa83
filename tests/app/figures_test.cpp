// The figures of the command: their names, their values, and that text and JSON agree.

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/command.h"
#include "tests/support/gltf_file.h"
#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

void expect_keys(const Json& figures, const std::vector<std::string>& keys) {
    for (const std::string& key : keys)
        EXPECT_TRUE(figures.contains(key)) << key << " is not in " << figures.dump();
}

/// Writes points as a glTF file, with its .bin beside it.
void write_points(const std::string& path, const std::vector<float>& xyz) {
    GltfFile file;
    file.add_mesh({{"mode", 0}, {"attributes", {{"POSITION", file.add_accessor(xyz, "VEC3")}}}});
    file.json["accessors"][0]["min"] = {-100, -100, -100};
    file.json["accessors"][0]["max"] = {100, 100, 100};
    file.write_gltf(path);
}

/// Writes a triangle with two animations: "slide" moves it along x by 10 per second, "rise" along y by 4.
void write_animated(const std::string& path) {
    GltfFile file;
    const int positions = file.add_accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    file.json["accessors"][0]["min"] = {0, 0, 0};
    file.json["accessors"][0]["max"] = {1, 1, 0};
    const int node = file.add_mesh({{"attributes", {{"POSITION", positions}}}});
    const int times = file.add_accessor<float>({0, 1}, "SCALAR");
    const auto add_animation = [&](const char* name, const std::vector<float>& translations) {
        const int values = file.add_accessor(translations, "VEC3");
        file.add("animations",
                 {{"name", name},
                  {"samplers", Json::array({{{"input", times}, {"output", values}}})},
                  {"channels",
                   Json::array({{{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}}})}});
    };
    add_animation("slide", {0, 0, 0, 10, 0, 0});
    add_animation("rise", {0, 0, 0, 0, 4, 0});
    file.write_gltf(path);
}

/// A .npy file of bytes: https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html, version 1.0.
struct Npy {
    std::string header;
    std::vector<std::size_t> shape;
    std::string values;

    explicit Npy(const std::string& path) {
        const std::string file = read_text(path);
        if (!file.starts_with(std::string("\x93NUMPY\x01\x00", 8)))
            throw std::runtime_error("no .npy of version 1.0");
        const std::size_t length = std::size_t(std::uint8_t(file[8])) + 256U * std::uint8_t(file[9]);
        header = file.substr(10, length);
        values = file.substr(10 + length);
        const std::regex numbers(R"('shape': \((\d+), (\d+), (\d+)\))");
        std::smatch match;
        if (!std::regex_search(header, match, numbers)) throw std::runtime_error("no shape in " + header);
        for (std::size_t i = 1; i <= 3; ++i)
            shape.push_back(std::stoul(match[i]));
    }
    [[nodiscard]] int at(std::size_t x, std::size_t y, std::size_t z) const {
        return values[(x * shape[1] + y) * shape[2] + z];
    }
};

TEST(AppFigures, EveryFigureOfTheTextIsInTheJson) {
    const ScratchFolder folder;
    const std::vector<std::vector<std::string>> runs = {
        {"info", "builtin:cornell"},
        {"voxelize", "builtin:cornell", "-r", "16", "-o", folder.file("a.npy")},
        {"check", "builtin:cornell", "-r", "16"},
        {"render", "builtin:cornell", "--size", "32x32", "-o", folder.file("a.png")},
        {"export", "builtin:cornell", "-o", folder.file("a.glb")}};
    for (std::vector<std::string> run : runs) {
        run.insert(run.end(), {"--json", folder.file("figures.json")});
        const Answer answer = cairn(run);
        ASSERT_EQ(answer.code, 0) << answer;
        const Json figures = Json::parse(read_text(folder.file("figures.json")));
        std::size_t labelled = 0;
        std::istringstream lines(answer.out);
        for (std::string line; std::getline(lines, line);)
            labelled += line.starts_with(' ') ? 0 : 1;
        EXPECT_EQ(labelled, figures.size()) << answer << figures.dump(2);
    }
}

TEST(AppFigures, JsonOnStdoutStandsAlone) {
    const Answer answer = cairn({"info", "builtin:cornell", "--json", "-"});
    EXPECT_EQ(answer.json().value("scene", ""), "builtin:cornell");
    EXPECT_EQ(answer.err, "");
}

TEST(AppFigures, QuietSaysNothing) {
    const ScratchFolder folder;
    for (const std::vector<std::string>& run :
         {std::vector<std::string>{"info", "builtin:cornell", "--quiet"},
          {"voxelize", "builtin:cornell", "-r", "16", "--quiet"},
          {"render", "builtin:cornell", "--size", "16x16", "-o", folder.file("a.png"), "--quiet"}}) {
        const Answer answer = cairn(run);
        EXPECT_EQ(answer.code, 0) << answer;
        EXPECT_EQ(answer.out + answer.err, "") << answer;
    }
}

TEST(AppInfo, CountsWhatTheSceneHolds) {
    const Json knot = cairn_json({"info", "builtin:knot"});
    EXPECT_EQ(knot["triangles"], 52992);
    EXPECT_EQ(knot["triangles_in_file"], 52992);
    const Json spheres = cairn_json({"info", "builtin:spheres"});
    EXPECT_EQ(spheres["triangles"], 6848);
    EXPECT_LT(spheres["triangles_in_file"], 6848) << "shared meshes count once";
    expect_keys(knot, {"scenes", "nodes", "meshes", "lines", "points", "materials", "textures", "images",
                       "images_used", "animations", "skins", "morph_targets", "lights", "cameras",
                       "bounds_low", "bounds_high", "warnings"});
}

TEST(AppInfo, AnEmptySceneHasNoBounds) {
    const ScratchFolder folder;
    write_text(folder.file("empty.gltf"), R"({"asset": {"version": "2.0"}, "scenes": [{}], "scene": 0})");
    const Json figures = cairn_json({"info", folder.file("empty.gltf")});
    EXPECT_EQ(figures["triangles"], 0);
    EXPECT_TRUE(figures["bounds_low"].is_null()) << figures;
}

TEST(AppInfo, ShowsTheMomentThatWasAskedFor) {
    const ScratchFolder folder;
    const std::string path = folder.file("animated.gltf");
    write_animated(path);
    const auto low_of = [&](const std::vector<std::string>& options) {
        std::vector<std::string> run = {"info", path};
        run.insert(run.end(), options.begin(), options.end());
        return cairn_json(run)["bounds_low"];
    };
    EXPECT_EQ(low_of({}), Json({0.0, 0.0, 0.0}));
    EXPECT_EQ(low_of({"--time", "0.5"}), Json({5.0, 0.0, 0.0})) << "the first animation plays";
    EXPECT_EQ(low_of({"--time", "0.5", "--animation", "rise"}), Json({0.0, 2.0, 0.0}));
    EXPECT_EQ(low_of({"--time", "0.5", "--animation", "1"}), Json({0.0, 2.0, 0.0}));
    EXPECT_EQ(low_of({"--time", "99"}), Json({10.0, 0.0, 0.0})) << "past the end, the last key stays";
    const Json animations = cairn_json({"info", path})["animations"];
    ASSERT_EQ(animations.size(), 2U);
    EXPECT_EQ(animations[1]["name"], "rise");
    EXPECT_EQ(animations[1]["seconds"], 1.0);
}

TEST(AppInfo, WarnsWhenTimeChangesNothing) {
    const Answer answer = cairn({"info", "builtin:cornell", "--time", "1"});
    EXPECT_EQ(answer.code, 0) << answer;
    EXPECT_TRUE(answer.err.starts_with("warning: --time")) << answer;
}

TEST(AppInfo, OptionalExtensionsThatAreNotSupportedAreWarnings) {
    const ScratchFolder folder;
    GltfFile file;
    file.json["extensionsUsed"] = {"XYZ_sparkle"};
    file.add_root({{"name", "only"}});
    file.write_gltf(folder.file("a.gltf"));
    const Answer answer = cairn({"info", folder.file("a.gltf")});
    EXPECT_EQ(answer.code, 0) << answer;
    EXPECT_TRUE(answer.err.starts_with("warning: ")) << answer;
    EXPECT_NE(answer.err.find("XYZ_sparkle"), std::string::npos) << answer;

    file.json["extensionsRequired"] = {"XYZ_sparkle"};
    file.write_gltf(folder.file("b.gltf"));
    const Answer refusal = cairn({"info", folder.file("b.gltf")});
    EXPECT_EQ(refusal.code, 3) << refusal;
    EXPECT_NE(refusal.err.find("XYZ_sparkle"), std::string::npos) << refusal;
}

TEST(AppVoxelize, NpyHoldsTheVoxelsAsXyz) {
    const ScratchFolder folder;
    write_points(folder.file("points.gltf"), {1.5F, 0.5F, 0.5F, 1.5F, 4.5F, 0.5F, 1.5F, 4.5F, 6.5F});
    const Json figures = cairn_json({"voxelize", folder.file("points.gltf"), "-r", "8", "--bounds",
                                     "0,0,0,8,8,8", "-o", folder.file("points.npy")});
    EXPECT_EQ(figures["occupied"], 3);
    EXPECT_EQ(figures["resolution"], 8);
    EXPECT_EQ(figures["origin"], Json({0.0, 0.0, 0.0}));
    EXPECT_EQ(figures["voxel_size"], 1.0);
    EXPECT_EQ(figures["method"], "conservative");
    expect_keys(figures, {"milliseconds", "driver"});

    const Npy npy(folder.file("points.npy"));
    EXPECT_NE(npy.header.find("'descr': '|u1'"), std::string::npos) << npy.header;
    EXPECT_NE(npy.header.find("'fortran_order': False"), std::string::npos) << npy.header;
    EXPECT_EQ((10 + npy.header.size()) % 64, 0U) << "numpy aligns the values";
    EXPECT_EQ(npy.shape, (std::vector<std::size_t>{8, 8, 8}));
    ASSERT_EQ(npy.values.size(), 512U);
    EXPECT_EQ(std::count(npy.values.begin(), npy.values.end(), 1), 3);
    EXPECT_EQ(std::count(npy.values.begin(), npy.values.end(), 0), 509);
    EXPECT_EQ(npy.at(1, 0, 0), 1);
    EXPECT_EQ(npy.at(1, 4, 0), 1);
    EXPECT_EQ(npy.at(1, 4, 6), 1);
}

TEST(AppVoxelize, DefaultGridLeavesAVoxelFreeAroundTheScene) {
    const ScratchFolder folder;
    const Json figures = cairn_json({"voxelize", "builtin:knot", "-r", "33", "-o", folder.file("knot.npy")});
    const Npy npy(folder.file("knot.npy"));
    ASSERT_EQ(npy.shape, (std::vector<std::size_t>{33, 33, 33}));
    std::int64_t occupied = 0;
    for (std::size_t x = 0; x < 33; ++x) {
        for (std::size_t y = 0; y < 33; ++y) {
            for (std::size_t z = 0; z < 33; ++z) {
                if (npy.at(x, y, z) == 0) continue;
                ++occupied;
                for (const std::size_t i : {x, y, z})
                    EXPECT_TRUE(i > 0 && i < 32) << x << ' ' << y << ' ' << z;
            }
        }
    }
    EXPECT_EQ(figures["occupied"], occupied);
}

TEST(AppVoxelize, AResolutionForEachAxisMakesTheArrayOfThatShape) {
    const ScratchFolder folder;
    write_points(folder.file("points.gltf"), {0.5F, 3.5F, 299.5F, 39.5F, 129.5F, 0.5F});
    const Json figures = cairn_json({"voxelize", folder.file("points.gltf"), "-r", "40,130,300", "--bounds",
                                     "0,0,0,40,130,300", "-o", folder.file("points.npy")});
    EXPECT_EQ(figures["resolution"], Json({40, 130, 300}));
    EXPECT_EQ(figures["voxel_size"], 1.0);
    const Npy npy(folder.file("points.npy"));
    EXPECT_EQ(npy.shape, (std::vector<std::size_t>{40, 130, 300}));
    EXPECT_EQ(std::count(npy.values.begin(), npy.values.end(), 1), 2);
    EXPECT_EQ(npy.at(0, 3, 299), 1);
    EXPECT_EQ(npy.at(39, 129, 0), 1);
    // Three equal numbers mean a cube, too.
    EXPECT_EQ(cairn_json({"voxelize", "builtin:knot", "-r", "20,20,20"})["resolution"], 20);
    EXPECT_EQ(cairn_json({"voxelize", "builtin:knot", "-r", "20,20,20"})["occupied"],
              cairn_json({"voxelize", "builtin:knot", "-r", "20"})["occupied"]);
}

TEST(AppVoxelize, EveryWayToSayTheGridIsExact) {
    const std::vector<std::vector<std::string>> grids = {
        {"-r", "70"},
        {"-r", "130,30,64"},
        {"--voxel-size", "0.05"},
        {"-r", "50", "--bounds", "-.5,-1,-1,.5,1,2"},
        {"-r", "10,20,131", "--bounds", "-.5,-1,-1,.5,1,2"},
        {"--voxel-size", "0.031", "--bounds", "-.5,-1,-1,.5,1,2"}};
    for (std::vector<std::string> run : grids) {
        run.insert(run.begin(), {"check", "builtin:knot"});
        const Json figures = cairn_json(run);
        EXPECT_EQ(figures["missing"], 0) << run[2] << ' ' << run[3];
        EXPECT_EQ(figures["extra"], 0) << run[2] << ' ' << run[3];
        EXPECT_GT(figures["occupied"], 0) << run[2] << ' ' << run[3];
    }
}

TEST(AppVoxelize, EveryFormatIsWrittenFromTheCommandLine) {
    // Several tiles and regions of a grid that is not a cube. Other tests prove that the files are right.
    const ScratchFolder folder;
    for (const std::string name : {"a.npy", "a.binvox", "a.vox", "a.vdb", "B.NPY"}) {
        const std::vector<std::string> run = {"voxelize", "builtin:cornell", "-r",     "150,140,40",
                                              "-o",       folder.file(name), "--json", "-"};
        const Answer answer = cairn(run);
        EXPECT_EQ(answer.code, 0) << answer;
        EXPECT_GT(std::filesystem::file_size(folder.file(name)), 1000U) << name;
        const bool has_attributes = name == "a.vox" || name == "a.vdb";
        EXPECT_EQ(answer.json().contains("attributes_ms"), has_attributes) << answer;
    }
}

TEST(AppVoxelize, SolidFillsWhatIsClosedAndWarnsOfWhatIsNot) {
    // The knot's tube is closed; the Cornell box is five open walls and two closed blocks.
    const Json shell = cairn_json({"voxelize", "builtin:knot", "-r", "150,140,280"});
    const Json solid = cairn_json({"voxelize", "builtin:knot", "-r", "150,140,280", "--fill", "solid"});
    EXPECT_EQ(solid["doubtful_rows"], 0);
    EXPECT_GT(solid["occupied"], 2 * int(shell["occupied"]));
    const Answer open = cairn({"voxelize", "builtin:cornell", "-r", "64", "--fill", "solid", "--json", "-"});
    EXPECT_EQ(open.code, 0) << open;
    EXPECT_NE(open.err.find("rows of voxels"), std::string::npos) << open;
    EXPECT_GT(open.json()["doubtful_rows"], 0) << open;
}

TEST(AppVoxelize, DoubtfulVoxelsAreCountedAndWritten) {
    const ScratchFolder folder;
    const std::string file = folder.file("doubtful.npy");
    // The walls of the Cornell box have no front wall; the outside comes in and reaches all but its blocks.
    const Answer answer = cairn(
        {"voxelize", "builtin:cornell", "-r", "64", "--fill", "parity", "--doubtful", file, "--json", "-"});
    ASSERT_EQ(answer.code, 0) << answer;
    const Json figures = answer.json();
    EXPECT_EQ(figures["fill_rule"], "parity");
    EXPECT_EQ(figures["doubtful_output"], file);
    const std::string written = read_text(file);
    constexpr std::size_t voxels = std::size_t(64) * 64 * 64;
    ASSERT_GT(written.size(), voxels);
    const std::int64_t ones = std::count(written.end() - voxels, written.end(), '\1');
    EXPECT_EQ(ones, int(figures["doubtful_enclosed"]) + int(figures["doubtful_reached"])) << answer;
    const Json outside = cairn_json({"voxelize", "builtin:cornell", "-r", "64", "--fill", "outside"});
    EXPECT_EQ(outside["fill_rule"], "outside");
    EXPECT_FALSE(outside.contains("doubtful_rows"));
    EXPECT_EQ(outside["doubtful_enclosed"], 0);
    const Answer with_gaps = cairn(
        {"voxelize", "builtin:knot", "-r", "64", "--fill", "solid", "--method", "slice-map", "--json", "-"});
    EXPECT_EQ(with_gaps.code, 0) << with_gaps;
    EXPECT_EQ(with_gaps.err, "") << with_gaps;
    EXPECT_TRUE(with_gaps.json()["doubtful_reached"].is_null()) << with_gaps;
}

TEST(AppVoxelize, PlainFilesHaveNoAttributes) {
    const ScratchFolder folder;
    const std::string file = folder.file("plain.vdb");
    const Answer answer =
        cairn({"voxelize", "builtin:cornell", "-r", "64", "--plain", "-o", file, "--json", "-"});
    EXPECT_EQ(answer.code, 0) << answer;
    EXPECT_FALSE(answer.json().contains("attributes_ms")) << answer;
    EXPECT_GT(std::filesystem::file_size(file), 1000U);
}

TEST(AppVoxelize, VoxelSizeIsTheSizeAsked) {
    const Json around = cairn_json({"voxelize", "builtin:cornell", "--voxel-size", "0.25"});
    EXPECT_EQ(around["voxel_size"], 0.25);
    EXPECT_EQ(around["resolution"].size(), 3U) << around;
    const Json over =
        cairn_json({"voxelize", "builtin:cornell", "--voxel-size", "0.5", "--bounds", "-1,-1,-1,1,1.1,0"});
    EXPECT_EQ(over["voxel_size"], 0.5);
    EXPECT_EQ(over["origin"], Json({-1.0, -1.0, -1.0}));
    EXPECT_EQ(over["resolution"], Json({4, 5, 2}));
}

TEST(AppVoxelize, MemoryDoesNotGrowWithTheGrid) {
    // The bits of 2048^3 voxels alone are 1 GiB.
    const Json figures = cairn_json({"voxelize", "builtin:spheres", "-r", "2048"});
    EXPECT_GT(figures["occupied"], 10'000'000);
    EXPECT_GT(figures["regions"], 16);
    EXPECT_LT(figures["peak_rss_bytes"], 640LL << 20);
}

TEST(AppVoxelize, PeakMemoryIsNotThatOfTheProgramThatStartedIt) {
    const ScratchFolder folder;
    const std::string json = folder.file("figures.json");
    const std::vector<char> held(std::size_t(1) << 30U, 'x');
    const pid_t child = fork();
    if (child == 0) {
        execl(CAIRN_COMMAND, "cairn", "voxelize", "builtin:knot", "-r", "16", "--quiet", "--json",
              json.c_str(), nullptr);
        _exit(127);
    }
    int status = -1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_EQ(status, 0);
    const Json figures = Json::parse(read_text(json));
    EXPECT_GT(figures["peak_rss_bytes"], 10LL << 20);
    EXPECT_LT(figures["peak_rss_bytes"], 800LL << 20) << "held by the test: " << held.size();
}

TEST(AppCheck, OfSeveralRegionsFindsNoDifference) {
    const Json figures = cairn_json({"check", "builtin:knot", "-r", "640", "--bounds", "-2,-2,-2,2,2,2"});
    EXPECT_GT(figures["regions"], 1);
    EXPECT_EQ(figures["missing"], 0);
    EXPECT_EQ(figures["extra"], 0);
}

TEST(AppVoxelize, NegativeBoundsAreNoOption) {
    const Json figures = cairn_json({"voxelize", "builtin:knot", "-r", "16", "--bounds", "-.5,-1,-1,.5,1,2"});
    EXPECT_EQ(figures["origin"], Json({-0.5, -1.0, -1.0}));
    EXPECT_EQ(figures["voxel_size"], 3.0 / 16.0) << "the longest side decides";
}

TEST(AppVoxelize, BothDriversGiveTheSameBits) {
    const ScratchFolder folder;
    ASSERT_EQ(
        cairn({"voxelize", "builtin:spheres", "-r", "50", "--context", "egl", "-o", folder.file("egl.npy")})
            .code,
        0);
    ASSERT_EQ(cairn({"voxelize", "builtin:spheres", "-r", "50", "-o", folder.file("default.npy")}).code, 0);
    EXPECT_EQ(read_text(folder.file("egl.npy")), read_text(folder.file("default.npy")));
}

TEST(AppCheck, FindsNoDifference) {
    for (const char* scene : {"builtin:knot", "builtin:cornell", "builtin:needles"}) {
        const Json figures = cairn_json({"check", scene, "-r", "48"});
        EXPECT_EQ(figures["missing"], 0) << scene;
        EXPECT_EQ(figures["extra"], 0) << scene;
        EXPECT_GT(figures["occupied"], 0) << scene;
        expect_keys(figures, {"driver", "milliseconds"});
    }
}

TEST(AppCheck, TellsAWrongVoxelizationApart) {
    // A voxelizer broken on purpose: it writes no bit.
    const ScratchFolder folder;
    std::filesystem::copy(CAIRN_SHADER_DIR, folder.file("shaders"), std::filesystem::copy_options::recursive);
    int spoilt = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.file("shaders/voxelize"))) {
        const std::string text = read_text(entry.path());
        const std::string changed = std::regex_replace(text, std::regex(R"(atomicOr\()"), "atomicAnd(");
        spoilt += changed != text ? 1 : 0;
        write_text(entry.path(), changed);
    }
    ASSERT_GT(spoilt, 0)
        << "no shader of voxelize/ sets bits with atomicOr any more: spoil it in another way";
    const Answer answer = cairn(
        {"check", "builtin:cornell", "-r", "16", "--shader-dir", folder.file("shaders"), "--json", "-"});
    EXPECT_EQ(answer.code, 1) << answer;
    const Json figures = answer.json();
    EXPECT_GT(figures["missing"], 0) << figures;
    ASSERT_TRUE(figures.contains("first_different")) << figures;
    EXPECT_EQ(figures["first_different"][0]["is"], "missing") << figures;
    EXPECT_EQ(figures["first_different"][0]["voxel"].size(), 3U) << figures;
}

TEST(AppExport, WhatIsWrittenReadsTheSame) {
    const ScratchFolder folder;
    for (const char* name : {"knot", "spheres", "cornell", "needles"}) {
        const std::string builtin = std::string("builtin:") + name;
        const std::string path = folder.file(std::string(name) + ".glb");
        const Json written = cairn_json({"export", builtin, "-o", path});
        EXPECT_EQ(written["output_bytes"], std::filesystem::file_size(path));
        Json before = cairn_json({"info", builtin});
        Json after = cairn_json({"info", path});
        for (const char* key : {"triangles", "triangles_in_file", "nodes", "meshes", "materials", "lights",
                                "cameras", "bounds_low", "bounds_high"}) {
            EXPECT_EQ(before[key], after[key]) << name << ": " << key;
        }
    }
}

#ifdef CAIRN_SCENE_DATA
TEST(AppSceneData, ARealSceneGoesThroughEveryVerb) {
    const ScratchFolder folder;
    const std::string path = CAIRN_SCENE_DATA "/gltf/CesiumMan.glb";
    const Json info = cairn_json({"info", path, "--time", "0.7"});
    EXPECT_EQ(info["triangles"], 4672);
    EXPECT_EQ(info["skins"], 1);
    EXPECT_GT(cairn_json({"voxelize", path, "-r", "64", "--time", "0.7"})["occupied"], 0);
    EXPECT_EQ(cairn_json({"check", path, "-r", "64", "--time", "0.7"})["missing"], 0);
    EXPECT_EQ(cairn({"render", path, "--size", "64x64", "--time", "0.7", "-o", folder.file("a.png")}).code,
              0);
}
#endif

}  // namespace
}  // namespace cairn::test
