#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "base/clock.h"
#include "gl/shader_source.h"
#include "optics/image.h"
#include "renderer/frame/frame_statistics.h"
#include "renderer/march/march_options.h"
#include "renderer/mesh/mix.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/produce/content.h"
#include "renderer/view/view.h"

namespace cairn::renderer {

class FrameLoop;

/// How a renderer works. No picture depends on it. The shape of the tree belongs to the content
/// (TreeOptions).
struct RendererOptions {
    PoolSizes pools = {};
    MarchOptions march = {};
    bool operator==(const RendererOptions&) const = default;
};

/// Called after each pass with the share of pixels that are done, in [0, 1].
using Progress = std::function<void(double)>;

/// Which part of a picture is wanted, and how long it may take.
struct Request {
    /// Renders only these rows. They equal those of the whole picture, bit for bit, and the image has just
    /// these rows: for a caller that has other things to do between them. None: the whole picture.
    std::optional<Rows> rows = std::nullopt;
    /// Production stops when this much time has passed since the call; until then, the tiles that most rays
    /// ask for come first. A tile that is still missing is shown by its nearest ancestor that has a brick, or
    /// not at all. Rays are never cut short: a frame takes at least as long as marching it once. None: the
    /// frame ends when nothing is missing.
    ///
    /// A frame requested again for the same view and rows goes on where the one before stopped, until the
    /// picture is that of a request without a budget (FrameStatistics::converged). The pools keep what these
    /// frames have used since the first of them. So if the pools are too small for the view, some of it stays
    /// at a lower level of detail, and the picture comes to rest.
    std::optional<Milliseconds> budget = std::nullopt;
    /// Called by frames without a budget; may be empty.
    Progress progress = {};
};

/// A picture, and the counters of its frame.
struct Frame {
    optics::Image image;
    FrameStatistics statistics;
};

/// The share of the light that arrives at each pixel, and the counters of the frame.
struct LightFrame {
    optics::LightShares light;
    FrameStatistics statistics;
};

/// Renders a content through its voxel cache: a scene, a volume or a producer of one's own
/// (renderer/open_content.h). Only what rays prove visible is voxelized, no finer than a pixel shows. Bricks
/// stay in the pools from one frame to the next. Needs the context that was current at its construction.
///
/// The picture depends on the view (and the mix) alone: not on the sizes of the pools, nor on what earlier
/// frames left in them. So the renderer keeps the finished rows of the last view of one sample (up to 64
/// MiB), and returns them without marching for as long as the view does not change.
class Renderer {
public:
    /// @throws Error  Fault::usage if pools or march options do not suit the content; Fault::memory if the
    ///                pools do not fit.
    explicit Renderer(std::unique_ptr<Content> content, const RendererOptions& options = {},
                      const gl::ShaderSource& shaders = {});
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;
    ~Renderer();

    /// Draws meshes beside the voxels in all pictures from now on; an empty mix: voxels alone.
    void set_mix(const Mix& mix);

    /// @throws Error (Fault::usage)  if the view is invalid, if the picture does not have the rows, or if a
    ///                               budget is combined with TileQueries::blocks or with several samples.
    Frame render(const View& view, const Request& request = {});

    /// Renders with the same rays as render(), but returns shares of the light instead of colours.
    /// @throws Error (Fault::usage)  as render() does, and for volumes: a pixel of a volume gathers light
    ///                               from many places; and for views of several samples.
    LightFrame light(const View& view, const Progress& progress = {});

    /// Produces bricks for a view that may be asked for next, in room that the last frame does not need,
    /// until the budget is spent. Changes no picture.
    /// @throws Error (Fault::usage)  as render() does with a budget.
    /// @return  bricks produced.
    std::uint64_t prefetch(const View& next, Milliseconds budget);

    /// Produces bricks one level finer than the last view shows, for a camera that moves closer. Each call
    /// does some bands of the view's rows, and only in room beside all that this view has used since it was
    /// first rendered. A call takes some milliseconds longer than the budget.
    PrefetchResult prefetch_finer(Milliseconds budget);

    /// Marches the next frame even if its view is the last one: for measurements.
    void forget_picture();

private:
    [[nodiscard]] Frame render_sample(const View& view, const Request& request);

    std::unique_ptr<FrameLoop> loop_;
};

}  // namespace cairn::renderer
