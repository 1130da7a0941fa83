#include "renderer/renderer.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "base/error.h"
#include "renderer/frame/prefetch_view.h"
#include "renderer/march/march_view.h"
#include "renderer/march/transfer_table.h"
#include "renderer/mesh/mesh_raster.h"
#include "renderer/produce/dense_field.h"
#include "renderer/produce/surface_content.h"
#include "renderer/produce/volume_content.h"
#include "renderer/renderer_parts.h"
#include "shaders/interop/march.h"
#include "shaders/interop/pool.h"
#include "voxelizer/surface/surface.h"

namespace cairn::renderer {
namespace {

voxelizer::Surface flatten(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                           const TreeShape& shape) {
    const voxelizer::Grid grid = voxelizer::grid_around(snapshot.bounds, shape.resolution());
    return voxelizer::build_surface(scene, snapshot, grid, {.attributes = true});
}

}  // namespace

Renderer::Renderer(const scenes::Scene& scene, const scenes::Snapshot& snapshot, const TreeOptions& options,
                   const gl::ShaderSource& shaders) {
    const TreeShape shape = tree_shape_of(options);
    if (shape.has_windows()) {
        throw Error(Fault::usage, "tree", "a surface has no voxels as fine as its finest level",
                    fmt::format("give it at most 2^{} voxels across", MAX_RESOLUTION_BITS));
    }
    auto content = std::make_unique<SurfaceContent>(shape, flatten(scene, snapshot, shape), shaders);
    parts_ = std::make_unique<Parts>(shape, std::move(content), options, shaders);
}

Renderer::Renderer(std::unique_ptr<Content> content, const TreeOptions& options,
                   const gl::ShaderSource& shaders)
    : parts_(std::make_unique<Parts>(tree_shape_of(options), std::move(content), options, shaders)) {}

Renderer::Renderer(const scenes::Volume& volume, const TransferFunction& transfer, const TreeOptions& options,
                   const VolumeOptions& volume_options, const gl::ShaderSource& shaders)
    : Renderer(std::make_shared<DenseField>(volume, options.n), transfer, options, volume_options, shaders) {}

Renderer::Renderer(std::shared_ptr<const Field> field, const TransferFunction& transfer,
                   const TreeOptions& options, const VolumeOptions& volume_options,
                   const gl::ShaderSource& shaders) {
    const VolumeShape shape = make_volume_shape(field->frame(), options.n, options.m, options.max_resolution);
    auto content = std::make_unique<VolumeContent>(shape, std::move(field), transfer.visible());
    auto table = std::make_shared<TransferTable>(transfer, volume_options, content->grid().voxel_size);
    MarchKind kind{.primary = "march/volume.comp.glsl",
                   .shadow = "march/volume_shadow.comp.glsl",
                   .volume_steps = volume_options.steps_per_voxel,
                   .bind = [table] { table->bind(); }};
    parts_ = std::make_unique<Parts>(shape.tree, std::move(content), options, shaders, std::move(kind));
}

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
    if (rows.first < 0 || rows.count < 1 || rows.count > view.height - rows.first) {
        throw Error(
            Fault::usage, "view",
            fmt::format("{} rows from row {} of a picture of {}", rows.count, rows.first, view.height),
            "ask for rows that the picture has");
    }
    Parts& parts = *parts_;
    if (view.shadow_cones && !parts.marcher.marches_surfaces())
        throw Error(Fault::usage, "view", "shadow cones through a volume", "send it shadow rays");
    if (!(view == parts.ahead.view)) parts.ahead = {view, parts.round, 0, false};
    const bool is_blended = parts.blends(view);
    const auto start = Clock::now();
    const FrameStatistics before = parts.totals();
    parts.statistics = FrameStatistics{};
    FrameStatistics& statistics = parts.statistics;

    interop::MarchView marched = parts.march_view_of(view);
    const int band_rows = Marcher::band_rows(view.width, view.height);
    const bool shows_light = shown == SHOW_LIGHT;
    optics::Image image;
    if (!shows_light) {
        image = parts.is_empty() && parts.mix.meshes == nullptr ? background_image(view, rows)
                                                                : parts.picture.rows(view, rows);
    }
    const std::uint32_t background =
        shows_light ? std::bit_cast<std::uint32_t>(float(SHOWN_NOTHING)) : background_pixel(view.background);
    const bool is_known = !image.rgba.empty();
    if (!is_known) image = {view.width, rows.count, {}};
    const int end = rows.first + rows.count;
    marched.shown = shown;
    marched.background_pixel = background;
    for (int row = rows.first; row < end && !is_known; row += marched.row_count) {
        const int drawn_end = std::min(parts.draw_mix(marched, row), end);
        marched.first_row = row;
        marched.row_count = std::min(band_rows, drawn_end - row);
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

optics::Image Renderer::render(const View& view, const std::function<void(double)>& progress) {
    parts_->keep_nothing();
    return march(view, {0, view.height}, int(view.show), [&](int row) {
        parts_->converge(progress, double(view.width) * view.height, double(view.width) * row);
    });
}

optics::LightShares Renderer::light_shares(const View& view, const std::function<void(double)>& progress) {
    if (!parts_->marcher.marches_surfaces()) {
        throw Error(Fault::usage, "view", "the light at a volume is not that of one place",
                    "render its picture");
    }
    parts_->keep_nothing();
    const optics::Image bits = march(view, {0, view.height}, SHOW_LIGHT, [&](int row) {
        parts_->converge(progress, double(view.width) * view.height, double(view.width) * row);
    });
    optics::LightShares out{view.width, view.height, std::vector<float>(bits.rgba.size() / sizeof(float))};
    std::memcpy(out.shares.data(), bits.rgba.data(), bits.rgba.size());
    return out;
}

optics::Image Renderer::render_rows(const View& view, Rows rows) {
    parts_->keep_nothing();
    return march(view, rows, int(view.show), [&](int) { parts_->converge({}, 0.0, 0.0); });
}

optics::Image Renderer::render_within(const View& view, double budget_ms) {
    return render_rows_within(view, {0, view.height}, budget_ms);
}

optics::Image Renderer::render_rows_within(const View& view, Rows rows, double budget_ms) {
    parts_->require_lists();
    const auto deadline = deadline_in(budget_ms);
    parts_->keep_what_was_used_for(view, rows);
    return march(view, rows, int(view.show), [&](int) { parts_->refine(deadline); });
}

std::uint64_t Renderer::prefetch(const View& next, double budget_ms) {
    check_view(next, parts_->shape);
    const auto deadline = deadline_in(budget_ms);
    Parts& parts = *parts_;
    parts.require_lists();
    const bool is_blended = parts.blends(next);
    if (parts.is_empty()) return 0;
    const FrameStatistics of_frame = parts.statistics;
    const View thin = thinned(next);
    const interop::MarchView marched = parts.march_view_of(thin);
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

Prefetched Renderer::prefetch_finer(double budget_ms) {
    const auto deadline = deadline_in(budget_ms);
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

const FrameStatistics& Renderer::statistics() const {
    return parts_->statistics;
}

}  // namespace cairn::renderer
