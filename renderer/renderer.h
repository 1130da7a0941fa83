#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "base/clock.h"
#include "gl/shader_source.h"
#include "optics/image.h"
#include "renderer/frame/frame_statistics.h"
#include "renderer/mesh/mix.h"
#include "renderer/produce/content.h"
#include "renderer/renderer_options.h"
#include "renderer/view/view.h"

namespace cairn::renderer {

class FrameLoop;

/// Called after each pass with the share of pixels that are done, in [0, 1].
using Progress = std::function<void(double)>;

/// What of a picture is wanted, and how long it may take.
struct Request {
    /// Only these rows, which are those of the whole picture, bit for bit: for a caller that has other things
    /// to do between them. The image is as high as there are rows.
    std::optional<Rows> rows = std::nullopt;
    /// Nothing is produced once so much time has passed since the call; first comes what most rays ask for.
    /// What is missing then is shown by the nearest ancestor that has a brick, or not at all. Rays are never
    /// cut short: a frame takes at least as long as marching it once. Without a budget a frame ends when
    /// nothing is missing.
    ///
    /// Requested again for the same view and rows, a frame goes on where the one before stopped, until the
    /// picture is that of a request without a budget: FrameStatistics::converged. What the frames used for
    /// this view since the first of them is not given up, so pools too small for the view leave some of it at
    /// a lower level of detail and come to rest.
    std::optional<Milliseconds> budget = std::nullopt;
    /// Of frames without a budget; may be empty.
    Progress progress = {};
};

/// A picture, and what it took.
struct Frame {
    optics::Image image;
    FrameStatistics statistics;
};

/// Per pixel what arrives of the light, and what it took to know.
struct LightFrame {
    optics::LightShares light;
    FrameStatistics statistics;
};

/// Renders a content through its voxel cache: a scene, a volume or a producer of one's own
/// (renderer/open_content.h). Only what rays prove visible is voxelized, no finer than a pixel shows. Bricks
/// stay in the pools from one frame to the next. Needs the context that was current at its construction.
///
/// The picture depends on the view (and the mix) alone: not on the pools' sizes, nor on what earlier frames
/// left in them. So the finished rows of the last view are kept (up to 64 MiB) and given again, without
/// marching, for as long as the view does not change.
class Renderer {
public:
    /// @throws Error  Fault::usage for pools or march options that cannot work with the content;
    /// Fault::memory when the pools do not fit.
    explicit Renderer(std::unique_ptr<Content> content, const RendererOptions& options = {},
                      const gl::ShaderSource& shaders = {});
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;
    ~Renderer();

    /// For all pictures from now on; an empty mix for voxels alone.
    void set_mix(const Mix& mix);

    /// @throws Error (Fault::usage)  if the view is invalid, the picture does not have the rows, or a budget
    /// meets TileQueries::blocks.
    Frame render(const View& view, const Request& request = {});

    /// What arrives of the light at the pixels of the same rays, instead of colours.
    /// @throws Error (Fault::usage)  as render() does, and for volumes, whose light is not that of one place.
    LightFrame light(const View& view, const Progress& progress = {});

    /// Produces bricks for a view that may be asked for next, where it finds room that the last frame does
    /// not need, until the budget is spent. Changes no picture.
    /// @throws Error (Fault::usage)  as render() does with a budget.
    /// @return  bricks produced.
    std::uint64_t prefetch(const View& next, Milliseconds budget);

    /// Produces for the last view one level finer than it shows, for a camera that moves closer: some bands
    /// of the view's rows in each call, and only what finds room beside all that this view has used since it
    /// was first rendered. A call takes some milliseconds longer than the budget.
    Prefetched prefetch_finer(Milliseconds budget);

    /// The next frame is marched, whatever its view: for measurements.
    void forget_picture();

private:
    std::unique_ptr<FrameLoop> loop_;
};

}  // namespace cairn::renderer
