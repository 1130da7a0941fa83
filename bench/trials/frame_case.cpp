#include "bench/trials/frame_case.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "base/error.h"
#include "bench/trials/real_scenes.h"
#include "renderer/open_content.h"
#include "renderer/produce/dense_field.h"
#include "renderer/produce/made_fields.h"
#include "renderer/produce/volume_content.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "scenes/volume/volume.h"

namespace cairn::bench {
namespace {

constexpr std::int64_t copy_resolution = 256;
/// Optical depth of density 1 per finest voxel: solids are opaque after a few voxels, however fine these are.
constexpr double optical_depth = 1.0;
/// Densities of a scan below this share do not show.
constexpr double scan_empty = 0.3;

constexpr std::string_view one_shell = "builtin:hollow-sphere";
constexpr std::string_view repeated_shells = "builtin:spheres-repeated";

const renderer::BuiltinVolume& shell() {
    const auto shells = renderer::builtin_volumes();
    return *std::ranges::find(shells, one_shell.substr(one_shell.find(':') + 1),
                              &renderer::BuiltinVolume::name);
}

bool is_shells(std::string_view path) {
    return path == one_shell || path == repeated_shells;
}

bool is_volume(const std::string& path) {
    return is_shells(path) || scenes::is_volume_file(path);
}

/// A transfer function for solids.
/// @param empty  greatest density that does not show; 0 if coarse, thin voxels are to show.
renderer::TransferFunction opaque(double empty, double voxel_size) {
    return renderer::TransferFunction(
        {{empty, glm::dvec3(0.9), 0.0}, {1.0, glm::dvec3(0.9), optical_depth / voxel_size}});
}

/// A field at another place.
class MovedField final : public renderer::Field {
public:
    MovedField(std::shared_ptr<const renderer::Field> field, const glm::dvec3& origin)
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

struct FrameCase::Data {
    struct AtRest {
        scenes::Scene scene;
        scenes::Snapshot snapshot;  ///< points into the scene
    };
    /// The shell of builtin:hollow-sphere, or copies of it.
    struct Shells {
        bool are_repeated = false;
    };
    struct Sponge {};

    std::variant<Sponge, Shells, scenes::Volume, AtRest> shown;

