#pragma once

#include <memory>
#include <vector>

#include "bench/plots/table.h"
#include "renderer/renderer.h"

namespace cairn::bench {

/// A frame that is marched, whatever was shown before.
renderer::Frame marched_frame(renderer::Renderer& renderer, const renderer::View& view,
                              const renderer::Request& request = {});

/// A renderer and a view, whose frames are measured in turn with those of others, so that their ratios hold
/// when the machine's speed drifts.
struct FrameContender {
    /// Several contenders share one if its pools hold what all of them use.
    std::shared_ptr<renderer::Renderer> renderer;
    renderer::View view;
    double first_ms = 0.0;                ///< the first frame, into empty pools
    renderer::FrameStatistics first;      ///< of the first frame
    renderer::FrameStatistics converged;  ///< of the last frame
    optics::Image image;                  ///< the last frame
    std::vector<double> samples_ms;       ///< one per converged frame

    FrameContender(renderer::Renderer made, const renderer::View& view);
    FrameContender(std::shared_ptr<renderer::Renderer> made, const renderer::View& view);
};
/// @param budget_ms  per contender, on average: no further round begins once it is spent.
void measure_in_turn(std::vector<FrameContender>& contenders, int runs, double budget_ms);

/// The last two columns of every table of frames: "driver" and "threads".
[[nodiscard]] std::vector<Cell> on_this_machine(std::vector<Cell> row);

}  // namespace cairn::bench
