#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/plots/table.h"
#include "bench/trials/chart.h"
#include "renderer/open_content.h"
#include "renderer/renderer.h"

namespace cairn::bench {

/// A scene or a volume that contenders render frames of, by its path. Besides the paths of `cairn render`:
/// builtin:hollow-sphere is the shell of Crassin 2007, section 3.7.2; builtin:spheres-repeated is made of
/// copies of that shell of 256^3 voxels each. Both have as many voxels as the tree allows. builtin:sponge is
/// Menger's, in a tree of its own (renderer/produce/fractal_content.h).
class FrameCase {
public:
    explicit FrameCase(const std::string& path);
    ~FrameCase();
    FrameCase(FrameCase&&) noexcept;
    FrameCase& operator=(FrameCase&&) noexcept;
    FrameCase(const FrameCase&) = delete;
    FrameCase& operator=(const FrameCase&) = delete;

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const scenes::Bounds& bounds() const { return bounds_; }
    /// Number of triangles; an empty cell if it is a volume.
    [[nodiscard]] Cell triangles() const;
    /// The options of the tree that make() and content() build. They differ from `tree` for the sponge alone.
    /// @throws Error (Fault::usage) for a tree of the sponge whose N is neither 3 nor the usual one.
    [[nodiscard]] renderer::TreeOptions fitted(const renderer::TreeOptions& tree) const;
    /// A renderer of the case. @throws Error as fitted() does.
    [[nodiscard]] renderer::Renderer make(const renderer::TreeOptions& tree, const gl::ShaderSource& shaders,
                                          const renderer::RendererOptions& options = {},
                                          const renderer::VolumeOptions& volume = {}) const;
    /// The shape of the tree of make(), no finer than a volume's voxels.
    [[nodiscard]] renderer::TreeShape shape(const renderer::TreeOptions& tree) const;
    /// The content of such a renderer, for other ways to render it. @throws Error as fitted() does.
    [[nodiscard]] std::unique_ptr<renderer::Content> content(
        const renderer::TreeOptions& tree, const gl::ShaderSource& shaders,
        const renderer::VolumeOptions& volume = {}) const;
    /// A view of the whole case.
    [[nodiscard]] renderer::View view(int width, int height) const;

private:
    struct Data;
    /// A volume or a made field, and its transfer function.
    struct ShownField {
        std::shared_ptr<const renderer::Field> field;
        renderer::TransferFunction transfer;
    };
    [[nodiscard]] ShownField shown_field(const renderer::TreeOptions& tree) const;
    std::unique_ptr<Data> data_;
    std::string name_;
    scenes::Bounds bounds_;
};

/// Ensures that options of volumes are not ignored silently: if `options.voxels` has one, adds a note for
/// each scene that is not a volume.
/// @param scenes  paths, as FrameCase takes them.
/// @throws Error (Fault::usage) if `options.voxels` has one and none of the scenes is a volume.
void check_volume_options(Chart& chart, const ChartOptions& options, const std::vector<std::string>& scenes);

}  // namespace cairn::bench
