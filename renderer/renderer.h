#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "gl/shader_source.h"
#include "optics/image.h"
#include "renderer/frame/frame_statistics.h"
#include "renderer/frame/tree_options.h"
#include "renderer/march/transfer_function.h"
#include "renderer/mesh/mix.h"
#include "renderer/produce/content.h"
#include "renderer/produce/volume_field.h"
#include "renderer/view/view.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"
#include "scenes/volume/volume.h"

namespace cairn::renderer {

/// Renders a scene, or a volume, through its voxel cache. Only what rays prove visible is voxelized, no finer
/// than a pixel shows. Bricks stay in the pools from one frame to the next. Needs the context that was
/// current at its construction.
///
/// The picture depends on the view (and the mix) alone: not on the pools' sizes, nor on what earlier frames
/// left in them. So the finished rows of the last view are kept (up to 64 MiB) and given again, without
/// marching, for as long as the view does not change.
class Renderer {
public:
    /// The scene and the snapshot are not needed afterwards.
    /// @throws Error  Fault::usage for a tree shape or a pool that cannot work; Fault::memory when it does
    /// not fit.
    Renderer(const scenes::Scene& scene, const scenes::Snapshot& snapshot, const TreeOptions& options = {},
             const gl::ShaderSource& shaders = {});
    /// A volume: its densities as the transfer function shows them, marched at the volume's own resolution,
    /// or `options.max_resolution` if that is coarser. The volume is not needed afterwards.
    /// @throws Error  as above; Fault::usage for VolumeOptions out of range.
    Renderer(const scenes::Volume& volume, const TransferFunction& transfer, const TreeOptions& options = {},
             const VolumeOptions& volume_options = {}, const gl::ShaderSource& shaders = {});
    /// A field of densities, made for the tree's n.
    Renderer(std::shared_ptr<const Field> field, const TransferFunction& transfer,
             const TreeOptions& options = {}, const VolumeOptions& volume_options = {},
             const gl::ShaderSource& shaders = {});

    /// Content made for tree_shape_of(options), which must be the options here.
    Renderer(std::unique_ptr<Content> content, const TreeOptions& options,
             const gl::ShaderSource& shaders = {});
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;
    ~Renderer();

    /// For all pictures from now on; an empty one for voxels alone.
    void set_mix(const Mix& mix);

    /// @param progress  called after each pass with the share of pixels that are done, in [0, 1].
    [[nodiscard]] optics::Image render(const View& view, const std::function<void(double)>& progress = {});

    /// Of the same rays what arrives of the light, instead of colours.
    /// @throws Error (Fault::usage) for volumes, whose light is not that of one place.
    [[nodiscard]] optics::LightShares light_shares(const View& view,
                                                   const std::function<void(double)>& progress = {});

    /// Renders what is there, and produces no longer than until `budget_ms` have passed since the call: first
    /// what most rays ask for. What is missing then is shown by the nearest ancestor that has a brick, or not
    /// at all. Rays are never cut short: a frame takes at least as long as marching it once.
    ///
    /// Called again for the same view, it goes on where it stopped, until the picture is that of render():
    /// statistics().converged. What it used for this view since the first of these calls it does not give up,
    /// so pools too small for the view leave some of it at a lower level of detail and come to rest.
    [[nodiscard]] optics::Image render_within(const View& view, double budget_ms);

    /// The same for some rows of the picture, which are those of the whole one, bit for bit: for a caller
    /// that has other things to do between them. The image is as high as there are rows.
    /// @throws Error (Fault::usage) when the picture does not have such rows.
    [[nodiscard]] optics::Image render_rows(const View& view, Rows rows);
    [[nodiscard]] optics::Image render_rows_within(const View& view, Rows rows, double budget_ms);

    /// Produces bricks for a view that may be asked for next, where it finds room that the last frame does
    /// not need, until `budget_ms` have passed. Changes no picture.
    /// @throws Error (Fault::usage) with TileQueries::blocks, as render_within() does.
    /// @return  bricks produced.
    std::uint64_t prefetch(const View& next, double budget_ms);

    /// The same for the last view one level finer, as it is needed by who comes nearer: some bands of its
    /// rows in each call, and only what finds room beside all that this view has used since it was first
    /// rendered. A call takes some milliseconds longer than `budget_ms`.
    Prefetched prefetch_finer(double budget_ms);

    /// The next frame is marched, whatever its view: for measurements.
    void forget_picture();

    /// Of the last `render()` or `render_within()`, whole or in rows.
    [[nodiscard]] const FrameStatistics& statistics() const;

private:
    struct Parts;
    /// Marches rows of a picture band by band; `march_band(row)` brings one to its end.
    /// @param shown  SHOW_* of shaders/interop/march.h.
    optics::Image march(const View& view, Rows rows, int shown, const std::function<void(int)>& march_band);
    std::unique_ptr<Parts> parts_;
};

}  // namespace cairn::renderer
