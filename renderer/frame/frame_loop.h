#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "gl/shader_source.h"
#include "optics/image.h"
#include "renderer/frame/band.h"
#include "renderer/frame/frame_statistics.h"
#include "renderer/frame/kept_picture.h"
#include "renderer/march/marcher.h"
#include "renderer/mesh/mix.h"
#include "renderer/pool/round.h"
#include "renderer/produce/tile_cache.h"
#include "renderer/view/view.h"

namespace cairn::renderer {

/// When passes and production have taken turns for long enough.
struct Goal {
    enum class End : std::uint8_t {
        nothing_missing,  ///< every ray has come to its end
        deadline,         ///< the same, or time is up: then ancestors stand in for what is missing
        ahead,            ///< the same, or time is up, or there is no room beside what frames have used
    };
    /// @param progress  called after each pass with the pixels of the band that are done.
    static Goal nothing_missing(std::function<void(double)> progress = {}) {
        return {End::nothing_missing, {}, std::move(progress)};
    }
    static Goal until(Clock::time_point deadline) { return {End::deadline, deadline, {}}; }
    static Goal ahead_until(Clock::time_point deadline) { return {End::ahead, deadline, {}}; }

    End end = End::nothing_missing;
    Clock::time_point deadline;
    std::function<void(double)> progress;
};

/// What a run of a band came to.
struct Outcome {
    bool done = false;      ///< no ray waits
    bool answered = false;  ///< some tile got what was asked for
    bool no_room = false;   ///< no tile did of those that the last pass asked for
    /// Missing tiles that rays did not wait for; nothing where none had to be stood in for.
    std::optional<std::uint32_t> stood_in;
};

/// Passes of rays, and production of what they ask for, in turn (Crassin et al. 2008, section 5): the frames
/// of one content. What tiles hold is for its TileCache to know, and what rays do for its Marcher.
///
/// Needs the context that was current at its construction.
class FrameLoop {
public:
    /// @throws Error  Fault::usage for a pool or a query capacity that cannot work, and for mips that the
    /// content does not fill; Fault::memory when the pools do not fit.
    FrameLoop(std::unique_ptr<Content> content, const PoolSizes& pools, const MarchOptions& options,
              const gl::ShaderSource& shaders);

    /// For all pictures from now on; an empty one for voxels alone.
    void set_mix(const Mix& mix);

    [[nodiscard]] bool marches_surfaces() const { return marcher_.marches_surfaces(); }

    /// Rows of a picture, four bytes per pixel: RGBA8, or with SHOW_LIGHT the bits of a float.
    /// @param shown  SHOW_* of shaders/interop/march.h.
    /// @param progress  called after each pass with the share of the picture's pixels that are done.
    /// @throws Error (Fault::usage) for a view, or rows, that cannot be.
    [[nodiscard]] optics::Image render(const View& view, Rows rows, int shown,
                                       const std::function<void(double)>& progress = {});
    /// What is missing when time is up is stood in for. What was used since the first such frame of this view
    /// and these rows is kept.
    /// @throws Error (Fault::usage) as above, and with TileQueries::blocks.
    [[nodiscard]] optics::Image render_until(const View& view, Rows rows, int shown,
                                             Clock::time_point deadline);

    /// Produces for a view that may be asked for next, beside what the last frame used.
    /// @return bricks produced.
    /// @throws Error (Fault::usage) as render_until() does.
    std::uint64_t prefetch(const View& next, Clock::time_point deadline);
    /// The same for the last view one level finer, band by band from the middle.
    Prefetched prefetch_finer(Clock::time_point deadline);

    /// The next frame is marched, whatever its view.
    void forget_picture() { picture_.forget(); }

    /// Of the last render() or render_until().
    [[nodiscard]] const FrameStatistics& statistics() const { return statistics_; }

private:
    /// Frames of the same rows of the same view within a budget, one after the other.
    struct Refined {
        View view;
        Rows rows;
        std::optional<Round> since;  ///< what they used from then on is kept; none: from the next one on
        /// When the pools had filled: tiles that were stood in for. What stood in at first is kept too; while
        /// a new start leaves fewer missing, there is another.
        std::optional<std::uint32_t> stood_in;
    };
    /// The last view, of which prefetch_finer() produces more than it shows.
    struct Ahead {
        View view;
        Round since;  ///< when it was first rendered
        int bands_done = 0;
        bool is_done = false;
    };
    /// Since the loop was made.
    struct PassCounters {
        int passes = 0;
        std::uint64_t rays_launched = 0;
        std::uint64_t query_bytes = 0;
        double march_ms = 0.0;
        double produce_ms = 0.0;
        double window_ms = 0.0;  ///< of `produce_ms`: finding the windows' tiles
    };

    void check_request(const View& view, Rows rows) const;
    void require_lists() const;
    /// @param goal_of  the goal of the band that begins at a row.
    [[nodiscard]] optics::Image render_bands(const View& view, Rows rows, int shown,
                                             const std::function<Goal(int)>& goal_of);
    void march_bands(Band& band, Rows rows, int shown, std::uint32_t background,
                     const std::function<Goal(int)>& goal_of, optics::Image& image);
    Outcome run(Band& band, const Goal& goal);
    [[nodiscard]] PassResult march(Band& band, PassKind kind);
    TileCache::Answer produce(Band& band, const PassResult& pass, const Goal& goal, bool any_answered);
    void find_tiles_below(Band& band, const std::vector<std::uint32_t>& parents);
    void keep_since(std::optional<Round> round);
    void start_again_for_less(const Outcome& outcome);
    void note_frame(const TileCache::Counters& cache_before, const PassCounters& passes_before);

    TileCache cache_;
    Marcher marcher_;
    TileQueries tile_queries_;
    Mix mix_;
    KeptPicture picture_;
    Refined refined_;
    std::optional<Ahead> ahead_;    // none before the first frame
    std::uint64_t prefetched_ = 0;  // bricks, since the last frame
    Round frame_since_{1};          // what was used since then is the last frame's
    Round round_{1};
    PassCounters passes_;
    FrameStatistics statistics_;
};

}  // namespace cairn::renderer
