#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/plots/table.h"
#include "bench/trials/chart.h"
#include "renderer/open_content.h"
#include "renderer/renderer.h"

namespace cairn::bench {

/// What contenders render frames of: a scene or a volume, by its path. Besides what `cairn render` takes:
/// builtin:hollow-sphere, the shell of Crassin 2007, section 3.7.2, and builtin:spheres-repeated, copies of
/// it of 256^3 voxels each. Both have as many voxels as the tree allows. And builtin:sponge, Menger's, in a
/// tree of its own (renderer/produce/fractal_content.h).
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
    [[nodiscard]] Cell triangles() const;  ///< nothing for a volume
    /// The tree that make() and content() take for these options: others for the sponge alone.
    [[nodiscard]] renderer::TreeOptions fitted(const renderer::TreeOptions& tree) const;
    /// @throws Error (Fault::usage) for a tree of the sponge whose N is neither 3 nor the usual one.
    [[nodiscard]] renderer::Renderer make(const renderer::TreeOptions& tree, const gl::ShaderSource& shaders,
                                          const renderer::RendererOptions& options = {},
                                          const renderer::VolumeOptions& volume = {}) const;
    /// The shape of that tree, no finer than a volume's voxels.
    [[nodiscard]] renderer::TreeShape shape(const renderer::TreeOptions& tree) const;
    /// What such a renderer shows, for those who look at it by other means.
    [[nodiscard]] std::unique_ptr<renderer::Content> content(
        const renderer::TreeOptions& tree, const gl::ShaderSource& shaders,
        const renderer::VolumeOptions& volume = {}) const;
    /// A view of the whole.
    [[nodiscard]] renderer::View view(int width, int height) const;

private:
    struct Data;
    /// A volume or a made field, and how it is shown.
    struct Shown {
        std::shared_ptr<const renderer::Field> field;
        renderer::TransferFunction transfer;
    };
    [[nodiscard]] Shown shown_field(const renderer::TreeOptions& tree) const;
    std::unique_ptr<Data> data_;
    std::string name_;
    scenes::Bounds bounds_;
};

/// Sees to it that no option of volumes is ignored without a word. If `options.voxels` has one, each of the
/// scenes that is no volume gets a note.
/// @param scenes  paths, as FrameCase takes them.
/// @throws Error (Fault::usage) if `options.voxels` has one, and none of the scenes is a volume.
void check_volume_options(Chart& chart, const ChartOptions& options, const std::vector<std::string>& scenes);

}  // namespace cairn::bench
