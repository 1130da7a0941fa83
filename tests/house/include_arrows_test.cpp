// Which folder may include which: every #include is checked against a table.

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "tests/support/scratch_folder.h"

namespace {

namespace fs = std::filesystem;

/// The project's headers that the files of a folder may include. Every name is the beginning of a path from
/// the project's root.
struct Folder {
    std::string_view name;
    std::vector<std::string_view> may_include;
    bool with_subfolders = true;
};

/// Rooms of the command and of the benchmarks, which may include every library.
std::vector<std::string_view> and_all_libraries(std::vector<std::string_view> rooms) {
    rooms.insert(rooms.end(), {"renderer/", "reference/", "voxelizer/", "optics/", "scenes/", "gl/",
                               "shaders/interop/", "base/"});
    return rooms;
}

const std::vector<Folder> folders = {
    {"shaders/interop/", {"shaders/interop/"}},
    {"shaders/", {"shaders/"}},
    {"base/", {"base/"}},
    {"gl/", {"gl/", "shaders/", "base/"}},
    {"scenes/", {"scenes/", "base/"}},
    {"optics/", {"optics/", "scenes/", "base/"}},
    // The only header of optics/ is the sRGB curve, which voxel files are written with.
    {"voxelizer/", {"voxelizer/", "optics/srgb.h", "gl/", "scenes/", "shaders/interop/", "base/"}},
    // The voxelizer's headers are plain types and the definition of exact voxels, and nothing that the
    // reference judges.
    {"reference/",
     {"reference/", "optics/", "scenes/", "shaders/interop/", "base/", "voxelizer/grid.h",
      "voxelizer/bit_grid.h", "voxelizer/surface/surface.h", "voxelizer/surface/exact_mask.h",
      "voxelizer/surface/surface_attributes.h", "voxelizer/surface/wide_integer.h"}},
    {"renderer/pool/", {"renderer/pool/", "gl/", "shaders/interop/", "base/"}},
    {"renderer/produce/",
     {"renderer/produce/", "renderer/pool/", "voxelizer/", "scenes/", "gl/", "shaders/interop/", "base/"}},
    {"renderer/view/", {"renderer/view/", "renderer/pool/", "optics/", "shaders/interop/", "base/"}},
    {"renderer/mesh/",
     {"renderer/mesh/", "voxelizer/", "optics/", "scenes/", "gl/", "shaders/interop/", "base/"}},
    {"renderer/march/",
     {"renderer/march/", "renderer/view/", "renderer/produce/", "renderer/pool/", "voxelizer/grid.h", "gl/",
      "shaders/interop/", "base/"}},
    {"renderer/frame/",
     {"renderer/frame/", "renderer/march/", "renderer/view/", "renderer/mesh/", "renderer/produce/",
      "renderer/pool/", "optics/", "gl/", "shaders/interop/", "base/"}},
    {"renderer/shadow/",
     {"renderer/shadow/", "renderer/march/", "renderer/view/", "renderer/mesh/", "renderer/produce/",
      "renderer/pool/", "voxelizer/", "optics/", "scenes/", "gl/", "shaders/interop/", "base/"}},
    {"renderer/",
     {"renderer/", "voxelizer/", "optics/", "scenes/", "gl/", "shaders/interop/", "base/"},
     false},
    {"app/options/", and_all_libraries({"app/options/"})},
    {"app/terminal/", and_all_libraries({"app/terminal/", "app/options/"})},
    {"app/subject/", and_all_libraries({"app/subject/", "app/terminal/", "app/options/"})},
    {"app/viewer/", and_all_libraries({"app/viewer/", "app/options/"})},
    {"app/verbs/", and_all_libraries({"app/verbs/", "app/viewer/", "app/subject/", "app/terminal/",
                                      "app/options/", "bench/charts/chart.h"})},
    {"app/", and_all_libraries({"app/"}), false},
    {"bench/peers/", and_all_libraries({"bench/peers/"})},
    {"bench/plots/", and_all_libraries({"bench/plots/"})},
    {"bench/trials/", and_all_libraries({"bench/trials/", "bench/peers/", "bench/plots/table.h"})},
    {"bench/charts/", and_all_libraries({"bench/charts/", "bench/trials/", "bench/peers/", "bench/plots/"})},
    {"tests/", {""}},
    {"fuzz/", {""}},
};

/// A library of others that only some places, and tests/, may include.
struct External {
    std::string_view name;
    std::vector<std::string_view> seen_by;
};

// The first entry that a name begins with counts.
const std::vector<External> externals = {
    {"tiny_gltf", {"scenes/gltf/"}},
    {"draco/", {"scenes/gltf/"}},
    {"meshoptimizer", {"scenes/gltf/"}},
    {"embree", {"reference/"}},
    {"GLFW/", {"app/", "gl/window."}},
    {"imgui", {"app/"}},
    {"CLI/", {"app/"}},
    {"EGL/", {"gl/"}},
    {"GL/osmesa", {"gl/"}},
    {"glad/", {"gl/", "voxelizer/", "renderer/", "app/", "bench/"}},
    {"cairn/version.h", {"app/"}},
    {"cairn/", {}},
};

bool begins_with_any(std::string_view path, const std::vector<std::string_view>& beginnings) {
    return std::any_of(beginnings.begin(), beginnings.end(),
                       [&](std::string_view beginning) { return path.starts_with(beginning); });
}

const Folder* folder_of(std::string_view file) {
    for (const Folder& folder : folders) {
        const bool inside = file.starts_with(folder.name);
        const bool directly = file.find('/', folder.name.size()) == std::string_view::npos;
        if (inside && (folder.with_subfolders || directly)) return &folder;
    }
    return nullptr;
}

/// The fault of an #include; empty if there is none.
std::string fault_of(const fs::path& root, const std::string& file, bool quoted, const std::string& name) {
    const Folder* folder = folder_of(file);
    if (folder == nullptr) return "the table names no such folder";
    if (begins_with_any("", folder->may_include)) return {};
    if (!quoted) {
        for (const External& external : externals) {
            if (!name.starts_with(external.name)) continue;
            if (begins_with_any(file, external.seen_by)) return {};
            return external.seen_by.empty()
                       ? fmt::format("<{}> is for users of the library", name)
                       : fmt::format("<{}> is for {} only", name, fmt::join(external.seen_by, " and "));
        }
        return {};
    }
    // Shaders include by paths from shaders/, all other files by paths from the project's root.
    const bool from_shaders = file.starts_with("shaders/") && fs::exists(root / "shaders" / name);
    const std::string path = from_shaders ? "shaders/" + name : name;
    if (!fs::exists(root / path))
        return fmt::format("\"{}\" does not exist, seen from the project's root", name);
    if (begins_with_any(path, folder->may_include)) return {};
    return fmt::format("{} may not include \"{}\"", folder->name, name);
}

/// Every #include of the project's folders that the table does not allow, as "file:line: fault".
std::vector<std::string> violations(const fs::path& root, int* include_count = nullptr) {
    static const std::regex include_line(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
    constexpr std::array top_folders = {"shaders",   "base",     "gl",  "scenes", "optics", "voxelizer",
                                        "reference", "renderer", "app", "tests",  "bench",  "fuzz"};
    std::vector<std::string> found;
    for (const char* top : top_folders) {
        if (!fs::exists(root / top)) continue;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / top)) {
            const std::string extension = entry.path().extension().string();
            if (extension != ".h" && extension != ".cpp" && extension != ".glsl") continue;
            const std::string file = fs::relative(entry.path(), root).generic_string();
            std::ifstream stream(entry.path());
            std::string line;
            for (int number = 1; std::getline(stream, line); ++number) {
                std::smatch parts;
                if (!std::regex_search(line, parts, include_line)) continue;
                if (include_count != nullptr) ++*include_count;
                const std::string fault = fault_of(root, file, parts[1] == "\"", parts[2]);
                if (!fault.empty()) found.push_back(fmt::format("{}:{}: {}", file, number, fault));
            }
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

TEST(IncludeArrows, AllPointAlongTheWayOfTheData) {
    int include_count = 0;
    for (const std::string& violation : violations(CAIRN_SOURCE_DIR, &include_count)) {
        ADD_FAILURE() << violation;
    }
    EXPECT_GT(include_count, 100) << "the project was not found under " << CAIRN_SOURCE_DIR;
}

/// A small project on disk.
class FakeTree : public testing::Test {
protected:
    FakeTree() {
        for (const char* file :
             {"base/error.h", "gl/buffer.h", "voxelizer/grid.h", "voxelizer/methods/voxelizer.h",
              "renderer/pool/pool.h", "renderer/march/march.h", "renderer/renderer.h",
              "shaders/interop/march.h", "shaders/march/march.glsl", "reference/exact.h"}) {
            add(file, "#pragma once\n");
        }
    }
    void add(const std::string& file, const std::string& text) const {
        cairn::test::write_text(folder_.path() / file, text);
    }
    [[nodiscard]] std::vector<std::string> found() const { return violations(folder_.path()); }

private:
    cairn::test::ScratchFolder folder_;
};

TEST_F(FakeTree, WithArrowsAlongTheWayHasNoViolation) {
    add("gl/buffer.cpp", "#include \"gl/buffer.h\"\n#include <vector>\n#include \"base/error.h\"\n");
    add("gl/window.cpp", "#include <GLFW/glfw3.h>\n");
    add("renderer/renderer.cpp",
        "#include \"renderer/march/march.h\"\n#include \"voxelizer/methods/voxelizer.h\"\n");
    add("reference/exact.cpp", "#include <embree3/rtcore.h>\n#include \"voxelizer/grid.h\"\n");
    add("shaders/march/shadow.comp.glsl", "#include \"march/march.glsl\"\n#include \"interop/march.h\"\n");
    add("tests/a_test.cpp",
        "#include \"reference/exact.h\"\n#include \"fixture.h\"\n#include <tiny_gltf.h>\n");
    EXPECT_EQ(found(), std::vector<std::string>{});
}

TEST_F(FakeTree, WithArrowsAgainstTheWayNamesFileAndLine) {
    add("base/error.cpp", "\n#include \"gl/buffer.h\"\n");
    add("gl/buffer.cpp", "#include \"gl/buffer.h\"\n// a comment\n  #  include \"voxelizer/grid.h\"\n");
    add("reference/exact.cpp", "#include \"voxelizer/methods/voxelizer.h\"\n");
    add("renderer/pool/pool.cpp", "#include \"renderer/march/march.h\"\n");
    add("renderer/extra/extra.cpp", "#include \"renderer/pool/pool.h\"\n");
    add("shaders/interop/surface.h", "#include \"march/march.glsl\"\n");
    add("voxelizer/grid.cpp", "#include \"grid.h\"\n#include \"reference/exact.h\"\n");
    const std::vector<std::string> expected = {
        "base/error.cpp:2: base/ may not include \"gl/buffer.h\"",
        "gl/buffer.cpp:3: gl/ may not include \"voxelizer/grid.h\"",
        "reference/exact.cpp:1: reference/ may not include \"voxelizer/methods/voxelizer.h\"",
        "renderer/extra/extra.cpp:1: the table names no such folder",
        "renderer/pool/pool.cpp:1: renderer/pool/ may not include \"renderer/march/march.h\"",
        "shaders/interop/surface.h:1: shaders/interop/ may not include \"march/march.glsl\"",
        "voxelizer/grid.cpp:1: \"grid.h\" does not exist, seen from the project's root",
        "voxelizer/grid.cpp:2: voxelizer/ may not include \"reference/exact.h\"",
    };
    EXPECT_EQ(found(), expected);
}

TEST_F(FakeTree, WithRoomsThatLookUpNamesThem) {
    for (const char* header : {"app/options/options.h", "app/verbs/verbs.h", "bench/charts/chart.h",
                               "bench/plots/table.h", "bench/trials/chart.h"})
        add(header, "#pragma once\n");
    add("app/main.cpp", "#include \"app/verbs/verbs.h\"\n");
    add("app/options/options.cpp", "#include \"app/verbs/verbs.h\"\n#include \"renderer/renderer.h\"\n");
    add("app/verbs/verb_bench.cpp", "#include \"bench/charts/chart.h\"\n#include \"bench/trials/chart.h\"\n");
    add("bench/charts/chart.cpp", "#include \"bench/plots/table.h\"\n#include \"bench/trials/chart.h\"\n");
    add("bench/plots/table.cpp", "#include \"bench/charts/chart.h\"\n");
    add("bench/stray.cpp", "#include \"bench/plots/table.h\"\n");
    add("bench/trials/chart.cpp", "#include \"bench/charts/chart.h\"\n");
    const std::vector<std::string> expected = {
        "app/options/options.cpp:1: app/options/ may not include \"app/verbs/verbs.h\"",
        "app/verbs/verb_bench.cpp:2: app/verbs/ may not include \"bench/trials/chart.h\"",
        "bench/plots/table.cpp:1: bench/plots/ may not include \"bench/charts/chart.h\"",
        "bench/stray.cpp:1: the table names no such folder",
        "bench/trials/chart.cpp:1: bench/trials/ may not include \"bench/charts/chart.h\"",
    };
    EXPECT_EQ(found(), expected);
}

TEST_F(FakeTree, WithALibraryWhereItIsNotMeantToBeSeenNamesIt) {
    add("app/main.cpp", "#include <GLFW/glfw3.h>\n#include <embree4/rtcore.h>\n#include <tiny_gltf.h>\n");
    add("gl/context.cpp", "#include <GLFW/glfw3.h>\n");
    const std::vector<std::string> expected = {
        "app/main.cpp:2: <embree4/rtcore.h> is for reference/ only",
        "app/main.cpp:3: <tiny_gltf.h> is for scenes/gltf/ only",
        "gl/context.cpp:1: <GLFW/glfw3.h> is for app/ and gl/window. only",
    };
    EXPECT_EQ(found(), expected);
}

}  // namespace
