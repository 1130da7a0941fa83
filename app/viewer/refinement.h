#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "app/viewer/pace.h"
#include "renderer/renderer.h"

namespace cairn::app {

/// Some rows of a picture that is being refined.
struct Band {
    renderer::Rows rows;
    bool converged = false;
    bool stuck = false;   ///< the pools are too small for it
    int idle_visits = 0;  ///< that changed nothing
    int visits = 0;
};

/// A picture that comes to be in slices of rows, so that whoever asks for it can do other things in between.
/// First every row is rendered with what is there, then those are gone over that lack something.
class Refinement {
public:
    Refinement() { view_.size = {0, 0}; }  ///< nothing to do
    explicit Refinement(const renderer::View& view);

    [[nodiscard]] const renderer::View& view() const { return view_; }
    [[nodiscard]] const optics::Image& image() const { return image_; }  ///< rows of no band are not filled
    [[nodiscard]] const std::vector<Band>& bands() const { return bands_; }
    [[nodiscard]] bool empty() const { return image_.rgba.empty(); }

    /// Every row has been rendered once.
    [[nodiscard]] bool complete() const { return next_row_ == view_.size.height; }
    /// Nothing is left to do, but perhaps for want of room in the pools.
    [[nodiscard]] bool settled() const;
    /// The picture is that of Renderer::render() without a budget.
    [[nodiscard]] bool converged() const;
    [[nodiscard]] double share_done() const;  ///< rows that are settled, in [0, 1]

    /// Renders one slice; only when it is not settled. @return what the slice took.
    renderer::FrameStatistics step(renderer::Renderer& renderer, Pace& pace);

    /// Renders one slice that is stuck as if there were all the time: it converges whatever the pools' size.
    /// @return what the slice took; none if no slice is stuck.
    std::optional<renderer::FrameStatistics> finish_stuck(renderer::Renderer& renderer);

private:
    void note_visit(Band& band, const optics::Image& rows, const renderer::FrameStatistics& statistics) const;
    void put(const optics::Image& rows, int first_row);
    [[nodiscard]] Band& choose(const Pace& pace);

    renderer::View view_;
    optics::Image image_;
    std::vector<Band> bands_;
    int next_row_ = 0;  // of the first sweep
};

}  // namespace cairn::app
