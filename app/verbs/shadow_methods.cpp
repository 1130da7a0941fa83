#include "app/verbs/shadow_methods.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "app/terminal/measure.h"
#include "app/terminal/progress.h"
#include "reference/shadow_truth.h"
#include "renderer/mesh/mesh_raster.h"
#include "renderer/pyramid_shadow.h"
#include "renderer/soft_shadow.h"

namespace cairn::app {
namespace {

constexpr float embree_albedo = 0.8F;

/// Grey, shaded as the renderer shades: by the light's middle.
optics::Image lit_image(const ShadowTask& task, const reference::ShadowReceivers& receivers,
                        const std::vector<float>& shares) {
    const reference::ReferenceImage& seen = receivers.seen;
    const renderer::View& view = task.view;
    optics::Image image{view.width, view.height, std::vector<std::uint8_t>(4 * seen.depth.size(), 255)};
    const auto encoded = [](float linear) {
        const float c = std::clamp(linear, 0.0F, 1.0F);
        const float srgb = c <= 0.0031308F ? 12.92F * c : 1.055F * std::pow(c, 1.0F / 2.4F) - 0.055F;
        return std::uint8_t(std::lround(255.0F * srgb));
    };
    for (std::size_t i = 0; i < seen.depth.size(); ++i) {
        const bool is_there = std::isfinite(seen.depth[i]);
        for (std::size_t c = 0; c < 3; ++c)
            image.rgba[4 * i + c] =
                encoded(is_there ? embree_albedo * view.light.ambient : view.background[int(c)]);
    }
    for (std::size_t k = 0; k < receivers.pixels.size(); ++k) {
        const double facing =
            glm::dot(receivers.normals[k], optics::direction_to(view.light, receivers.points[k]));
        const float direct = float(facing) * shares[receivers.pixels[k]] * (1.0F - view.light.ambient);
        for (std::size_t c = 0; c < 3; ++c)
            image.rgba[4 * receivers.pixels[k] + c] = encoded(embree_albedo * (view.light.ambient + direct));
    }
    return image;
}

}  // namespace

ShadowResult shadow_by_voxels(const ShadowTask& task, const ShadowOptions& options) {
    const gl::ShaderSource& shaders = options.common.driver.shaders;
    renderer::Renderer renderer(task.input.scene, task.shown, options.view.tree, shaders);
    renderer.set_mix({.meshes = std::make_shared<renderer::MeshRaster>(task.input.scene, task.shown, shaders),
                      .mesh_shadows = true,
                      .meshes_are_voxelized = true,
                      .voxels_hidden = true});
    Progress progress("shadowing", options.common.report.quiet);
    ShadowResult result;
    result.image = renderer.render(task.view, [&](double share) { progress.set(share); });
    result.first_frame_ms = renderer.statistics().milliseconds;
    result.shares = renderer.light_shares(task.view).shares;
    result.milliseconds = renderer.statistics().milliseconds;
    return result;
}

ShadowResult shadow_by_pyramid(const ShadowTask& task, const ShadowOptions& options) {
    renderer::PyramidShadowRenderer renderer(task.input.scene, task.shown,
                                             {.resolution = pyramid_resolution(options)},
                                             options.common.driver.shaders);
    ShadowResult result;
    result.image = renderer.render(task.view);
    result.first_frame_ms = renderer.statistics().milliseconds;
    result.voxelize_ms = renderer.statistics().voxelize_ms;
    result.pyramid_ms = renderer.statistics().pyramid_ms;
    result.shares = renderer.light_shares(task.view).shares;
    result.milliseconds = renderer.statistics().trace_ms;
    return result;
}

ShadowResult shadow_by_map(const ShadowTask& task, const ShadowOptions& options) {
    renderer::SoftShadowRenderer renderer(task.input.scene, task.input.snapshot, task.occluders,
                                          task.receivers, options.map, options.common.driver.shaders);
    Stopwatch watch;
    renderer::SoftShadowPicture picture = renderer.render(task.view);
    const double first_ms = watch.lap_ms();
    picture = renderer.render(task.view);
    return {std::move(picture.image), std::move(picture.visible), renderer.map().statistics().milliseconds,
            first_ms};
}

ShadowResult shadow_by_embree(const ShadowTask& task, const ShadowOptions& options,
                              const std::optional<std::filesystem::path>& cache) {
    const Progress progress("tracing", options.common.report.quiet);
    const renderer::View& view = task.view;
    Stopwatch watch;
    const reference::ImageTracer tracer(task.input.scene, task.shown);
    const reference::ShadowQuestion question{task.input.scene, task.shown, task.receivers, view.camera,
                                             view.light,       view.width, view.height};
    const reference::ShadowReceivers receivers = shadow_receivers(tracer, question);
    ShadowResult result;
    if (task.is_soft) {
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
