#pragma once

#include <memory>
#include <vector>

#include "bench/plots/table.h"
#include "renderer/renderer.h"

namespace cairn::bench {

/// Marches a frame even if the same picture was rendered before.
renderer::Frame marched_frame(renderer::Renderer& renderer, const renderer::View& view,
                              const renderer::Request& request = {});

/// A renderer and a view. Its frames are measured in turn with those of other contenders, so that ratios hold
/// if the machine's speed drifts.
struct FrameContender {
    /// Contenders may share a renderer if its pools hold the bricks of all their views.
    std::shared_ptr<renderer::Renderer> renderer;
    renderer::View view;
    double first_ms = 0.0;                ///< time of the first frame, into empty pools
    renderer::FrameStatistics first;      ///< statistics of the first frame
    renderer::FrameStatistics converged;  ///< statistics of the last frame
    optics::Image image;                  ///< picture of the last frame
    std::vector<double> samples_ms;       ///< time per converged frame

    FrameContender(renderer::Renderer made, const renderer::View& view);
    FrameContender(std::shared_ptr<renderer::Renderer> made, const renderer::View& view);
};
/// Renders converged frames of all contenders in turn.
/// @param budget_ms  milliseconds per contender, on average: no further round begins once it is spent.
void measure_in_turn(std::vector<FrameContender>& contenders, int runs, double budget_ms);

/// Appends the last two columns of every table of frames: "driver" and "threads".
[[nodiscard]] std::vector<Cell> on_this_machine(std::vector<Cell> row);

}  // namespace cairn::bench
