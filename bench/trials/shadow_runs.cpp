#include "bench/trials/shadow_runs.h"

#include <utility>

#include "bench/trials/samples.h"

namespace cairn::bench {

ShadowFrames::ShadowFrames(renderer::ShadowMethod method, const ShadowScene& scene,
                           const renderer::ShadowOptions& options, const gl::ShaderSource& shaders)
    : method_(method),
      renderer_(renderer::make_shadow_renderer(method, scene.shadow_scene(method), options, shaders)) {}

ShadowRun ShadowFrames::run(const renderer::View& view) {
    renderer::ShadowPicture picture = renderer_->render(view, {.image = false});
    const bool is_first = std::exchange(is_first_, false);
    const bool is_map = method_ == renderer::ShadowMethod::soft_shadow_map;
    return {is_map ? picture.times.shadow_ms : picture.times.milliseconds, std::move(picture.light.shares),
            is_first || picture.times.has_prepared, is_first};
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
    // N = 2 has the powers of two in between. Bricks of 32 voxels would have them too, but hold and produce
    // more.
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
    // A run this long counts, because the time of compiling is a small part of it.
    if (before.milliseconds > budget_ms && !before.fills_caches) samples_ms_.push_back(before.milliseconds);
    while (samples_ms_.empty() || (int(samples_ms_.size()) < runs && spent_ms_ <= budget_ms))
        samples_ms_.push_back(once().milliseconds);
}

double RepeatedRuns::ms() const {
    return median(samples_ms_);
}

}  // namespace cairn::bench
