#include "renderer/renderer.h"

#include <cstring>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/error.h"
#include "renderer/frame/frame_loop.h"
#include "renderer/march/transfer_table.h"
#include "renderer/produce/dense_field.h"
#include "renderer/produce/surface_content.h"
#include "renderer/produce/volume_content.h"
#include "shaders/interop/config.h"
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
    loop_ = std::make_unique<FrameLoop>(shape, std::move(content), options, shaders);
}

Renderer::Renderer(std::unique_ptr<Content> content, const TreeOptions& options,
                   const gl::ShaderSource& shaders)
    : loop_(std::make_unique<FrameLoop>(tree_shape_of(options), std::move(content), options, shaders)) {}

Renderer::Renderer(const scenes::Volume& volume, const TransferFunction& transfer, const TreeOptions& options,
                   const VolumeOptions& volume_options, const gl::ShaderSource& shaders)
    : Renderer(std::make_shared<DenseField>(volume, options.n), transfer, options, volume_options, shaders) {}

Renderer::Renderer(std::shared_ptr<const Field> field, const TransferFunction& transfer,
                   const TreeOptions& options, const VolumeOptions& volume_options,
                   const gl::ShaderSource& shaders) {
    const VolumeShape shape = make_volume_shape(field->frame(), options.n, options.m, options.max_resolution);
    auto content = std::make_unique<VolumeContent>(shape, std::move(field), transfer.visible());
    auto table = std::make_shared<TransferTable>(transfer, volume_options, content->grid().voxel_size);
    MarchKind kind{"march/volume.comp.glsl",
                   "march/volume_shadow.comp.glsl",
                   {{"VOLUME_STEPS", std::to_string(volume_options.steps_per_voxel)}},
                   [table] { table->bind(); },
                   false};
    loop_ = std::make_unique<FrameLoop>(shape.tree, std::move(content), options, shaders, std::move(kind));
}

Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

void Renderer::set_mix(const Mix& mix) {
    loop_->set_mix(mix);
}

optics::Image Renderer::render(const View& view, const std::function<void(double)>& progress) {
    return loop_->render(view, {0, view.height}, int(view.show), progress);
}

optics::LightShares Renderer::light_shares(const View& view, const std::function<void(double)>& progress) {
    if (!loop_->marches_surfaces()) {
        throw Error(Fault::usage, "view", "the light at a volume is not that of one place",
                    "render its picture");
    }
    const optics::Image bits = loop_->render(view, {0, view.height}, SHOW_LIGHT, progress);
    optics::LightShares out{view.width, view.height, std::vector<float>(bits.rgba.size() / sizeof(float))};
    std::memcpy(out.shares.data(), bits.rgba.data(), bits.rgba.size());
    return out;
}

optics::Image Renderer::render_rows(const View& view, Rows rows) {
    return loop_->render(view, rows, int(view.show));
}

optics::Image Renderer::render_within(const View& view, double budget_ms) {
    return render_rows_within(view, {0, view.height}, budget_ms);
}

optics::Image Renderer::render_rows_within(const View& view, Rows rows, double budget_ms) {
    return loop_->render_until(view, rows, int(view.show), deadline_in(budget_ms));
}

std::uint64_t Renderer::prefetch(const View& next, double budget_ms) {
    return loop_->prefetch(next, deadline_in(budget_ms));
}

Prefetched Renderer::prefetch_finer(double budget_ms) {
    return loop_->prefetch_finer(deadline_in(budget_ms));
}

void Renderer::forget_picture() {
    loop_->forget_picture();
}

const FrameStatistics& Renderer::statistics() const {
    return loop_->statistics();
}

}  // namespace cairn::renderer
