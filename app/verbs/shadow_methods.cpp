#include "app/verbs/shadow_methods.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "app/terminal/measure.h"
#include "app/terminal/progress.h"
#include "optics/srgb.h"
#include "reference/shadow_truth.h"
#include "renderer/shadow_renderer.h"

namespace cairn::app {
namespace {

constexpr float embree_albedo = 0.8F;

/// A grey picture, shaded by the light's middle, as the renderer shades.
optics::Image lit_image(const ShadowTask& task, const reference::ShadowReceivers& receivers,
                        const std::vector<float>& shares) {
    const reference::ReferenceImage& seen = receivers.seen;
    const renderer::View& view = task.view;
    optics::Image image{view.size.width, view.size.height,
                        std::vector<std::uint8_t>(4 * seen.depth.size(), 255)};
    for (std::size_t i = 0; i < seen.depth.size(); ++i) {
        const bool is_there = std::isfinite(seen.depth[i]);
        for (std::size_t c = 0; c < 3; ++c)
            image.rgba[4 * i + c] = optics::srgb8_from_linear(is_there ? embree_albedo * view.light.ambient
                                                                       : view.background[int(c)]);
    }
    for (std::size_t k = 0; k < receivers.pixels.size(); ++k) {
        const double facing =
            glm::dot(receivers.normals[k], optics::direction_to(view.light, receivers.points[k]));
        const float direct = float(facing) * shares[receivers.pixels[k]] * (1.0F - view.light.ambient);
        for (std::size_t c = 0; c < 3; ++c)
            image.rgba[4 * receivers.pixels[k] + c] =
                optics::srgb8_from_linear(embree_albedo * (view.light.ambient + direct));
    }
    return image;
}

}  // namespace

ShadowResult shadow_on_gpu(renderer::ShadowMethod method, const ShadowTask& task,
                           const ShadowOptions& options) {
    // Rays meet all that is shown; soft shadow maps keep occluders and receivers apart.
    renderer::ShadowScene scene{task.input.scene, task.shown};
    if (method == renderer::ShadowMethod::soft_shadow_map) {
        scene.casters = task.occluders;
        scene.receivers = task.receivers;
    }
    const auto shadows =
        renderer::make_shadow_renderer(method, scene,
                                       {.tree = {.max_resolution = tree_resolution(options)},
                                        .renderer = {.pools = options.view.pools},
                                        .pyramid = {.resolution = pyramid_resolution(options)},
                                        .map = options.map},
                                       options.common.driver.shaders);
    Progress progress("shadowing", options.common.report.quiet);
    renderer::ShadowPicture picture =
        shadows->render(task.view, {.light = false, .progress = [&](double share) { progress.set(share); }});
    renderer::ShadowPicture shadow = shadows->render(task.view, {.image = false});
    ShadowResult result;
    result.image = std::move(picture.image);
    result.shares = std::move(shadow.light.shares);
    result.milliseconds = shadow.times.shadow_ms;
    result.first_frame_ms = picture.times.milliseconds;
    result.voxelize_ms = picture.times.voxelize_ms;
    result.pyramid_ms = picture.times.pyramid_ms;
    return result;
}

ShadowResult shadow_by_embree(const ShadowTask& task, const ShadowOptions& options,
                              const std::optional<std::filesystem::path>& cache) {
    const Progress progress("tracing", options.common.report.quiet);
    const renderer::View& view = task.view;
    Stopwatch watch;
    const reference::ImageTracer tracer(task.input.scene, task.shown);
    const reference::ShadowQuestion question{task.input.scene, task.shown,      task.receivers,  view.camera,
                                             view.light,       view.size.width, view.size.height};
    const reference::ShadowReceivers receivers = shadow_receivers(tracer, question);
    ShadowResult result;
    if (renderer::is_soft(view)) {
        reference::SoftShares soft =
            soft_shares(tracer, question, receivers, {.least_samples = options.truth_samples}, cache);
        result.milliseconds = soft.milliseconds;
        result.shares = std::move(soft.shares);
        result.standard_error = soft.greatest_standard_error;
        result.cached = soft.cached;
    } else {
        result.milliseconds = receivers.seen.milliseconds;
        result.shares = hard_shares(receivers);
    }
    result.first_frame_ms = watch.lap_ms();
    result.image = lit_image(task, receivers, result.shares);
    return result;
}

optics::Image difference_image(const ShadowResult& shadow, const std::vector<float>& truth) {
    optics::Image image{shadow.image.width, shadow.image.height,
                        std::vector<std::uint8_t>(4 * truth.size(), 255)};
    for (std::size_t i = 0; i < truth.size(); ++i) {
        if (truth[i] < 0.0F || shadow.shares[i] < 0.0F) continue;
        const float difference = std::clamp(shadow.shares[i] - truth[i], -1.0F, 1.0F);
        const auto left = std::uint8_t(std::lround(255.0F * (1.0F - std::abs(difference))));
        image.rgba[4 * i + (difference < 0.0F ? 2 : 0)] = left;
        image.rgba[4 * i + 1] = left;
    }
    return image;
}

}  // namespace cairn::app
