#include "bench/trials/shadow_contenders.h"

#include <array>
#include <chrono>
#include <map>
#include <memory>
#include <utility>

#include "base/clock.h"
#include "bench/peers/pcf_shadow.h"
#include "reference/shadow_truth.h"
#include "renderer/shadow_renderer.h"

namespace cairn::bench {
namespace {

using Contenders = std::vector<ShadowContender>;
using renderer::ShadowMethod;
using Rays = reference::ImageTracer::Rays;

constexpr int own_resolution = 512;
constexpr int own_rays = 16;
constexpr std::array resolutions = {128, 256, 512, 1024, 2048};
/// The next resolution does not fit if a buffer holds only 128 MiB of texels.
constexpr std::array pyramid_resolutions = {128, 256, 512, 1024};
/// Bytes of the brick pool per voxel of the resolution. Surfaces grow with its square, but the part that a
/// picture's rays meet grows more slowly. No frame should have to produce bricks that the frame before it
/// had.
constexpr std::size_t finest_pool_bytes = std::size_t(1) << 19U;
constexpr std::array ray_counts = {1, 4, 16, 64, 256};
constexpr std::array cone_counts = {1, 2, 4, 8, 16};
constexpr int own_cones = 4;
constexpr std::array map_sizes = {64, 128, 256, 512};
constexpr int own_map_size = 256;
constexpr std::array plain_map_sizes = {512, 1024, 2048, 4096};
constexpr std::array strata = {1, 2, 3, 4, 6, 8, 16};

/// Pools are made when they are first needed, and shared by all contenders that use the same voxels.
ShadowRun run_voxels(const ShadowCase& shadow_case, std::optional<int> resolution,
                     const renderer::View& view) {
    std::unique_ptr<ShadowFrames>& kept = shadow_case.voxels[resolution];
    if (!kept) {
        renderer::ShadowOptions options{.renderer = shadow_case.options.voxels.renderer()};
        if (resolution) {
            options.tree = tree_of(*resolution);
            options.renderer.pools.brick_bytes = finest_pool_bytes * std::size_t(*resolution);
        }
        kept = std::make_unique<ShadowFrames>(ShadowMethod::voxel, shadow_case.scene, options,
                                              shadow_case.options.shaders);
    }
    return kept->run(view);
}

void add_voxel_rays(const ShadowCase& shadow_case, Contenders& all) {
    const auto add = [&](const char* varied, int rays, std::optional<int> resolution) {
        renderer::View view = shadow_case.scene.view(shadow_case.width, shadow_case.height, rays);
        if (resolution) view.detail.pixel_error = always_finest;
        all.push_back(
            {.method = "voxel-rays",
             .setting = {.varied = varied, .rays = rays, .resolution = resolution},
             .run = [&shadow_case, resolution, view] { return run_voxels(shadow_case, resolution, view); }});
    };
    for (const int resolution : resolutions)
        add("resolution", shadow_case.is_soft ? own_rays : 1, resolution);
    if (!shadow_case.is_soft) {
        add("rays, by pixel", 1, std::nullopt);
        return;
    }
    for (const int rays : ray_counts)
        if (rays != own_rays) add("rays", rays, own_resolution);
    for (const int rays : ray_counts)
        add("rays, by pixel", rays, std::nullopt);
}

void add_voxel_cones(const ShadowCase& shadow_case, Contenders& all) {
    if (!shadow_case.is_soft) return;
    const auto add = [&](const char* varied, int cones, int resolution) {
        renderer::View view = shadow_case.scene.view(shadow_case.width, shadow_case.height, cones);
        view.shadow.kind = renderer::ShadowQuality::Kind::cones;
        view.detail.pixel_error = always_finest;
        all.push_back(
            {.method = "voxel-cones",
             .setting = {.varied = varied, .rays = cones, .resolution = resolution},
             .run = [&shadow_case, resolution, view] { return run_voxels(shadow_case, resolution, view); }});
    };
    for (const int cones : cone_counts)
        add("cones", cones, own_resolution);
    for (const int resolution : resolutions)
        if (resolution != own_resolution) add("resolution", own_cones, resolution);
}

void add_pyramid(const ShadowCase& shadow_case, Contenders& all) {
    const auto made = std::make_shared<std::map<int, std::unique_ptr<ShadowFrames>>>();
    const auto add = [&](const char* varied, int rays, int resolution) {
        const renderer::View view = shadow_case.scene.view(shadow_case.width, shadow_case.height, rays);
        all.push_back({.method = "pyramid",
                       .setting = {.varied = varied, .rays = rays, .resolution = resolution},
                       .run = [&shadow_case, made, resolution, view] {
                           std::unique_ptr<ShadowFrames>& frames = (*made)[resolution];
                           if (!frames)
                               frames = std::make_unique<ShadowFrames>(
                                   ShadowMethod::pyramid, shadow_case.scene,
                                   renderer::ShadowOptions{.pyramid = {.resolution = resolution}},
                                   shadow_case.options.shaders);
                           return frames->run(view);
                       }});
    };
    for (const int resolution : pyramid_resolutions)
        add("resolution", shadow_case.is_soft ? own_rays : 1, resolution);
    if (!shadow_case.is_soft) return;
    for (const int rays : ray_counts)
        if (rays != own_rays) add("rays", rays, own_resolution);
}

const char* name_of(renderer::ShadowFormat format) {
    switch (format) {
        case renderer::ShadowFormat::fp16:
            return "fp16";
        case renderer::ShadowFormat::fp16_batches:
            return "fp16-batches";
        case renderer::ShadowFormat::fp32:
            break;
    }
    return "fp32";
}

void add_soft_shadow_maps(const ShadowCase& shadow_case, Contenders& all) {
    if (!shadow_case.is_soft) return;
    const renderer::View view = shadow_case.scene.view(shadow_case.width, shadow_case.height, 1);
    const auto add = [&](const char* varied, const renderer::SoftShadowOptions& map) {
        const bool is_one = map.passes == renderer::ShadowPasses::one;
        all.push_back({.method = "soft-shadow-map",
                       .setting = {.varied = varied,
                                   .map_size = map.receiver_size,
                                   .passes = is_one ? "one" : "two",
                                   .format = name_of(map.format)},
                       .ground_only = true,
                       .run = [&shadow_case, map, view, made = std::shared_ptr<ShadowFrames>()]() mutable {
                           if (!made)
                               made = std::make_shared<ShadowFrames>(
                                   ShadowMethod::soft_shadow_map, shadow_case.scene,
                                   renderer::ShadowOptions{.map = map}, shadow_case.options.shaders);
                           return made->run(view);
                       }});
    };
    for (const auto passes : {renderer::ShadowPasses::one, renderer::ShadowPasses::two}) {
        const char* const varied =
            passes == renderer::ShadowPasses::one ? "size, one pass" : "size, two passes";
        for (const int size : map_sizes)
            add(varied, {.occluder_size = size / 2, .receiver_size = size, .passes = passes});
    }
    for (const auto format : {renderer::ShadowFormat::fp16, renderer::ShadowFormat::fp16_batches})
        add("format", {.occluder_size = own_map_size / 2, .receiver_size = own_map_size, .format = format});
}

struct FixedLine {
    int kernel;
    const char* varied;
};
constexpr std::array<FixedLine, 2> hard_lines = {{{1, "size, 1 tap"}, {3, "size, 3 x 3 taps"}}};
constexpr std::array<FixedLine, 2> soft_lines = {{{3, "size, 3 x 3 taps"}, {7, "size, 7 x 7 taps"}}};

void add_plain_maps(const ShadowCase& shadow_case, Contenders& all) {
    const auto map = std::make_shared<std::unique_ptr<PcfShadow>>();
    const auto add = [&](const char* method, const char* varied, const PcfOptions& options) {
        all.push_back({.method = method,
                       .setting = {.varied = varied, .map_size = options.map_size, .kernel = options.kernel},
                       .is_ours = false,
                       .run = [&shadow_case, map, options, is_first = true]() mutable {
                           if (!*map) {
                               const ShadowScene& scene = shadow_case.scene;
                               *map = std::make_unique<PcfShadow>(scene.scene(), scene.all(), scene.casters(),
                                                                  scene.light(), shadow_case.receivers.points,
                                                                  shadow_case.receivers.normals);
                           }
                           PcfShadow::Result result = (*map)->shadow(options);
                           const bool prepares = std::exchange(is_first, false);
                           return ShadowRun{result.milliseconds,
                                            shares_of(shadow_case.receivers, result.shares), prepares,
                                            prepares};
                       }});
    };
    for (const FixedLine& line : shadow_case.is_soft ? soft_lines : hard_lines)
        for (const int size : plain_map_sizes)
            add("pcf", line.varied, {.map_size = size, .kernel = line.kernel});
    if (!shadow_case.is_soft) return;
    for (const int size : plain_map_sizes)
        add("pcss", "size, 5 x 5 taps", {.map_size = size, .filter = PcfFilter::penumbra, .kernel = 5});
    for (const int kernel : {3, 8, 16})
        add("pcss", "taps", {.map_size = 1024, .filter = PcfFilter::penumbra, .kernel = kernel});
}

/// One primary ray and one shadow ray per pixel. For a hard light this is the truth itself.
ShadowRun run_embree_hard(const ShadowCase& shadow_case, Rays rays) {
    const renderer::View view = shadow_case.scene.view(shadow_case.width, shadow_case.height, 1);
    const reference::ReferenceImage image =
        shadow_case.tracer.trace(view.camera, view.light, shadow_case.width, shadow_case.height, 0, rays);
    return {image.milliseconds, {image.lit.begin(), image.lit.end()}};
}

ShadowRun run_embree_soft(const ShadowCase& shadow_case, const reference::AreaLightOptions& options) {
    const auto start = Clock::now();
    const auto found =
        area_light_visibility(shadow_case.tracer, shadow_case.receivers.points, shadow_case.receivers.normals,
                              shadow_case.scene.light(), options);
    const double ms = milliseconds_since(start);
    std::vector<float> values;
    values.reserve(found.size());
    for (const reference::LightVisibility& point : found)
        values.push_back(float(point.visible));
    return {ms, shares_of(shadow_case.receivers, values)};
}

void add_embree(const ShadowCase& shadow_case, Contenders& all) {
    for (const Rays rays : {Rays::single, Rays::packets}) {
        for (const int across : strata) {
            if (!shadow_case.is_soft && across > 1) break;
            // A packet holds rays of one pixel, of which there is only one.
            if (shadow_case.is_soft && across == 1 && rays == Rays::packets) continue;
            reference::AreaLightOptions options;
            options.exact_strata = across;
            options.rays = rays;
            all.push_back({.method = rays == Rays::single ? "embree-single" : "embree-packets",
                           .setting = {.varied = "samples", .samples = across * across},
                           .is_ours = false,
                           .run = [&shadow_case, options] {
                               return shadow_case.is_soft ? run_embree_soft(shadow_case, options)
                                                          : run_embree_hard(shadow_case, options.rays);
                           }});
        }
    }
}

}  // namespace

std::vector<ShadowContender> shadow_contenders(const ShadowCase& shadow_case) {
    constexpr std::array makers = {add_voxel_rays,       add_voxel_cones, add_pyramid,
                                   add_soft_shadow_maps, add_plain_maps,  add_embree};
    Contenders all;
    for (const auto& add : makers)
        add(shadow_case, all);
    return all;
}

}  // namespace cairn::bench
