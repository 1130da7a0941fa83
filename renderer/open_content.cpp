#include "renderer/open_content.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "renderer/produce/dense_field.h"
#include "renderer/produce/fractal_content.h"
#include "renderer/produce/made_fields.h"
#include "renderer/produce/surface_content.h"
#include "renderer/produce/volume_content.h"
#include "scenes/load.h"
#include "shaders/interop/pool.h"
#include "voxelizer/surface/surface.h"

namespace cairn::renderer {
namespace {

constexpr std::string_view builtin_prefix = "builtin:";
constexpr int finest_sponge = 1594323;  // 3^13

constexpr std::array shells = {
    BuiltinVolume{"hollow-sphere", "a volume: a shell, by its formula at any resolution", 0.25, 0.30},
    BuiltinVolume{"ball", "a volume: a ball, likewise", 0.0, 0.45},
};

constexpr std::array sets = {
    BuiltinSet{"fractal", "a set without a finest detail: a cube without one of its octants, and so on"},
    BuiltinSet{"sponge", "Menger's sponge, as fine as a tree can be"},
};

const BuiltinVolume* find_builtin_volume(std::string_view name) {
    if (!name.starts_with(builtin_prefix)) return nullptr;
    const auto* const found = std::find_if(shells.begin(), shells.end(), [&](const BuiltinVolume& shell) {
        return shell.name == name.substr(builtin_prefix.size());
    });
    return found == shells.end() ? nullptr : found;
}

std::shared_ptr<const Field> load_field(const std::string& name, const TreeOptions& tree,
                                        const ContentOptions& options,
                                        std::vector<scenes::Warning>& warnings) {
    const int copies = options.copies;
    if (copies < 1)
        throw Error(Fault::usage, "volume", fmt::format("{} copies", copies), "choose at least 1");
    std::shared_ptr<const Field> field;
    if (const BuiltinVolume* const shell = find_builtin_volume(name)) {
        const int resolution = std::max(tree.max_resolution / copies, 1);
        field = std::make_shared<HollowSphere>(tree.n, resolution, shell->inner, shell->outer);
    } else {
        const scenes::Volume volume = scenes::load_volume(name, options.load);
        warnings = volume.warnings;
        field = std::make_shared<DenseField>(volume, tree.n, options.load.memory_bytes);
    }
    if (copies > 1) field = std::make_shared<RepeatedField>(field, copies);
    return field;
}

scenes::Bounds bounds_of(const FieldFrame& frame) {
    return {frame.origin, frame.origin + frame.voxel_size * glm::dvec3(frame.size)};
}

/// From extinctions per voxel to extinctions per world unit.
TransferFunction in_world(std::vector<ControlPoint> points, double voxel_size) {
    for (ControlPoint& point : points)
        point.extinction /= voxel_size;
    return TransferFunction(points);
}

/// The sets are cut in halves or in thirds, and their trees likewise.
void check_set(ContentKind kind, const TreeOptions& tree) {
    if (kind == ContentKind::sponge && tree.n != 3)
        throw Error(Fault::usage, "tree", fmt::format("N = {} for the sponge", tree.n),
                    "it is cut in thirds: choose N = 3");
    if (kind == ContentKind::fractal && tree.n == 3)
        throw Error(Fault::usage, "tree", "N = 3 for the fractal",
                    "it is cut in halves: choose N = 2, 4 or 8");
}

/// The shape of a tree whose root cube the content fills.
TreeShape set_shape(const TreeOptions& tree) {
    return tree.max_level ? tree_shape_of(tree) : make_tree_shape_within(tree.n, tree.m, tree.max_resolution);
}

}  // namespace

std::unique_ptr<Content> surface_content(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                                         const TreeOptions& tree, const gl::ShaderSource& shaders) {
    const TreeShape shape = tree_shape_of(tree);
    constexpr int most_voxels = 1 << (MAX_RESOLUTION_BITS - MARK_BITS);
    if (shape.has_windows() || (shape.cell_base() == 2 && shape.resolution() > most_voxels)) {
        throw Error(Fault::usage, "tree",
                    fmt::format("rays through a surface count {} parts of a voxel, and 2^{} in all",
                                1 << MARK_BITS, MAX_RESOLUTION_BITS),
                    fmt::format("give it at most {} voxels across",
                                make_tree_shape_within(tree.n, tree.m, most_voxels).resolution()));
    }
    // The root cube has m n^k voxels across; the scene, those that were asked for, in the cube's low corner.
    const int voxels = tree.max_level ? shape.resolution() : tree.max_resolution;
    voxelizer::Grid grid = voxelizer::grid_around(snapshot.bounds, voxels);
    grid.resolution = glm::ivec3(shape.resolution());
    const voxelizer::Surface surface = voxelizer::build_surface(scene, snapshot, grid, {.attributes = true});
    return std::make_unique<SurfaceContent>(shape, surface, shaders);
}

std::unique_ptr<Content> volume_content(const scenes::Volume& volume, const TransferFunction& transfer,
                                        const TreeOptions& tree, const VolumeOptions& options) {
    return volume_content(std::make_shared<DenseField>(volume, tree.n), transfer, tree, options);
}

std::unique_ptr<Content> volume_content(std::shared_ptr<const Field> field, const TransferFunction& transfer,
                                        const TreeOptions& tree, const VolumeOptions& options) {
    if (tree.mips) {
        throw Error(Fault::usage, "tree", "the bricks of a volume have no mip levels",
                    "leave the mips and blended levels of detail to surfaces");
    }
    const VolumeShape shape = make_volume_shape(field->frame(), tree.n, tree.m, tree.max_resolution);
    return std::make_unique<VolumeContent>(shape, std::move(field), transfer, options);
}

std::unique_ptr<Content> fractal_content(const TreeOptions& tree, const gl::ShaderSource& shaders) {
    return std::make_unique<FractalContent>(set_shape(tree), shaders);
}

ContentKind content_kind(std::string_view path_or_builtin) {
    if (path_or_builtin == "builtin:fractal") return ContentKind::fractal;
    if (path_or_builtin == "builtin:sponge") return ContentKind::sponge;
    const bool is_volume = scenes::is_volume_file(std::string(path_or_builtin)) ||
                           find_builtin_volume(path_or_builtin) != nullptr;
    return is_volume ? ContentKind::volume : ContentKind::surface;
}

TreeOptions usual_tree(std::string_view path_or_builtin) {
    TreeOptions tree;
    const ContentKind kind = content_kind(path_or_builtin);
    if (kind == ContentKind::fractal) tree.max_level = deepest_level(tree.n, tree.m);
    if (kind == ContentKind::sponge) tree = {.n = 3, .m = 27, .max_resolution = finest_sponge};
    return tree;
}

std::span<const BuiltinVolume> builtin_volumes() {
    return shells;
}

std::span<const BuiltinSet> builtin_sets() {
    return sets;
}

std::vector<ControlPoint> default_transfer() {
    return {{0.1, {0.75, 0.7, 0.62}, 0.0}, {0.3, {0.75, 0.7, 0.62}, 0.5}, {1.0, {0.95, 0.92, 0.85}, 2.0}};
}

ContentSource::ContentSource(const std::string& path_or_builtin, const ContentOptions& options)
    : kind_(content_kind(path_or_builtin)),
      tree_(options.tree.value_or(usual_tree(path_or_builtin))),
      transfer_(options.transfer.empty() ? default_transfer() : options.transfer),
      volume_(options.volume) {
    check_set(kind_, tree_);
    switch (kind_) {
        case ContentKind::surface: {
            scenes::Scene scene = scenes::load(path_or_builtin, options.load);
            scenes::Snapshot snapshot = scenes::take_snapshot(scene, options.when);
            *this = ContentSource(std::move(scene), std::move(snapshot), tree_);
            break;
        }
        case ContentKind::volume:
            field_ = load_field(path_or_builtin, tree_, options, warnings_);
            bounds_ = bounds_of(field_->frame());
            break;
        case ContentKind::fractal:
            bounds_ = {glm::dvec3(-0.5), glm::dvec3(0.5)};
            break;
        case ContentKind::sponge:
            bounds_ = {glm::dvec3(0.0), glm::dvec3(1.0)};
            break;
    }
}

ContentSource::ContentSource(scenes::Scene scene, scenes::Snapshot snapshot, const TreeOptions& tree)
    : tree_(tree), bounds_(snapshot.bounds), warnings_(scene.warnings) {
    scene_ = std::make_shared<const SceneAtMoment>(SceneAtMoment{std::move(scene), std::move(snapshot)});
}

std::optional<glm::i64vec3> ContentSource::voxels() const {
    return field_ ? std::optional(field_->frame().size) : std::nullopt;
}

std::optional<std::int64_t> ContentSource::finest_resolution() const {
    if (kind_ == ContentKind::fractal) return std::nullopt;
    if (scene_ && !tree_.max_level) return tree_.max_resolution;
    if (!field_) return set_shape(tree_).resolution();
    const FieldFrame& frame = field_->frame();
    const VolumeShape shape = make_volume_shape(frame, tree_.n, tree_.m, tree_.max_resolution);
    const std::int64_t samples = std::max({frame.size.x, frame.size.y, frame.size.z});
    const std::int64_t side = shape.finest_voxel_side();
    return (samples + side - 1) / side;
}

std::unique_ptr<Content> ContentSource::content(const gl::ShaderSource& shaders) const {
    if (scene_) return surface_content(scene_->scene, scene_->snapshot, tree_, shaders);
    if (!field_) return fractal_content(tree_, shaders);
    return volume_content(field_, in_world(transfer_, field_->frame().voxel_size), tree_, volume_);
}

std::unique_ptr<Content> open_content(const std::string& path_or_builtin, const ContentOptions& options,
                                      const gl::ShaderSource& shaders) {
    return ContentSource(path_or_builtin, options).content(shaders);
}

}  // namespace cairn::renderer