    [[nodiscard]] const AtRest* scene() const { return std::get_if<AtRest>(&shown); }
    [[nodiscard]] const scenes::Volume* volume() const { return std::get_if<scenes::Volume>(&shown); }
    [[nodiscard]] bool is_sponge() const { return std::holds_alternative<Sponge>(shown); }
};

FrameCase::FrameCase(const std::string& path) : data_(std::make_unique<Data>()), name_(scene_name(path)) {
    if (is_shells(path)) {
        data_->shown = Data::Shells{path == repeated_shells};
        bounds_ = {glm::dvec3(-0.5), glm::dvec3(0.5)};
    } else if (path == "builtin:sponge") {
        data_->shown = Data::Sponge{};
        bounds_ = {glm::dvec3(0.0), glm::dvec3(1.0)};
    } else if (scenes::is_volume_file(path)) {
        bounds_ = data_->shown.emplace<scenes::Volume>(scenes::load_volume(path)).bounds();
    } else {
        Data::AtRest& rest = data_->shown.emplace<Data::AtRest>();
        rest.scene = scenes::load(path);
        rest.snapshot = scenes::take_snapshot(rest.scene);
        bounds_ = rest.snapshot.bounds;
    }
}

FrameCase::~FrameCase() = default;
FrameCase::FrameCase(FrameCase&&) noexcept = default;
FrameCase& FrameCase::operator=(FrameCase&&) noexcept = default;

Cell FrameCase::triangles() const {
    const Data::AtRest* const scene = data_->scene();
    return scene != nullptr ? Cell(std::int64_t(scene->snapshot.triangle_count)) : Cell{};
}

renderer::TreeOptions FrameCase::fitted(const renderer::TreeOptions& tree) const {
    if (!data_->is_sponge()) return tree;
    const renderer::TreeOptions usual = renderer::usual_tree("builtin:sponge");
    const renderer::TreeOptions surfaces;
    const bool is_given = tree.max_resolution != surfaces.max_resolution;
    const int resolution = is_given ? tree.max_resolution : usual.max_resolution;
    if (tree.n == usual.n) return {.n = tree.n, .m = tree.m, .max_resolution = resolution};
    if (tree.n != surfaces.n || tree.m != surfaces.m)
        throw Error(Fault::usage, "tree", "the sponge is cut in thirds", "choose N = 3");
    return {.n = usual.n, .m = usual.m, .max_resolution = resolution};
}

FrameCase::ShownField FrameCase::shown_field(const renderer::TreeOptions& tree) const {
    if (const scenes::Volume* const volume = data_->volume()) {
        const glm::dvec3& spacing = volume->spacing;
        const double voxel_size = std::min({spacing.x, spacing.y, spacing.z});
        return {std::make_shared<renderer::DenseField>(*volume, tree.n), opaque(scan_empty, voxel_size)};
    }
    const std::int64_t resolution = tree.max_resolution;
    const bool are_repeated = std::get<Data::Shells>(data_->shown).are_repeated;
    const int copies = are_repeated ? int(std::max<std::int64_t>(resolution / copy_resolution, 1)) : 1;
    const double side = 1.0 / copies;
    std::shared_ptr<const renderer::Field> field = std::make_shared<renderer::HollowSphere>(
        tree.n, resolution / copies, shell().inner, shell().outer, side);
    if (copies > 1) {
        const auto repeated = std::make_shared<renderer::RepeatedField>(std::move(field), copies);
        field = std::make_shared<MovedField>(repeated, bounds_.low);
    }
    return {std::move(field), opaque(0.0, 1.0 / double(resolution))};
}

renderer::Renderer FrameCase::make(const renderer::TreeOptions& tree, const gl::ShaderSource& shaders,
                                   const renderer::RendererOptions& options,
                                   const renderer::VolumeOptions& volume) const {
    return renderer::Renderer(content(tree, shaders, volume), options, shaders);
}

renderer::TreeShape FrameCase::shape(const renderer::TreeOptions& tree) const {
    if (data_->is_sponge()) {
        const renderer::TreeOptions thirds = fitted(tree);
        return renderer::make_tree_shape_within(thirds.n, thirds.m, thirds.max_resolution);
    }
    if (data_->scene() != nullptr) return renderer::tree_shape_of(tree);
    const ShownField shown = shown_field(tree);
    return renderer::make_volume_shape(shown.field->frame(), tree.n, tree.m, tree.max_resolution).tree;
}

std::unique_ptr<renderer::Content> FrameCase::content(const renderer::TreeOptions& tree,
                                                      const gl::ShaderSource& shaders,
                                                      const renderer::VolumeOptions& volume) const {
    if (const Data::AtRest* const rest = data_->scene())
        return renderer::surface_content(rest->scene, rest->snapshot, tree, shaders);
    if (data_->is_sponge()) return renderer::fractal_content(fitted(tree), shaders);
    ShownField shown = shown_field(tree);
    return renderer::volume_content(std::move(shown.field), shown.transfer, tree, volume);
}

void check_volume_options(Chart& chart, const ChartOptions& options, const std::vector<std::string>& scenes) {
    const VoxelOptions& voxels = options.voxels;
    if (!voxels.steps_per_voxel && !voxels.gradient_threshold) return;
    const char* const option = voxels.steps_per_voxel ? "--steps-per-voxel" : "--gradient-threshold";
    std::vector<std::string> notes;
    for (const std::string& scene : scenes) {
        if (!is_volume(scene))
            notes.push_back(fmt::format("{} changes nothing of {}, which is no volume", option, scene));
    }
    if (notes.size() == scenes.size())
        throw Error(Fault::usage, option, "none of the chart's scenes is a volume",
                    "leave it out, or give a volume with --scene");
    chart.notes.insert(chart.notes.end(), notes.begin(), notes.end());
}

renderer::View FrameCase::view(int width, int height) const {
    renderer::View view;
    view.size = {width, height};
    view.camera = optics::framing_camera(bounds_, double(width) / height);
    return view;
}

}  // namespace cairn::bench
