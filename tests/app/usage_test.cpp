// The command's answers to right and wrong usage, to bad files, bad places and bad drivers.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/command.h"
#include "tests/support/gltf_file.h"
#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

using Arguments = std::vector<std::string>;

void expect_contains(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in:\n" << text;
}

/// Checks that an error is on stderr, on one or two lines, and that stdout is empty.
void expect_error(const Answer& answer, int code, const std::string& part) {
    EXPECT_EQ(answer.code, code) << answer;
    EXPECT_EQ(answer.out, "");
    EXPECT_TRUE(answer.err.starts_with("error: ")) << answer;
    EXPECT_LE(std::count(answer.err.begin(), answer.err.end(), '\n'), 2) << answer;
    expect_contains(answer.err, part);
}

TEST(AppUsage, HelpNamesEveryVerbAndBuiltinScene) {
    const Answer answer = cairn({"--help"});
    EXPECT_EQ(answer.code, 0) << answer;
    EXPECT_EQ(answer.err, "");
    for (const char* word : {"info", "voxelize", "check", "render", "export", "builtin:knot", "builtin:ball",
                             "builtin:fractal", "builtin:sponge", "Exit codes"}) {
        expect_contains(answer.out, word);
    }
}

TEST(AppUsage, SetsByTheirFormulaAreKnownToEveryVerb) {
    for (const char* set : {"builtin:fractal", "builtin:sponge"}) {
        const nlohmann::json figures = cairn_json({"info", set});
        EXPECT_TRUE(figures["bounds_low"].is_array()) << figures;
        expect_contains(cairn({"voxelize", set, "-r", "16"}).err, "this verb needs surfaces");
        EXPECT_EQ(cairn({"voxelize", set, "-r", "16"}).code, 2);
        EXPECT_EQ(cairn({"shadow", set, "--method", "voxel"}).code, 2);
    }
}

TEST(AppUsage, EveryVerbHasHelpThatFitsATerminal) {
    for (const char* verb : {"info", "voxelize", "check", "render", "export"}) {
        const Answer answer = cairn({verb, "--help"});
        EXPECT_EQ(answer.code, 0) << answer;
        expect_contains(answer.out, "--json");
        std::istringstream lines(answer.out);
        for (std::string line; std::getline(lines, line);)
            EXPECT_LE(line.size(), 100U) << verb << ": " << line;
    }
}

TEST(AppUsage, VersionIsTheProjects) {
    EXPECT_EQ(cairn({"--version"}).out, "cairn " CAIRN_VERSION "\n");
}

struct Wrong {
    Arguments arguments;
    std::string error;  ///< part of the message
};
void PrintTo(const Wrong& wrong, std::ostream* out) {
    for (const std::string& argument : wrong.arguments)
        *out << argument << ' ';
}

class AppWrongUsage : public ::testing::TestWithParam<Wrong> {};

TEST_P(AppWrongUsage, IsRefusedWithCode2) {
    expect_error(cairn(GetParam().arguments), 2, GetParam().error);
}

Arguments with(Arguments arguments, const Arguments& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}
Arguments render(const Arguments& more) {
    return with({"render", "builtin:cornell"}, more);
}
Arguments voxelize(const Arguments& more) {
    return with({"voxelize", "builtin:cornell"}, more);
}

INSTANTIATE_TEST_SUITE_P(
    Verbs, AppWrongUsage,
    ::testing::Values(
        Wrong{{}, "a verb is missing"}, Wrong{{"frobnicate"}, "there is no verb \"frobnicate\""},
        Wrong{{"shade", "builtin:knot"}, "there is no verb \"shade\""}, Wrong{{"--nonsense"}, "--nonsense"},
        Wrong{{"info"}, "SCENE is required"}, Wrong{{"info", "a.glb", "b.glb"}, "b.glb"},
        Wrong{{"info", "builtin:nothing"}, "knot"}, Wrong{{"export", "builtin:knot"}, "--output is required"},
        Wrong{{"info", "builtin:knot", "--animation", "walk"}, "no animation \"walk\""},
        Wrong{{"info", "builtin:knot", "--animation", "0"}, "no animation \"0\""},
        Wrong{{"info", "builtin:knot", "--scene-index", "7"}, "7"},
        Wrong{{"info", "builtin:knot", "--scene-index", "-1"}, "--scene-index"},
        Wrong{{"info", "builtin:knot", "--time", "soon"}, "--time: \"soon\" is not a number"},
        Wrong{{"info", "builtin:knot", "--time"}, "--time takes one value"},
        Wrong{{"info", "builtin:knot", "--json", "/nowhere/at/all.json"}, "/nowhere/at/all.json"}));

