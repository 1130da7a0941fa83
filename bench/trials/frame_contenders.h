#pragma once

#include <memory>
#include <vector>

#include "bench/plots/table.h"
#include "renderer/renderer.h"

namespace cairn::bench {

/// A frame that is marched, whatever was shown before.
renderer::Frame marched_frame(renderer::Renderer& renderer, const renderer::View& view,
                              const renderer::Request& request = {});

/// Renderers whose frames are measured in turn, so that their ratios hold when the machine's speed drifts.
struct FrameContender {
    std::shared_ptr<renderer::Renderer> renderer;  ///< of several, where pools hold what all of them use
    renderer::View view;
    double first_ms = 0.0;                ///< the first frame, into empty pools
    renderer::FrameStatistics first;      ///< of it
    renderer::FrameStatistics converged;  ///< of the last
    optics::Image image;                  ///< of the last
    std::vector<double> samples_ms;       ///< converged frames

    FrameContender(renderer::Renderer made, const renderer::View& view);
    FrameContender(std::shared_ptr<renderer::Renderer> made, const renderer::View& view);
};
/// @param budget_ms  of each, on average: no further round begins once it is spent.
void measure_in_turn(std::vector<FrameContender>& contenders, int runs, double budget_ms);

/// The last two columns of every table of frames: "driver" and "threads".
[[nodiscard]] std::vector<Cell> on_this_machine(std::vector<Cell> row);

}  // namespace cairn::bench
