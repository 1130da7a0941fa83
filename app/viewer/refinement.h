#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "app/viewer/pace.h"
#include "optics/image_mean.h"
#include "renderer/renderer.h"

namespace cairn::app {

/// Adjacent rows of a picture that is being refined.
struct Band {
    renderer::Rows rows;
    bool converged = false;
    bool stuck = false;   ///< the pools are too small
    int idle_visits = 0;  ///< visits in a row that changed nothing
    int visits = 0;       ///< slices that rendered these rows
};

/// Renders a picture in slices of rows, so that the caller can do other things in between. First every row is
/// rendered with the bricks that are there, then the rows that lack bricks are rendered again. A view of
/// several samples is rendered sample after sample in this way; the picture is the mean of those that are
/// complete. A sample that the pools cannot hold is the last, unless finish_stuck() is called.
class Refinement {
public:
    /// An empty picture: nothing is left to do.
    Refinement() { view_.size = {0, 0}; }
    explicit Refinement(const renderer::View& view);

    [[nodiscard]] const renderer::View& view() const { return view_; }
    /// The picture so far. Rows that are in no band are not rendered yet.
    [[nodiscard]] const optics::Image& image() const { return image_; }
    [[nodiscard]] const std::vector<Band>& bands() const { return bands_; }
    [[nodiscard]] bool empty() const { return image_.rgba.empty(); }

    /// Whether every row has been rendered once.
    [[nodiscard]] bool complete() const { return sample_ > 0 || swept(); }
    /// Whether nothing is left to do that the pools have room for.
    [[nodiscard]] bool settled() const;
    /// Whether the picture is that of Renderer::render() without a budget.
    [[nodiscard]] bool converged() const;
    /// Share of the rows that are settled, in [0, 1].
    [[nodiscard]] double share_done() const;

    /// Renders one slice. Must not be settled(). @return the statistics of the slice.
    renderer::FrameStatistics step(renderer::Renderer& renderer, Pace& pace);

    /// Renders one stuck slice without a budget, so that it converges whatever the size of the pools.
    /// @return the statistics of the slice; none if no slice is stuck.
    std::optional<renderer::FrameStatistics> finish_stuck(renderer::Renderer& renderer);

private:
    /// The view of the sample that is rendered now.
    [[nodiscard]] renderer::View sample_view() const;
    [[nodiscard]] bool swept() const { return next_row_ == view_.size.height; }
    [[nodiscard]] bool sample_converged() const;
    void finish_sample();
    [[nodiscard]] std::vector<Band>& work() { return sample_ == 0 ? bands_ : sample_bands_; }
    [[nodiscard]] const std::vector<Band>& work() const { return sample_ == 0 ? bands_ : sample_bands_; }
    [[nodiscard]] optics::Image& target() { return sample_ == 0 ? image_ : sample_image_; }
    void note_visit(Band& band, const optics::Image& rows, const renderer::FrameStatistics& statistics);
    void put(const optics::Image& rows, int first_row);
    [[nodiscard]] Band& choose(const Pace& pace);

    renderer::View view_;
    optics::Image image_;
    std::vector<Band> bands_;  // of the first sample
    int next_row_ = 0;         // next row of the sample's first sweep
    int sample_ = 0;           // the sample that is rendered now
    bool has_all_samples_ = false;
    optics::Image sample_image_;      // of the samples behind the first one
    std::vector<Band> sample_bands_;  // of such a sample
    optics::ImageMean mean_;
};

}  // namespace cairn::app
