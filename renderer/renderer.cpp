#include "renderer/renderer.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "renderer/frame/prefetch_view.h"
#include "renderer/march/march_view.h"
#include "renderer/mesh/mesh_raster.h"
#include "renderer/renderer_parts.h"
#include "shaders/interop/config.h"

namespace cairn::renderer {
Renderer::Renderer(std::unique_ptr<Content> content, const RendererOptions& options,
                   const gl::ShaderSource& shaders)
    : parts_(std::make_unique<Parts>(std::move(content), options, shaders)) {}

Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

void Renderer::set_mix(const Mix& mix) {
    parts_->mix = mix;
    parts_->picture.forget();
}

optics::Image Renderer::march(const View& view, Rows rows, int shown,
                              const std::function<void(int)>& march_band) {
    check_view(view, parts_->shape);
    if (rows.first < 0 || rows.count < 1 || rows.count > view.size.height - rows.first) {
        throw Error(
            Fault::usage, "view",
            fmt::format("{} rows from row {} of a picture of {}", rows.count, rows.first, view.size.height),
            "ask for rows that the picture has");
    }
    Parts& parts = *parts_;
    if (view.shadow.kind == ShadowQuality::Kind::cones && !parts.marcher.marches_surfaces())
        throw Error(Fault::usage, "view", "shadow cones through a volume", "send it shadow rays");
    if (!(view == parts.ahead.view)) parts.ahead = {view, parts.round, 0, false};
    const bool is_blended = parts.blends(view);
    const auto start = Clock::now();
    const FrameStatistics before = parts.totals();
    parts.statistics = FrameStatistics{};
    FrameStatistics& statistics = parts.statistics;

    interop::MarchView marched = parts.march_view_of(view);
    const int band_rows = Marcher::band_rows(view.size.width, view.size.height);
    const bool shows_light = shown == SHOW_LIGHT;
    optics::Image image;
    if (!shows_light) {
        image = parts.is_empty() && parts.mix.meshes == nullptr ? background_image(view, rows)
                                                                : parts.picture.rows(view, rows);
    }
    const std::uint32_t background =
        shows_light ? std::bit_cast<std::uint32_t>(float(SHOWN_NOTHING)) : background_pixel(view.background);
    const bool is_known = !image.rgba.empty();
    if (!is_known) image = {view.size.width, rows.count, {}};
    const int end = rows.first + rows.count;
    for (int row = rows.first; row < end && !is_known; row += marched.band.y) {
        const int drawn_end = std::min(parts.draw_mix(marched, row), end);
        marched.band = glm::ivec4(row, std::min(band_rows, drawn_end - row), shown, int(background));
        parts.marcher.begin_frame(marched, parts.tree, parts.pool, is_blended, parts.drawn);
        march_band(row);
        std::vector<std::uint8_t> band = parts.marcher.read_image();
        if (image.rgba.empty()) {
            image.rgba = std::move(band);
        } else {
            image.rgba.insert(image.rgba.end(), band.begin(), band.end());
        }
    }

    if (!is_known && !shows_light && statistics.converged) parts.picture.keep(view, rows, image);
    parts.note_caches(before);
    statistics.milliseconds = milliseconds_since(start);
    return image;
}

optics::Image Renderer::march_patiently(const View& view, Rows rows, int shown, const Progress& progress) {
    parts_->keep_nothing();
    const double pixels = double(view.size.width) * rows.count;
    return march(view, rows, shown, [&](int row) {
        parts_->converge(progress, pixels, double(view.size.width) * (row - rows.first));
    });
}

Frame Renderer::render(const View& view, const Request& request) {
    const Rows rows = request.rows.value_or(Rows{0, view.size.height});
    const int shown = int(view.show);
    optics::Image image;
    if (request.budget) {
        parts_->require_lists();
        const auto deadline = deadline_in(*request.budget);
        parts_->keep_what_was_used_for(view, rows);
        image = march(view, rows, shown, [&](int) { parts_->refine(deadline); });
    } else {
        image = march_patiently(view, rows, shown, request.progress);
    }
    return {std::move(image), parts_->statistics};
}

LightFrame Renderer::light(const View& view, const Progress& progress) {
    if (!parts_->marcher.marches_surfaces()) {
        throw Error(Fault::usage, "view", "the light at a volume is not that of one place",
                    "render its picture");
    }
    const optics::Image bits = march_patiently(view, {0, view.size.height}, SHOW_LIGHT, progress);
    std::vector<float> shares(bits.rgba.size() / sizeof(float));
    std::memcpy(shares.data(), bits.rgba.data(), bits.rgba.size());
    return {{view.size.width, view.size.height, std::move(shares)}, parts_->statistics};
}

std::uint64_t Renderer::prefetch(const View& next, Milliseconds budget) {
    check_view(next, parts_->shape);
    const auto deadline = deadline_in(budget);
    Parts& parts = *parts_;
    parts.require_lists();
    const bool is_blended = parts.blends(next);
    if (parts.is_empty()) return 0;
    const FrameStatistics of_frame = parts.statistics;
    const View thin = thinned(next);
    interop::MarchView marched = parts.march_view_of(thin);
    marched.band = glm::ivec4(0, thin.size.height, int(thin.show), int(background_pixel(thin.background)));
    parts.tree.keep_since(parts.frame_round);
    parts.marcher.begin_frame(marched, parts.tree, parts.pool, is_blended);
    while (Clock::now() < deadline) {
        const PassResult pass = parts.march(PassKind::progressive);
        if (!parts.serve_until(deadline, pass, {.ahead = true}) || pass.done()) break;
    }
    const std::uint64_t produced = parts.statistics.bricks_produced - of_frame.bricks_produced;
    parts.prefetched += produced;
    parts.statistics = of_frame;
    return produced;
}

Prefetched Renderer::prefetch_finer(Milliseconds budget) {
    const auto deadline = deadline_in(budget);
    Parts& parts = *parts_;
    parts.require_lists();
    if (parts.is_empty()) return {};
    const FrameStatistics of_frame = parts.statistics;
    while (!parts.ahead.done && Clock::now() < deadline)
        parts.look_ahead(deadline);
    const std::uint64_t produced = parts.statistics.bricks_produced - of_frame.bricks_produced;
    parts.prefetched += produced;
    parts.statistics = of_frame;
    return {produced, !parts.ahead.done};
}

void Renderer::forget_picture() {
    parts_->picture.forget();
}

}  // namespace cairn::renderer