INSTANTIATE_TEST_SUITE_P(
    Voxelize, AppWrongUsage,
    ::testing::Values(
        Wrong{voxelize({}), "--resolution or --voxel-size is required"},
        Wrong{{"check", "builtin:cornell"}, "--resolution or --voxel-size is required"},
        Wrong{voxelize({"-r", "8", "--voxel-size", "1"}), "cannot go with --resolution"},
        Wrong{voxelize({"-r", "8,9"}), "has 2 numbers, not 1 or 3"},
        Wrong{voxelize({"-r", "8,9,10,11"}), "has 4 numbers, not 1 or 3"},
        Wrong{voxelize({"-r", "8,,10"}), "\"\" is not a whole number"},
        Wrong{voxelize({"-r", "8,9,0"}), "from 1 to 65536"},
        Wrong{voxelize({"-r", "8,9,65537"}), "from 1 to 65536"},
        Wrong{voxelize({"-r", "65537"}), "from 1 to 65536"},
        Wrong{voxelize({"--voxel-size", "0"}), "not above 0"},
        Wrong{voxelize({"--voxel-size", "-1"}), "not above 0"},
        Wrong{voxelize({"--voxel-size", "1m"}), "\"1m\" is not a number"},
        Wrong{voxelize({"--voxel-size", "1e-7"}), "more than 65536 along an axis"},
        Wrong{voxelize({"--voxel-size", "1e-7", "--bounds", "0,0,0,1,1,1"}), "would fit"},
        Wrong{voxelize({"-r", "0"}), "from 1 to"}, Wrong{voxelize({"-r", "-5"}), "from 1 to"},
        Wrong{voxelize({"-r", "16x"}), "\"16x\""}, Wrong{voxelize({"-r", "16.5"}), "\"16.5\""},
        Wrong{voxelize({"-r", ""}), "--resolution"},
        Wrong{voxelize({"-r", "99999999999999999999"}), "from 1 to"},
        Wrong{voxelize({"-r", "8", "-r", "16"}), "takes one value"},
        Wrong{voxelize({"-r", "8", "--bounds", "0,0,0,1,1"}), "has 5 of the 6"},
        Wrong{voxelize({"-r", "8", "--bounds", "0,0,0,1,1,x"}), "\"x\" is not a number"},
        Wrong{voxelize({"-r", "8", "--bounds", "0,0,0,1,1,nan"}), "not finite"},
        Wrong{voxelize({"-r", "8", "--bounds", "0,0,0,inf,1,1"}), "not finite"},
        Wrong{voxelize({"-r", "8", "--bounds", "0,2,0,1,1,1"}), "Y0 = 2 is not less than Y1 = 1"},
        Wrong{voxelize({"-r", "8", "--method", "cubes"}),
              "choose one of: conservative, slice-map, three-axis, three-axis-conservative"},
        Wrong{voxelize({"-r", "8", "--fill", "half"}), "choose surface, winding, solid, parity or outside"},
        Wrong{voxelize({"-r", "8", "--doubtful", "d.npy"}),
              "voxels that the surface touches are not in doubt"},
        Wrong{voxelize({"-r", "8", "--fill", "outside", "--doubtful", "d.npy"}),
              "what the outside cannot reach is not in doubt"},
        Wrong{voxelize({"-r", "8", "--context", "vulkan"}), "auto, osmesa or egl"},
        Wrong{voxelize({"-r", "8", "--shader-dir", "/nowhere"}), "is not a folder"},
        Wrong{voxelize({"-r", "8", "-o", "voxels.ply"}), "what this verb writes ends in .npy"},
        Wrong{voxelize({"-r", "8", "-o", "voxels"}), ".npy"}));

