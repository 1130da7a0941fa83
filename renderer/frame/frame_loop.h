#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
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

/// When passes and production stop taking turns.
struct Goal {
    enum class End : std::uint8_t {
        /// Every ray has come to its end.
        nothing_missing,
        /// Every ray has come to its end, or time is up. Then ancestors stand in for what is missing.
        deadline,
        /// Prefetching: every ray has come to its end, time is up, or there is no room beside the bricks that
        /// frames have used.
        prefetch,
    };
    /// @param progress  called after each pass with the number of the band's pixels that are done.
    static Goal nothing_missing(std::function<void(double)> progress = {}) {
        return {End::nothing_missing, {}, std::move(progress)};
    }
    static Goal until(Clock::time_point deadline) { return {End::deadline, deadline, {}}; }
    static Goal prefetch_until(Clock::time_point deadline) { return {End::prefetch, deadline, {}}; }

    End end = End::nothing_missing;
    Clock::time_point deadline;
    std::function<void(double)> progress;
};

/// Result of running a band until its goal.
struct Outcome {
    bool done = false;      ///< no ray waits
    bool answered = false;  ///< at least one tile query was answered
    bool no_room = false;   ///< no tile query of the last pass could be answered
    bool gave_up = false;   ///< what the part uses passes the pools
    /// Missing tiles that an ancestor stood in for; none if there was no stand-in pass.
    std::optional<std::uint32_t> stood_in;
};

/// Renders the frames of one content: passes of rays, and production of what they ask for, in turn (Crassin
/// et al. 2008, section 5). Its TileCache holds the tiles, and its Marcher the rays.
///
/// Needs the context that was current at its construction.
class FrameLoop {
public:
    /// @throws Error  Fault::usage if a pool or the query capacity is out of range, or if the tree has mips
    ///                that the content does not fill; Fault::memory if the pools do not fit.
    FrameLoop(std::unique_ptr<Content> content, const PoolSizes& pools, const MarchOptions& options,
              const gl::ShaderSource& shaders);

    /// Draws meshes beside the voxels in all pictures from now on; an empty mix: voxels alone.
    void set_mix(const Mix& mix);

    [[nodiscard]] bool shows_surface() const { return marcher_.shows_surface(); }

    /// Renders rows of a picture, four bytes per pixel: RGBA8, or with SHOW_LIGHT the bits of a float.
    /// @param shown     SHOW_* of shaders/interop/march.h.
    /// @param progress  called after each pass with the share of the pixels that are done.
    /// @throws Error (Fault::usage) if the view is invalid, or if its picture does not have the rows.
    [[nodiscard]] optics::Image render(const View& view, Rows rows, int shown,
                                       const std::function<void(double)>& progress = {});
    /// Renders rows like render(), but only until the deadline; then ancestors stand in for missing tiles.
    /// The pools keep what was used since the first such frame of this view and these rows.
    /// @throws Error (Fault::usage) as render() does, and with TileQueries::blocks.
    [[nodiscard]] optics::Image render_until(const View& view, Rows rows, int shown,
                                             Clock::time_point deadline);

    /// Produces bricks for a view that may be asked for next, in room beside what the last frame used.
    /// @return  bricks produced.
    /// @throws Error (Fault::usage) as render_until() does.
    std::uint64_t prefetch(const View& next, Clock::time_point deadline);
    /// Produces bricks one level finer than the last view shows, band by band from the middle of the picture.
    PrefetchResult prefetch_finer(Clock::time_point deadline);

    /// Marches the next frame even if its view is the last one.
    void forget_picture() { picture_.forget(); }

    /// Counters of the last render() or render_until().
    [[nodiscard]] const FrameStatistics& statistics() const { return statistics_; }

private:
    /// Frames within a budget, one after the other, of the same rows of the same view.
    struct RefinementState {
        View view;
        Rows rows;
        /// The pools keep what these frames have used since this round; none: since the next frame.
        std::optional<Round> since;
        /// Missing tiles that ancestors stood in for when the pools had filled. The pools also keep what
        /// stood in at first. So the frames start again without it, as long as each start leaves fewer tiles
        /// missing.
        std::optional<std::uint32_t> stood_in;
    };
    /// How far prefetch_finer() has come with the last view.
    struct PrefetchState {
        View view;
        Round since;  ///< round in which the view was first rendered
        int bands_done = 0;
        bool is_done = false;
    };
    /// Counters since the loop was made.
    struct PassCounters {
        int passes = 0;
        std::uint64_t rays_launched = 0;
        std::uint64_t query_bytes = 0;
        double march_ms = 0.0;
        double produce_ms = 0.0;
        double window_ms = 0.0;  ///< part of `produce_ms`: finding the tiles of windows
    };

    void check_request(const View& view, Rows rows) const;
    void require_lists() const;
    /// @param goal_of  returns the goal of the band that begins at a row.
    [[nodiscard]] optics::Image render_bands(const View& view, Rows rows, int shown,
                                             const std::function<Goal(int)>& goal_of);
    void run_bands(Band& band, Rows rows, int shown, std::uint32_t background,
                   const std::function<Goal(int)>& goal_of, optics::Image& image);
    Outcome run_band(Band& band, const Goal& goal);
    void run_parts(Band& band, const Goal& goal);
    Outcome run_part(Band& band, const Goal& goal, bool may_give_up = false);
    [[nodiscard]] PassResult run_pass(Band& band, PassKind kind);
    TileCache::Answer produce(Band& band, const PassResult& pass, const Goal& goal, bool any_answered);
    void find_tiles_below(Band& band, const std::vector<std::uint32_t>& parents);
    void start_again_for_less(const Outcome& outcome);
    void note_frame(const TileCache::Counters& cache_before, const PassCounters& passes_before);

    TileCache cache_;
    Marcher marcher_;
    TileQueries tile_queries_;
    Mix mix_;
    KeptPicture picture_;
    /// Blocks of pixels of a part, in which bands of frames without a budget are marched if what more blocks
    /// use passes the pools.
    std::size_t part_blocks_ = std::numeric_limits<std::size_t>::max();
    int small_parts_ = 0;  // parts in a row that used few of the bricks in the pool
    RefinementState refinement_;
    std::optional<PrefetchState> prefetch_state_;  // none before the first frame
    std::uint64_t prefetched_ = 0;                 // bricks prefetched since the last frame
    Round frame_since_{1};                         // first round of the last frame
    Round round_{1};
    PassCounters passes_;
    FrameStatistics statistics_;
};

}  // namespace cairn::renderer
