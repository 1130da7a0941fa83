#include "bench/trials/shadow_runs.h"

#include <utility>

#include "bench/trials/samples.h"
#include "renderer/mesh/mesh_raster.h"
#include "renderer/open_content.h"

namespace cairn::bench {

std::shared_ptr<renderer::Renderer> shadowing_renderer(const ShadowScene& scene,
                                                       const renderer::TreeOptions& tree,
                                                       const renderer::RendererOptions& options,
                                                       const gl::ShaderSource& shaders) {
    auto made = std::make_shared<renderer::Renderer>(
        renderer::surface_content(scene.scene(), scene.all(), tree, shaders), options, shaders);
    made->set_mix({.meshes = std::make_shared<renderer::MeshRaster>(scene.scene(), scene.all(), shaders),
                   .mesh_shadows = true,
                   .meshes_are_voxelized = true,
                   .voxels_hidden = true});
    return made;
}

ShadowRun shadow_frame(renderer::Renderer& renderer, const renderer::View& view) {
    renderer.forget_picture();
    auto [light, frame] = renderer.light(view);
    return {frame.milliseconds, std::move(light.shares), frame.bricks_produced + frame.nodes_subdivided > 0};
}

ShadowFrames pyramid_frames(const ShadowScene& scene, const renderer::PyramidShadowOptions& options,
                            const gl::ShaderSource& shaders) {
    struct Kept {
        renderer::PyramidShadowRenderer renderer;
        bool is_first = true;
    };
    const auto kept = std::make_shared<Kept>(
        Kept{renderer::PyramidShadowRenderer(scene.scene(), scene.all(), options, shaders)});
    return [kept](const renderer::View& view) {
        optics::LightShares found = kept->renderer.light_shares(view);
        const bool is_first = std::exchange(kept->is_first, false);
        return ShadowRun{kept->renderer.statistics().milliseconds, std::move(found.shares), is_first,
                         is_first};
    };
}

renderer::TreeOptions tree_of(int resolution) {
    renderer::TreeOptions tree;
    tree.max_resolution = resolution;
    if (resolution < 16) {
        tree.m = 8;
        return tree;
    }
    int side = 16;
    while (side * tree.n <= resolution)
        side *= tree.n;
    // N = 2 comes to the powers of two between: bricks of 32 voxels would hold, and produce, twice as much.
    if (side != resolution) tree.n = 2;
    return tree;
}

ShadowRun RepeatedRuns::once() {
    ShadowRun run = run_();
    spent_ms_ += run.milliseconds;
    shares_ = std::move(run.shares);
    if (run.from_nothing) first_ms_ = run.milliseconds;
    return run;
}

void RepeatedRuns::sweep(int runs, double budget_ms) {
    if (!samples_ms_.empty() && (int(samples_ms_.size()) >= runs || spent_ms_ > budget_ms)) return;
    const ShadowRun before = once();
    // What is that long is not repeated for the little that was compiled.
    if (before.milliseconds > budget_ms && !before.fills_caches) samples_ms_.push_back(before.milliseconds);
    while (samples_ms_.empty() || (int(samples_ms_.size()) < runs && spent_ms_ <= budget_ms))
        samples_ms_.push_back(once().milliseconds);
}

double RepeatedRuns::ms() const {
    return median(samples_ms_);
}

}  // namespace cairn::bench