INSTANTIATE_TEST_SUITE_P(
    Render, AppWrongUsage,
    ::testing::Values(Wrong{render({"--size", "512"}), "is not WIDTHxHEIGHT"},
                      Wrong{render({"--size", "0x4"}), "from 1 to"},
                      Wrong{render({"--size", "4x16385"}), "16384"},
                      Wrong{render({"--size", "4x4x4"}), "WIDTHxHEIGHT"},
                      Wrong{render({"--camera", "1,2,3"}), "has 3 of the 6 or 7"},
                      Wrong{render({"--camera", "1,2,3,1,2,3"}), "the same point"},
                      Wrong{render({"--camera", "0,0,5,0,0,0,180"}), "field of view"},
                      Wrong{render({"--camera", "0,0,5,0,0,0,0"}), "field of view"},
                      Wrong{render({"--light", "1,2"}), "has 2 of the 3"},
                      Wrong{render({"--light", "1,2,3,-0.5"}), "negative"},
                      Wrong{render({"--shadow", "blurred"}), "choose none, hard or soft"},
                      Wrong{render({"--max-resolution", "0"}), "--max-resolution"},
                      Wrong{render({"--brick-pool", "lots"}), "--brick-pool"},
                      Wrong{render({"--tree-n", "9"}), "from 2 to 8"},
                      Wrong{render({"--tree-n", "5"}), "N = 5"}, Wrong{render({"--brick-m", "12"}), "M = 12"},
                      Wrong{render({"--brick-m", "7"}), "from 8 to 81"},
                      Wrong{render({"--brick-m", "64", "--max-resolution", "32"}), "less than a brick, 64"},
                      Wrong{render({"--traversal", "random"}), "restart, stackless or mini-stack"},
                      Wrong{render({"--tile-queries", "all"}), "list or blocks"},
                      Wrong{render({"--tile-queries", "blocks", "--frame-budget", "5"}), "choose lists"},
                      Wrong{render({"--frame-budget", "-1"}), "between 0"},
                      Wrong{render({"--frame-budget", "soon"}), "is not a number"},
                      Wrong{render({"--steps-per-voxel", "2"}), "the scene is no volume"},
                      Wrong{render({"--gradient-threshold", "0.1"}), "the scene is no volume"},
                      Wrong{{"render", "builtin:ball", "--steps-per-voxel", "33"}, "from 1 to 32"},
                      Wrong{{"render", "builtin:ball", "--gradient-threshold", "2"}, "between 0 and 1"},
                      Wrong{{"render", "builtin:sponge", "--tree-n", "2"}, "choose N = 3"},
                      Wrong{{"render", "builtin:fractal", "--tree-n", "3"}, "choose N = 2, 4 or 8"},
                      Wrong{{"shadow", "builtin:knot", "--method", "voxel", "--tree-n", "2"}, "--tree-n"},
                      Wrong{render({"-o", "picture.jpg"}), "what this verb writes ends in .png"}));

TEST(AppInput, MissingFileIsCode3) {
    expect_error(cairn({"info", "no-such-file.glb"}), 3, "no-such-file.glb");
}

TEST(AppInput, DamagedFilesAreCode3AndLeaveNoOutput) {
    const ScratchFolder folder;
    ASSERT_EQ(cairn({"export", "builtin:cornell", "-o", folder.file("whole.glb"), "--quiet"}).code, 0);
    const std::string whole = read_text(folder.file("whole.glb"));
    write_text(folder.file("cut.glb"), whole.substr(0, whole.size() / 2));
    write_text(folder.file("empty.glb"), "");
    write_text(folder.file("noise.glb"), "this is not a glTF file at all");
    write_text(folder.file("half.gltf"), "{\"asset\": {\"version\": \"2.0\"}, ");
    const std::size_t before = folder.file_count();
    for (const char* name : {"cut.glb", "empty.glb", "noise.glb", "half.gltf"}) {
        expect_error(cairn({"info", folder.file(name)}), 3, name);
        expect_error(cairn({"voxelize", folder.file(name), "-r", "8", "-o", folder.file("out.npy")}), 3,
                     name);
        expect_error(cairn({"export", folder.file(name), "-o", folder.file("out.glb")}), 3, name);
        expect_error(cairn({"render", folder.file(name), "-o", folder.file("out.png"), "--json",
                            folder.file("out.json")}),
                     3, name);
        EXPECT_EQ(folder.file_count(), before) << name << " left something behind";
    }
}

TEST(AppInput, APathThatIsNotTrustedNamesTheOptionThatTrustsIt) {
    const ScratchFolder folder;
    write_text(
        folder.path() / "away.gltf",
        R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                   "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
                   "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                                  "min": [0, 0, 0], "max": [1, 1, 1]}],
                   "bufferViews": [{"buffer": 0, "byteLength": 36}],
                   "buffers": [{"uri": "../away.bin", "byteLength": 36}]})");
    expect_error(cairn({"info", folder.file("away.gltf")}), 3,
                 "if you trust the file, allow it with --trust-paths");
}

