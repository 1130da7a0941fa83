// A converged frame with hard shadows beside Embree's single rays: same triangles, camera, light and cores,
// in one run.
//
//     render_bench OUT_FOLDER [SCENE ...]
//
// Prints a table and writes OUT_FOLDER/render.csv. The two are measured in turn, so that the ratio holds when
// the machine's speed drifts.
#include <algorithm>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/output_file.h"
#include "gl/context.h"
#include "reference/image.h"
#include "renderer/renderer.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"

namespace {

using namespace cairn;

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

std::string measure(const std::string& path, int size) {
    const std::string name = std::filesystem::path(path).filename().string();
    const scenes::Scene scene = scenes::load(path);
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    renderer::Renderer ours(scene, snapshot);
    renderer::View view;
    view.width = view.height = size;
    view.camera = renderer::framing_camera(snapshot.bounds, 1.0);
    const reference::ReferenceCamera camera{view.camera.eye, view.camera.target, view.camera.up,
                                            view.camera.yfov};
    reference::ReferenceLight light;
    light.towards = view.light.towards;
    reference::ImageTracer embree(scene, snapshot);

    (void)ours.render(view);
    const double first_ms = ours.statistics().milliseconds;
    const std::uint64_t bricks = ours.statistics().bricks_produced;
    std::vector<double> ours_ms;
    std::vector<double> embree_ms;
    std::vector<double> ratio;
    for (int i = 0; i < 7; ++i) {
        (void)ours.render(view);
        ours_ms.push_back(ours.statistics().milliseconds);
        embree_ms.push_back(embree.trace(camera, light, size, size).milliseconds);
        ratio.push_back(ours_ms.back() / embree_ms.back());
    }
    fmt::print(
        "{:<40} {:>5}  first {:>8.1f} ms ({} bricks)  converged {:>7.1f} ms  Embree {:>7.1f} ms  ratio "
        "{:.2f}\n",
        name, size, first_ms, bricks, median(ours_ms), median(embree_ms), median(ratio));
    return fmt::format("{},{},{:.2f},{},{:.2f},{:.2f},{:.3f},\"{}\",{}\n", name, size, first_ms, bricks,
                       median(ours_ms), median(embree_ms), median(ratio), gl::driver_name(),
                       std::thread::hardware_concurrency());
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc < 2) {
        fmt::print(stderr, "usage: render_bench OUT_FOLDER [SCENE ...]\n");
        return 2;
    }
    std::vector<std::string> scenes(argv + 2, argv + argc);
    if (scenes.empty()) scenes = {"builtin:knot", "builtin:spheres", "builtin:tree"};
    const auto context = gl::create_context();
    std::string csv = "scene,size,first_ms,bricks,converged_ms,embree_ms,ratio,driver,threads\n";
    for (const std::string& scene : scenes)
        csv += measure(scene, 512);
    std::filesystem::create_directories(argv[1]);
    OutputFile file(std::filesystem::path(argv[1]) / "render.csv");
    file.write(csv.data(), csv.size());
    file.commit();
    return 0;
} catch (const cairn::Error& error) {
    fmt::print(stderr, "error: {}\n  {}\n", error.what(), error.way_out());
    return 1;
}
