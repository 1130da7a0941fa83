#include "bench/trials/frames.h"

#include <algorithm>
#include <optional>
#include <thread>
#include <utility>

#include "bench/trials/real_scenes.h"
#include "gl/context.h"
#include "renderer/produce/dense_field.h"
#include "renderer/produce/fractal_content.h"
#include "renderer/produce/made_fields.h"
#include "renderer/produce/surface_content.h"
#include "renderer/produce/volume_content.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "scenes/volume/volume.h"
#include "voxelizer/surface/surface.h"

namespace cairn::bench {
namespace {

constexpr double shell_inner = 0.25;
constexpr double shell_outer = 0.30;
constexpr std::int64_t copy_resolution = 256;
/// Of the densest, through a finest voxel: so solids are opaque after a few, however fine they are.
constexpr double optical_depth = 1.0;
/// What does not show of a scan, as a share of its densities.
constexpr double scan_empty = 0.3;
/// 3^13, the most that rays can count. (Crassin et al. 2008 went to 4.8 million, 3^14.)
constexpr int sponge_resolution = 1594323;

/// @param empty  density that does not show; 0 where voxels that are coarse and thin are to show as such.
renderer::TransferFunction opaque(double empty, double voxel_size) {
    return renderer::TransferFunction(
        {{empty, glm::dvec3(0.9), 0.0}, {1.0, glm::dvec3(0.9), optical_depth / voxel_size}});
}

/// A field elsewhere.
class Moved final : public renderer::Field {
public:
    Moved(std::shared_ptr<const renderer::Field> field, const glm::dvec3& origin)
        : field_(std::move(field)), frame_(field_->frame()) {
        frame_.origin = origin;
    }
    [[nodiscard]] const renderer::FieldFrame& frame() const override { return frame_; }
    void fill(int coarseness, const glm::i64vec3& low, const glm::ivec3& count,
              float* values) const override {
        field_->fill(coarseness, low, count, values);
    }
    [[nodiscard]] renderer::FieldRange range(const glm::i64vec3& low,
                                             const glm::i64vec3& high) const override {
        return field_->range(low, high);
    }

private:
    std::shared_ptr<const renderer::Field> field_;
    renderer::FieldFrame frame_;
};

}  // namespace

struct Subject::Data {
    std::optional<scenes::Scene> scene;
    std::optional<scenes::Snapshot> snapshot;
    std::optional<scenes::Volume> volume;
    bool is_repeated = false;
    bool is_sponge = false;
};

Subject::Subject(const std::string& path) : data_(std::make_unique<Data>()), name_(scene_name(path)) {
    const scenes::Bounds unit{glm::dvec3(-0.5), glm::dvec3(0.5)};
    if (path == "builtin:hollow-sphere" || path == "builtin:spheres-repeated") {
        data_->is_repeated = path == "builtin:spheres-repeated";
        bounds_ = unit;
    } else if (path == "builtin:sponge") {
        data_->is_sponge = true;
        bounds_ = {glm::dvec3(0.0), glm::dvec3(1.0)};
    } else if (scenes::is_volume_file(path)) {
        data_->volume = scenes::load_volume(path);
        bounds_ = data_->volume->bounds();
    } else {
        data_->scene = scenes::load(path);
        data_->snapshot = scenes::take_snapshot(*data_->scene);
        bounds_ = data_->snapshot->bounds;
    }
}

Subject::~Subject() = default;
Subject::Subject(Subject&&) noexcept = default;
Subject& Subject::operator=(Subject&&) noexcept = default;

Cell Subject::triangles() const {
    return data_->snapshot ? Cell(std::int64_t(data_->snapshot->triangle_count)) : Cell{};
}

renderer::TreeOptions Subject::fitted(const renderer::TreeOptions& tree) const {
    renderer::TreeOptions options = tree;
    if (!data_->is_sponge) return options;
    options.n = 3;
    options.m = 27;
    options.max_resolution = sponge_resolution;
    return options;
}

Subject::Shown Subject::shown_field(const renderer::TreeOptions& tree) const {
    if (data_->volume) {
        const glm::dvec3& spacing = data_->volume->spacing;
        const double voxel_size = std::min({spacing.x, spacing.y, spacing.z});
        return {std::make_shared<renderer::DenseField>(*data_->volume, tree.n),
                opaque(scan_empty, voxel_size)};
    }
    const std::int64_t resolution = renderer::tree_shape_of(tree).resolution();
    const int copies = data_->is_repeated ? int(std::max<std::int64_t>(resolution / copy_resolution, 1)) : 1;
    const double side = 1.0 / copies;
    std::shared_ptr<const renderer::Field> field =
        std::make_shared<renderer::HollowSphere>(tree.n, resolution / copies, shell_inner, shell_outer, side);
    if (copies > 1) {
        const auto repeated = std::make_shared<renderer::RepeatedField>(std::move(field), copies);
        field = std::make_shared<Moved>(repeated, bounds_.low);
    }
    return {std::move(field), opaque(0.0, 1.0 / double(resolution))};
}

renderer::Renderer Subject::make(const renderer::TreeOptions& tree, const gl::ShaderSource& shaders) const {
    if (data_->scene) return {*data_->scene, *data_->snapshot, tree, shaders};
    if (data_->is_sponge) return {content(tree, shaders), fitted(tree), shaders};
    Shown shown = shown_field(tree);
    return {std::move(shown.field), shown.transfer, tree, {}, shaders};
}

renderer::TreeShape Subject::shape(const renderer::TreeOptions& tree) const {
    if (!data_->volume) return renderer::tree_shape_of(fitted(tree));
    const Shown shown = shown_field(tree);
    return renderer::make_volume_shape(shown.field->frame(), tree.n, tree.m, tree.max_resolution).tree;
}

std::unique_ptr<renderer::Content> Subject::content(const renderer::TreeOptions& tree,
                                                    const gl::ShaderSource& shaders) const {
    if (data_->scene) {
        const renderer::TreeShape shape = renderer::tree_shape_of(tree);
        const voxelizer::Grid grid = voxelizer::grid_around(data_->snapshot->bounds, shape.resolution());
        const voxelizer::Surface surface =
            voxelizer::build_surface(*data_->scene, *data_->snapshot, grid, {.attributes = true});
        return std::make_unique<renderer::SurfaceContent>(shape, surface, shaders);
    }
    if (data_->is_sponge) {
        return std::make_unique<renderer::FractalContent>(renderer::tree_shape_of(fitted(tree)), shaders);
    }
    Shown shown = shown_field(tree);
    const renderer::VolumeShape shape =
        renderer::make_volume_shape(shown.field->frame(), tree.n, tree.m, tree.max_resolution);
    return std::make_unique<renderer::VolumeContent>(shape, std::move(shown.field), shown.transfer.visible());
}

renderer::View Subject::view(int width, int height) const {
    renderer::View view;
    view.width = width;
    view.height = height;
    view.camera = optics::framing_camera(bounds_, double(width) / height);
    return view;
}

double frame_ms(renderer::Renderer& renderer, const renderer::View& view) {
    renderer.forget_picture();
    (void)renderer.render(view);
    return renderer.statistics().milliseconds;
}

Entrant::Entrant(renderer::Renderer made, const renderer::View& looks)
    : Entrant(std::make_shared<renderer::Renderer>(std::move(made)), looks) {}

Entrant::Entrant(std::shared_ptr<renderer::Renderer> made, const renderer::View& looks)
    : renderer(std::move(made)), view(looks) {
    first_ms = frame_ms(*renderer, view);
    first = renderer->statistics();
}

void measure_in_turn(std::vector<Entrant>& entrants, int runs, double budget_ms) {
    double spent_ms = 0.0;
    for (int run = 0; run < runs && spent_ms <= budget_ms * double(entrants.size()); ++run) {
        for (Entrant& entrant : entrants) {
            entrant.renderer->forget_picture();
            entrant.image = entrant.renderer->render(entrant.view);
            entrant.converged = entrant.renderer->statistics();
            entrant.samples_ms.push_back(entrant.converged.milliseconds);
            spent_ms += entrant.samples_ms.back();
        }
    }
}

std::vector<Cell> on_this_machine(std::vector<Cell> row) {
    row.emplace_back(gl::driver_name());
    row.emplace_back(std::int64_t(std::thread::hardware_concurrency()));
    return row;
}

}  // namespace cairn::bench