TEST(AppUsage, AMethodThatDoesNotExistIsNamedWithItsOption) {
    expect_error(cairn({"voxelize", "builtin:cornell", "-r", "8", "--method", "cubes"}), 2,
                 "--method: there is no method \"cubes\"");
}

TEST(AppInput, ControlCharactersOfAFileStayOutOfTheTerminal) {
    const ScratchFolder folder;
    GltfFile file;
    file.add_root({{"name", "only"}});
    file.json["scenes"][0]["name"] = "evil \x1b[31m red";
    file.write_gltf(folder.file("evil.gltf"));
    const Answer answer = cairn({"info", folder.file("evil.gltf")});
    EXPECT_EQ(answer.code, 0) << answer;
    EXPECT_EQ(answer.out.find('\x1b'), std::string::npos) << answer;
}

TEST(AppOutput, AFolderThatIsMissingIsSaidBeforeTheWork) {
    const ScratchFolder folder;
    for (const Arguments& arguments :
         {Arguments{"voxelize", "builtin:knot", "-r", "8", "-o", folder.file("no/a.npy")},
          Arguments{"render", "builtin:knot", "-o", folder.file("no/a.png")},
          Arguments{"export", "builtin:knot", "-o", folder.file("no/a.glb")},
          Arguments{"info", "builtin:knot", "--json", folder.file("no/a.json")}}) {
        expect_error(cairn(arguments), 2, "No such file or directory");
    }
    EXPECT_EQ(folder.file_count(), 0U);
}

TEST(AppOutput, AFolderIsNoFile) {
    const ScratchFolder folder;
    std::filesystem::create_directory(folder.file("a.glb"));
    expect_error(cairn({"export", "builtin:knot", "-o", folder.file("a.glb")}), 2, "a.glb");
    EXPECT_EQ(folder.file_count(), 1U);
}

TEST(AppOutput, AFailureKeepsTheFileThatWasThere) {
    const ScratchFolder folder;
    write_text(folder.file("kept.npy"), "precious");
    EXPECT_EQ(cairn({"voxelize", "no-such.glb", "-r", "8", "-o", folder.file("kept.npy")}).code, 3);
    EXPECT_EQ(read_text(folder.file("kept.npy")), "precious");
    EXPECT_EQ(folder.file_count(), 1U);
}

