#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gl/shader_source.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/produce/content.h"
#include "renderer/produce/volume.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"
#include "scenes/volume/volume.h"

/// Contents for a Renderer: made from scenes, volumes, the built-in sets, or a file by its name.
namespace cairn::renderer {

/// The surface of a scene at one moment. Needs a context. The scene and the snapshot are not needed
/// afterwards.
/// @throws Error  Fault::usage if the tree is invalid, or finer than the voxels of a surface can be;
///                Fault::memory if the surface does not fit.
[[nodiscard]] std::unique_ptr<Content> surface_content(const scenes::Scene& scene,
                                                       const scenes::Snapshot& snapshot,
                                                       const TreeOptions& tree = {},
                                                       const gl::ShaderSource& shaders = {});

/// The densities of a volume as the transfer function shows them, marched at the volume's own resolution, or
/// at the tree's if that is coarser. Needs a context. The volume is not needed afterwards.
/// @throws Error (Fault::usage)  if the tree is invalid or has mips, or if VolumeOptions are out of range.
[[nodiscard]] std::unique_ptr<Content> volume_content(const scenes::Volume& volume,
                                                      const TransferFunction& transfer,
                                                      const TreeOptions& tree = {},
                                                      const VolumeOptions& options = {});
/// The same for a field of densities, which must be made for the tree's n.
[[nodiscard]] std::unique_ptr<Content> volume_content(std::shared_ptr<const Field> field,
                                                      const TransferFunction& transfer,
                                                      const TreeOptions& tree = {},
                                                      const VolumeOptions& options = {});

/// One of the sets of renderer/produce/fractal_content.h: the sponge if the tree's n is 3, else the fractal.
[[nodiscard]] std::unique_ptr<Content> fractal_content(const TreeOptions& tree,
                                                       const gl::ShaderSource& shaders = {});

enum class ContentKind : std::uint8_t {
    surface,
    volume,
    fractal,  ///< "builtin:fractal", which has no finest level
    sponge,   ///< "builtin:sponge", in a tree of n = 3
};
/// The kind of content that a name stands for: a file by its ending, or "builtin:NAME". A name of no other
/// kind is a surface.
[[nodiscard]] ContentKind content_kind(std::string_view path_or_builtin);

/// The tree that suits the content of that name: TreeOptions{}, except for the two sets.
[[nodiscard]] TreeOptions usual_tree(std::string_view path_or_builtin);

struct BuiltinVolume {
    std::string_view name;
    std::string_view description;
    /// Radii of a shell, as shares of its cube's side.
    double inner, outer;
};
/// The built-in volumes, which need no file.
[[nodiscard]] std::span<const BuiltinVolume> builtin_volumes();

struct BuiltinSet {
    std::string_view name;
    std::string_view description;
};
/// The built-in sets, of which no surface is known, but whether a voxel belongs to them: ContentKind::fractal
/// and ContentKind::sponge.
[[nodiscard]] std::span<const BuiltinSet> builtin_sets();

/// The transfer function that an empty ContentOptions::transfer stands for: from a tenth of the density range
/// on, denser places are more opaque.
[[nodiscard]] std::vector<ControlPoint> default_transfer();

struct ContentOptions {
    /// Shape of the tree; none: usual_tree().
    std::optional<TreeOptions> tree = std::nullopt;
    /// The moment at which a scene is shown.
    scenes::When when = {};
    /// How a file is read.
    scenes::LoadOptions load = {};
    /// Copies of a volume along each axis, side by side: at least 1.
    int copies = 1;
    /// Transfer function of a volume. Extinctions are per voxel of the volume, so that one function suits
    /// volumes of any size. Empty: default_transfer().
    std::vector<ControlPoint> transfer = {};
    VolumeOptions volume = {};
};

/// A content by its name, loaded, but not on the GPU: needs no context.
class ContentSource {
public:
    /// @param options  options of other kinds of content are not read.
    /// @throws Error  Fault::input as scenes::load() and scenes::load_volume() do; Fault::usage if the scene
    ///                does not have the moment, if the tree does not suit the content, or if `copies` is less
    ///                than 1.
    explicit ContentSource(const std::string& path_or_builtin, const ContentOptions& options = {});
    /// For a scene that is loaded already, and a snapshot of it.
    ContentSource(scenes::Scene scene, scenes::Snapshot snapshot, const TreeOptions& tree = {});

    [[nodiscard]] ContentKind kind() const { return kind_; }
    [[nodiscard]] const TreeOptions& tree() const { return tree_; }
    /// Bounds of the content in the world; those of the fractal are around its middle.
    [[nodiscard]] const scenes::Bounds& bounds() const { return bounds_; }
    /// Snapshot of a surface; null for other kinds.
    [[nodiscard]] const scenes::Snapshot* snapshot() const { return scene_ ? &scene_->snapshot : nullptr; }
    /// Voxels of a volume along each axis; none for other kinds.
    [[nodiscard]] std::optional<glm::i64vec3> voxels() const;
    /// The most voxels along the longest axis that rays may ask for: TreeOptions::max_resolution for
    /// surfaces, and at most that for volumes and sets, whose levels have N times as many as the ones above
    /// them. None for the fractal.
    [[nodiscard]] std::optional<std::int64_t> finest_resolution() const;
    /// Which parts of the file were ignored, and why.
    [[nodiscard]] const std::vector<scenes::Warning>& warnings() const { return warnings_; }

    /// Needs a context. The source is not needed afterwards.
    /// @throws Error as surface_content() and volume_content() do.
    [[nodiscard]] std::unique_ptr<Content> content(const gl::ShaderSource& shaders = {}) const;

private:
    struct SceneAtMoment {
        scenes::Scene scene;
        scenes::Snapshot snapshot;
    };
    ContentKind kind_ = ContentKind::surface;
    TreeOptions tree_;
    scenes::Bounds bounds_;
    std::vector<scenes::Warning> warnings_;
    std::shared_ptr<const SceneAtMoment> scene_;
    std::shared_ptr<const Field> field_;
    std::vector<ControlPoint> transfer_;
    VolumeOptions volume_;
};

/// The content of a file, or of "builtin:NAME". Needs a context.
/// @throws Error as ContentSource does.
[[nodiscard]] std::unique_ptr<Content> open_content(const std::string& path_or_builtin,
                                                    const ContentOptions& options = {},
                                                    const gl::ShaderSource& shaders = {});

}  // namespace cairn::renderer
