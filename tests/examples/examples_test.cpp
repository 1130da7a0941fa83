// The examples, run as their users run them, against the library and the reference; and the README, which
// shows a part of one.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "gl/context.h"
#include "optics/camera.h"
#include "reference/exact_voxels.h"
#include "renderer/open_content.h"
#include "renderer/renderer.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "tests/support/scratch_folder.h"
#include "voxelizer/surface/surface.h"

namespace cairn::test {
namespace {

using Color = std::array<int, 3>;

struct Picture {
    int width = 0, height = 0;
    std::vector<Color> pixels;

    [[nodiscard]] const Color& at(int x, int y) const { return pixels[std::size_t(y * width + x)]; }
    [[nodiscard]] std::size_t colors() const { return std::set(pixels.begin(), pixels.end()).size(); }
};

Picture read_ppm(const std::string& path) {
    std::istringstream text(read_text(path));
    Picture picture;
    std::string kind;
    int most = 0;
    text >> kind >> picture.width >> picture.height >> most;
    EXPECT_EQ(kind, "P6");
    EXPECT_EQ(most, 255);
    text.get();
    for (int r = text.get(); text; r = text.get()) {
        const int g = text.get();
        const int b = text.get();
        picture.pixels.push_back({r, g, b});
    }
    EXPECT_EQ(picture.pixels.size(), std::size_t(picture.width) * std::size_t(picture.height));
    return picture;
}

Picture picture_of(const optics::Image& image) {
    Picture picture{image.width, image.height, {}};
    for (std::size_t i = 0; i < image.rgba.size(); i += 4)
        picture.pixels.push_back({image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]});
    return picture;
}

class Examples : public testing::Test {
protected:
    /// Runs an example to its end. @return its output.
    std::string run(const std::string& arguments, const std::string& through = "") {
        const std::string line =
            fmt::format("{} {}/{} >{}", through, CAIRN_EXAMPLES, arguments, folder_.file("out"));
        EXPECT_EQ(std::system(line.c_str()), 0) << line;
        return read_text(folder_.file("out"));
    }
    [[nodiscard]] std::string file(const std::string& name) const { return folder_.file(name); }

private:
    ScratchFolder folder_;
};

optics::Image render_knot(renderer::View view) {
    const auto context = gl::create_context();
    const renderer::ContentSource source("builtin:knot");
    renderer::Renderer renderer(source.content());
    view.camera = optics::framing_camera(source.bounds(), view.size.aspect());
    return renderer.render(view).image;
}

TEST_F(Examples, RenderWritesTheLibrarysPicture) {
    run("render builtin:knot " + file("knot.ppm"));
    const Picture written = read_ppm(file("knot.ppm"));
    EXPECT_EQ(written.pixels, picture_of(render_knot({})).pixels);
    EXPECT_GT(written.colors(), 100U);
}

TEST_F(Examples, RenderNamesAFileThatDoesNotExist) {
    const std::string line =
        fmt::format("{}/render {} {} 2>{}", CAIRN_EXAMPLES, file("no.glb"), file("no.ppm"), file("err"));
    EXPECT_NE(std::system(line.c_str()), 0);
    EXPECT_NE(read_text(file("err")).find("no.glb"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(file("no.ppm")));
}

TEST_F(Examples, VoxelizeToVdbWritesTheExactVoxels) {
    const std::string out = run("voxelize_to_vdb builtin:knot 200 " + file("knot.vdb"));
    const scenes::Scene scene = scenes::load("builtin:knot");
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    const voxelizer::Grid grid = voxelizer::grid_around(snapshot.bounds, 200);
    const voxelizer::Surface surface = voxelizer::build_surface(scene, snapshot, grid);
    const auto voxels = reference::exact_voxels(surface, voxelizer::whole(grid)).count();
    EXPECT_EQ(out, fmt::format("{} voxels\n", voxels));
    const std::string vdb = read_text(file("knot.vdb"));
    EXPECT_EQ(vdb.substr(0, 4), " BDV");
    EXPECT_GT(vdb.size(), voxels / 8);
}

/// The picture shows the example's formula: each side of its wall has a colour, and outside its ball there is
/// nothing.
TEST_F(Examples, OwnProducerShowsItsFormula) {
    const std::string out = run("own_producer " + file("gyroid.ppm"));
    int bricks = 0;
    EXPECT_EQ(std::sscanf(out.c_str(), "%d bricks", &bricks), 1);
    EXPECT_GT(bricks, 64);
    const Picture picture = read_ppm(file("gyroid.ppm"));
    ASSERT_EQ(picture.width, 256);
    ASSERT_EQ(picture.height, 256);
    const Color background = picture.at(0, 0);
    int orange = 0, blue = 0, nothing = 0;
    for (const Color& pixel : picture.pixels) {
        nothing += pixel == background ? 1 : 0;
        orange += pixel != background && pixel[0] > pixel[2] + 30 ? 1 : 0;
        blue += pixel != background && pixel[2] > pixel[0] + 30 ? 1 : 0;
    }
    const int all = 256 * 256;
    EXPECT_GT(orange, all / 20);
    EXPECT_GT(blue, all / 20);
    EXPECT_GT(nothing, all / 4);
    EXPECT_GT(orange + blue + nothing, all * 9 / 10);
    for (int i = 0; i < 256; ++i) {
        for (const Color& edge : {picture.at(i, 0), picture.at(i, 255), picture.at(0, i), picture.at(255, i)})
            EXPECT_EQ(edge, background) << i;
    }
}

#ifdef CAIRN_WITH_XVFB
TEST_F(Examples, InsideGlShowsThePictureBehindTheProgramsTriangle) {
    // GLX unloads its driver before the end, so a leak check cannot tell its leftovers from ours.
    run("inside_gl builtin:knot " + file("inside.ppm"), "ASAN_OPTIONS=detect_leaks=0 " CAIRN_WITH_XVFB);
    const Picture shown = read_ppm(file("inside.ppm"));
    renderer::View view;
    view.size = {320, 240};
    const Picture expected = picture_of(render_knot(view));
    ASSERT_EQ(shown.pixels.size(), expected.pixels.size());
    int triangle = 0;
    for (int y = 0; y < shown.height; ++y) {
        for (int x = 0; x < shown.width; ++x) {
            // From the lower left corner to the middles of the left and of the lower edge.
            const double across =
                (x + 0.5) / (shown.width / 2.0) + (shown.height - y - 0.5) / (shown.height / 2.0);
            if (std::abs(across - 1.0) < 0.02) continue;
            const Color wanted = across < 1.0 ? Color{255, 0, 0} : expected.at(x, y);
            triangle += across < 1.0 ? 1 : 0;
            ASSERT_EQ(shown.at(x, y), wanted) << x << ", " << y;
        }
    }
    EXPECT_GT(triangle, 1000);
}
#endif

/// The lines between two marks, without the marks and the indentation of the first.
std::string marked(const std::string& text, const std::string& begin, const std::string& end) {
    const std::size_t mark = text.find(begin);
    const std::size_t from = mark == std::string::npos ? mark : text.find('\n', mark) + 1;
    const std::size_t to = from == std::string::npos ? from : text.find(end, from);
    if (to == std::string::npos) return "no " + begin + " ... " + end;
    std::istringstream lines(text.substr(from, to - from));
    std::string out;
    std::size_t indent = std::string::npos;
    for (std::string line; std::getline(lines, line);) {
        if (indent == std::string::npos) indent = std::min(line.find_first_not_of(' '), line.size());
        if (line.find_first_not_of(' ') == std::string::npos) continue;
        out += line.substr(std::min(indent, line.find_first_not_of(' '))) + "\n";
    }
    return out;
}

TEST(Readme, ShowsTheExampleAsItIs) {
    const std::filesystem::path root = CAIRN_SOURCE_DIR;
    const std::string example = read_text(root / "examples/render.cpp");
    const std::string shown = marked(read_text(root / "README.md"), "```cpp", "```");
    EXPECT_NE(shown.find(marked(example, "// [README]", "// [/README]")), std::string::npos)
        << "between the marks, the example has\n"
        << marked(example, "// [README]", "// [/README]") << "the README shows\n"
        << shown;
    std::istringstream lines(shown);
    int includes = 0;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("#include")) continue;
        ++includes;
        EXPECT_NE(example.find(line + "\n"), std::string::npos) << line;
    }
    EXPECT_GE(includes, 3);
}

TEST(Readme, MarksAreFoundAndTheirIndentTaken) {
    EXPECT_EQ(marked("a\n  // [B]\n  one\n    two\n\n  // [/B]\n", "// [B]", "// [/B]"), "one\n  two\n");
    EXPECT_EQ(marked("a\n", "// [B]", "// [/B]"), "no // [B] ... // [/B]");
}

TEST(ExampleSources, IncludeOnlyWhatIsInstalled) {
    int includes = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(CAIRN_SOURCE_DIR) / "examples")) {
        std::istringstream lines(read_text(entry.path()));
        for (std::string line; std::getline(lines, line);) {
            if (!line.starts_with("#include \"")) continue;
            ++includes;
            EXPECT_EQ(line, "#include \"image_file.h\"") << entry.path();
        }
    }
    EXPECT_GE(includes, 3);
}

}  // namespace
}  // namespace cairn::test