TEST(AppOutput, ASymbolicLinkStaysOne) {
    const ScratchFolder folder;
    write_text(folder.file("target.json"), "old");
    std::filesystem::create_symlink("target.json", folder.file("link.json"));
    EXPECT_EQ(cairn({"info", "builtin:cornell", "--quiet", "--json", folder.file("link.json")}).code, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link.json")));
    expect_contains(read_text(folder.file("target.json")), "builtin:cornell");
    EXPECT_EQ(folder.file_count(), 2U);
}

TEST(AppOutput, APipeIsWrittenInPlace) {
    const ScratchFolder folder;
    ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
    // A pipe that is opened for reading and writing does not wait for another process.
    std::fstream pipe(folder.file("pipe"), std::ios::in | std::ios::out);
    ASSERT_TRUE(pipe);
    EXPECT_EQ(cairn({"info", "builtin:cornell", "--quiet", "--json", folder.file("pipe")}).code, 0);
    EXPECT_TRUE(std::filesystem::is_fifo(folder.file("pipe")));
    std::string first;
    pipe >> first;
    EXPECT_EQ(first, "{");
}

TEST(AppOutput, AFullDiskIsNoSuccess) {
    if (!std::filesystem::exists("/dev/full")) return;  // exists on Linux
    const ScratchFolder folder;
    std::filesystem::create_symlink("/dev/full", folder.file("full.npy"));
    for (const Arguments& arguments :
         {Arguments{"info", "builtin:cornell", "--quiet", "--json", "/dev/full"},
          Arguments{"voxelize", "builtin:cornell", "-r", "64", "-o", "/dev/full"},
          Arguments{"voxelize", "builtin:cornell", "-r", "200,190,300", "-o", folder.file("full.npy")}}) {
        const Answer answer = cairn(arguments);
        expect_error(answer, 5, "No space left");
    }
    EXPECT_EQ(folder.file_count(), 1U) << "the link alone stays";
}

TEST(AppOutput, TwoOutputsThatAreOneFileAreRefused) {
    const ScratchFolder folder;
    std::filesystem::create_symlink("a.npy", folder.file("b.npy"));
    const std::string roundabout = (folder.path() / "." / "a.npy").string();
    for (const std::string& other : {folder.file("a.npy"), folder.file("b.npy"), roundabout}) {
        expect_error(
            cairn({"voxelize", "builtin:cornell", "-r", "16", "-o", folder.file("a.npy"), "--json", other}),
            2, "would both write it");
    }
    EXPECT_EQ(folder.file_count(), 1U);
    for (const char* stream : {"-", "/dev/null"})
        EXPECT_EQ(
            cairn({"voxelize", "builtin:cornell", "-r", "16", "-o", "/dev/null", "--json", stream}).code, 0);
}

TEST(AppOutput, AnArrayThatTheDiskCannotHoldIsRefusedBeforeTheWork) {
    const ScratchFolder folder;
    const Answer answer =
        cairn({"voxelize", "builtin:cornell", "-r", "65536", "-o", folder.file("huge.NPY"), "--quiet"});
    expect_error(answer, 5, "262144.0 GiB");
    expect_contains(answer.err, "GiB are free");
    expect_contains(answer.err, ".vdb");
    EXPECT_EQ(folder.file_count(), 0U);
}

/// The environment of a Mesa that offers only OpenGL 3.3, even if another vendor's driver is installed beside
/// it.
const Surroundings old_driver = {
    .environment = {{"MESA_GL_VERSION_OVERRIDE", "3.3"},
                    {"__EGL_VENDOR_LIBRARY_FILENAMES", "/usr/share/glvnd/egl_vendor.d/50_mesa.json"}}};

TEST(AppDriver, EglWorks) {
    const auto figures = cairn_json({"voxelize", "builtin:cornell", "-r", "16", "--context", "egl"});
    EXPECT_EQ(figures.value("backend", ""), "egl") << figures;
}

TEST(AppDriver, WithoutOpenGl45EglNamesTheDriverAndWhatItOffers) {
    const Answer answer = cairn({"voxelize", "builtin:cornell", "-r", "16", "--context", "egl"}, old_driver);
    expect_error(answer, 4, "driver \"");
    expect_contains(answer.err, "4.5 core is needed, it offers 3.3");
    expect_contains(answer.err, "choose --context osmesa");
}

#ifdef CAIRN_HAS_OSMESA
TEST(AppDriver, OsmesaWorks) {
    const auto figures = cairn_json({"voxelize", "builtin:cornell", "-r", "16", "--context", "osmesa"});
    EXPECT_EQ(figures.value("backend", ""), "osmesa") << figures;
}

TEST(AppDriver, WithoutOpenGl45OsmesaNamesTheDriverAndWhatItOffers) {
    const ScratchFolder folder;
    const Answer answer =
        cairn({"voxelize", "builtin:cornell", "-r", "16", "--context", "osmesa", "-o", folder.file("a.npy")},
              old_driver);
    expect_error(answer, 4, "driver \"");
    expect_contains(answer.err, "4.5 core is needed, it offers 3.3");
    EXPECT_EQ(folder.file_count(), 0U);
}
#endif

TEST(AppDriver, InfoNeedsNone) {
    EXPECT_EQ(cairn({"info", "builtin:cornell"}, old_driver).code, 0);
}

TEST(AppDriver, ABrokenShaderIsNamedWithFileAndLine) {
    const ScratchFolder folder;
    std::filesystem::copy(CAIRN_SHADER_DIR, folder.file("shaders"), std::filesystem::copy_options::recursive);
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.file("shaders"))) {
        if (!entry.path().string().ends_with(".comp.glsl")) continue;
        std::ofstream(entry.path(), std::ios::app) << "\nint broken = no_such_name;\n";
    }
    const Answer answer =
        cairn({"voxelize", "builtin:cornell", "-r", "16", "--shader-dir", folder.file("shaders")});
    EXPECT_EQ(answer.code, 4) << answer;
    expect_contains(answer.err, ".comp.glsl:");
    expect_contains(answer.err, "no_such_name");
}

}  // namespace
}  // namespace cairn::test
