#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gl/shader_source.h"
#include "renderer/pool/tree_options.h"
#include "renderer/produce/content.h"
#include "renderer/produce/transfer_function.h"
#include "renderer/produce/volume_field.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"
#include "scenes/volume/volume.h"

/// Contents for a Renderer: of scenes, of volumes, of the built-in sets, and of a file by its name.
namespace cairn::renderer {

/// The surface of a scene at one moment. Needs a context. The scene and the snapshot are not needed
/// afterwards.
/// @throws Error  Fault::usage for a tree that cannot work, or that is finer than a surface has voxels;
/// Fault::memory when the surface does not fit.
[[nodiscard]] std::unique_ptr<Content> surface_content(const scenes::Scene& scene,
                                                       const scenes::Snapshot& snapshot,
                                                       const TreeOptions& tree = {},
                                                       const gl::ShaderSource& shaders = {});

/// A volume: its densities as the transfer function shows them, marched at the volume's own resolution, or
/// the tree's if that is coarser. Needs a context. The volume is not needed afterwards.
/// @throws Error (Fault::usage)  for a tree that cannot work or has mips, and for VolumeOptions out of range.
[[nodiscard]] std::unique_ptr<Content> volume_content(const scenes::Volume& volume,
                                                      const TransferFunction& transfer,
                                                      const TreeOptions& tree = {},
                                                      const VolumeOptions& options = {});
/// A field of densities, made for the tree's n.
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
/// What a name stands for: a file by its ending, or "builtin:NAME". A name that is nothing else is a surface.
[[nodiscard]] ContentKind content_kind(std::string_view path_or_builtin);

/// The tree that suits what the name stands for: TreeOptions{}, but for the two sets.
[[nodiscard]] TreeOptions usual_tree(std::string_view path_or_builtin);

struct BuiltinVolume {
    std::string_view name;
    std::string_view description;
    /// Radii of a shell, as shares of its cube's side.
    double inner, outer;
};
/// The volumes that need no file.
[[nodiscard]] std::span<const BuiltinVolume> builtin_volumes();

/// What ContentOptions::transfer is if it is empty: the denser a place is than a tenth of the range, the more
/// opaque.
[[nodiscard]] std::vector<ControlPoint> default_transfer();

struct ContentOptions {
    /// None: usual_tree().
    std::optional<TreeOptions> tree = std::nullopt;
    /// The moment of a scene.
    scenes::When when = {};
    /// A scene may read files outside its own folder.
    bool trust_paths = false;
    /// Copies of a volume along each axis, side by side: at least 1.
    int copies = 1;
    /// Of a volume; extinctions are per voxel of the volume, so that one transfer function suits volumes of
    /// any size. Empty: default_transfer().
    std::vector<ControlPoint> transfer = {};
    VolumeOptions volume = {};
};

/// What a name stands for, loaded, but not on the GPU: needs no context.
class ContentSource {
public:
    /// @param options  what does not concern the kind of content is not read.
    /// @throws Error  Fault::input as scenes::load() and scenes::load_volume() do; Fault::usage for a moment
    /// that the scene does not have, a tree that does not suit the content, or no copy.
    explicit ContentSource(const std::string& path_or_builtin, const ContentOptions& options = {});
    /// A scene that is loaded already; the snapshot is of the scene.
    ContentSource(scenes::Scene scene, scenes::Snapshot snapshot, const TreeOptions& tree = {});

    [[nodiscard]] ContentKind kind() const { return kind_; }
    [[nodiscard]] const TreeOptions& tree() const { return tree_; }
    /// Of what is shown, in the world. The fractal's are around its middle.
    [[nodiscard]] const scenes::Bounds& bounds() const { return bounds_; }
    /// Of a surface; null for other kinds.
    [[nodiscard]] const scenes::Snapshot* snapshot() const { return scene_ ? &scene_->snapshot : nullptr; }
    /// Of a volume, along each axis.
    [[nodiscard]] std::optional<glm::i64vec3> voxels() const;
    /// What of the file was not followed.
    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

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
    std::vector<std::string> warnings_;
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
