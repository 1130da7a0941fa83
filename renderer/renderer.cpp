#include "renderer/renderer.h"

#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "optics/image_mean.h"
#include "renderer/frame/frame_loop.h"
#include "renderer/mesh/mix.h"
#include "shaders/interop/march.h"

namespace cairn::renderer {

Renderer::Renderer(std::unique_ptr<Content> content, const RendererOptions& options,
                   const gl::ShaderSource& shaders)
    : loop_(std::make_unique<FrameLoop>(std::move(content), options.pools, options.march, shaders)) {}

Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

void Renderer::set_mix(const Mix& mix) {
    loop_->set_mix(mix);
}

namespace {

/// Adds the counters of a frame, and takes over what it left in the pools.
void add(FrameStatistics& sum, const FrameStatistics& next) {
    FrameStatistics all = next;
    all.milliseconds += sum.milliseconds;
    all.rays_launched += sum.rays_launched;
    all.passes += sum.passes;
    all.tile_queries += sum.tile_queries;
    all.query_bytes += sum.query_bytes;
    all.nodes_subdivided += sum.nodes_subdivided;
    all.bricks_produced += sum.bricks_produced;
    all.constant_tiles += sum.constant_tiles;
    all.bricks_evicted += sum.bricks_evicted;
    all.nodes_evicted += sum.nodes_evicted;
    all.bricks_relinked += sum.bricks_relinked;
    all.bricks_cached += sum.bricks_cached;
    all.bricks_restored += sum.bricks_restored;
    all.bricks_prefetched += sum.bricks_prefetched;
    all.march_ms += sum.march_ms;
    all.produce_ms += sum.produce_ms;
    all.tree_ms += sum.tree_ms;
    all.upload_ms += sum.upload_ms;
    sum = all;
}

void check_one_sample(const View& view, const char* what) {
    if (view.samples != 1)
        throw Error(Fault::usage, "view", std::string(what) + " with more than one sample per pixel",
                    "choose one sample");
}

}  // namespace

Frame Renderer::render(const View& view, const Request& request) {
    if (view.samples == 1) return render_sample(view, request);
    check_view(view);
    if (request.budget) check_one_sample(view, "a frame within a budget");
    optics::ImageMean mean;
    FrameStatistics statistics;
    View sample = view;
    sample.samples = 1;
    Request part = request;
    for (int i = 0; i < view.samples; ++i) {
        sample.pixel_place = sample_place(i, view.samples);
        if (request.progress)
            part.progress = [&, i](double share) { request.progress((i + share) / view.samples); };
        const Frame frame = render_sample(sample, part);
        mean.add(frame.image);
        add(statistics, frame.statistics);
    }
    return {mean.mean(), statistics};
}

Frame Renderer::render_sample(const View& view, const Request& request) {
    const Rows rows = request.rows.value_or(Rows{0, view.size.height});
    const int shown = int(view.show);
    optics::Image image = request.budget
                              ? loop_->render_until(view, rows, shown, deadline_in(*request.budget))
                              : loop_->render(view, rows, shown, request.progress);
    return {std::move(image), loop_->statistics()};
}

LightFrame Renderer::light(const View& view, const Progress& progress) {
    if (!loop_->shows_surface()) {
        throw Error(Fault::usage, "view", "the light at a volume is not that of one place",
                    "render its picture");
    }
    check_one_sample(view, "shares of the light");
    const optics::Image bits = loop_->render(view, {0, view.size.height}, SHOW_LIGHT, progress);
    std::vector<float> shares(bits.rgba.size() / sizeof(float));
    std::memcpy(shares.data(), bits.rgba.data(), bits.rgba.size());
    return {{view.size.width, view.size.height, std::move(shares)}, loop_->statistics()};
}

std::uint64_t Renderer::prefetch(const View& next, Milliseconds budget) {
    return loop_->prefetch(next, deadline_in(budget));
}

PrefetchResult Renderer::prefetch_finer(Milliseconds budget) {
    return loop_->prefetch_finer(deadline_in(budget));
}

void Renderer::forget_picture() {
    loop_->forget_picture();
}

}  // namespace cairn::renderer
