#include "app/viewer/refinement.h"

#include <algorithm>

namespace cairn::app {
namespace {

/// A band that lacks bricks is given up, because the pools are too small, after most_idle_visits visits that
/// produced nothing and changed no pixel, or after most_visits visits in all.
constexpr int most_idle_visits = 3;
constexpr int most_visits = 500;
/// Height of the marcher's blocks of pixels.
constexpr int block_rows = 8;

int rows_at(const Pace& pace, int width) {
    return std::max(int(pace.pixels() / width) / block_rows * block_rows, block_rows);
}

}  // namespace

Refinement::Refinement(const renderer::View& view) : view_(view) {
    image_.width = view.size.width;
    image_.height = view.size.height;
    image_.rgba.resize(std::size_t(view.size.width) * std::size_t(view.size.height) * 4);
}

bool Refinement::settled() const {
    return complete() && std::all_of(bands_.begin(), bands_.end(),
                                     [](const Band& band) { return band.converged || band.stuck; });
}

bool Refinement::converged() const {
    return complete() &&
           std::all_of(bands_.begin(), bands_.end(), [](const Band& band) { return band.converged; });
}

double Refinement::share_done() const {
    if (view_.size.height == 0) return 1.0;
    int rows = 0;
    for (const Band& band : bands_)
        rows += band.converged || band.stuck ? band.rows.count : 0;
    return double(rows) / view_.size.height;
}

/// Chooses the next rows of the first sweep; after it, the last band that lacks bricks, until nothing more
/// can be done for that band. If the pools held one band but not all, bands in turn would evict each other's
/// bricks. Bands go from the last to the first, because the pools hold the bricks that the sweep used last. A
/// band is cut if it would take too long.
Band& Refinement::choose(const Pace& pace) {
    const int rows = rows_at(pace, view_.size.width);
    if (!complete()) {
        const int count = std::min(rows, view_.size.height - next_row_);
        bands_.push_back({{next_row_, count}});
        next_row_ += count;
        return bands_.back();
    }
    const auto last = std::find_if(bands_.rbegin(), bands_.rend(),
                                   [](const Band& band) { return !band.converged && !band.stuck; });
    if (last->rows.count < 2 * rows) return *last;
    const int kept = last->rows.count - rows;
    const Band cut{{last->rows.first + kept, rows}};
    last->rows.count = kept;
    return *bands_.insert(last.base(), cut);
}

renderer::FrameStatistics Refinement::step(renderer::Renderer& renderer, Pace& pace) {
    Band& band = choose(pace);
    const auto [rows, statistics] =
        renderer.render(view_, {.rows = band.rows, .budget = Milliseconds(pace.aim_ms())});
    band.converged = statistics.converged;
    note_visit(band, rows, statistics);
    pace.learn(statistics.march_ms, double(view_.size.width) * band.rows.count);
    put(rows, band.rows.first);
    return statistics;
}

void Refinement::note_visit(Band& band, const optics::Image& rows,
                            const renderer::FrameStatistics& statistics) const {
    const auto before = image_.rgba.begin() + std::ptrdiff_t(band.rows.first) * view_.size.width * 4;
    const bool answered =
        statistics.bricks_produced > 0 || statistics.bricks_restored > 0 || statistics.nodes_subdivided > 0;
    const bool same = std::equal(rows.rgba.begin(), rows.rgba.end(), before);
    band.idle_visits = same && !answered ? band.idle_visits + 1 : 0;
    ++band.visits;
    band.stuck = !band.converged && (band.idle_visits >= most_idle_visits || band.visits >= most_visits);
}

std::optional<renderer::FrameStatistics> Refinement::finish_stuck(renderer::Renderer& renderer) {
    for (Band& band : bands_) {
        if (band.converged) continue;
        const renderer::Frame frame = renderer.render(view_, {.rows = band.rows});
        put(frame.image, band.rows.first);
        band.converged = true;
        band.stuck = false;
        return frame.statistics;
    }
    return std::nullopt;
}

void Refinement::put(const optics::Image& rows, int first_row) {
    std::copy(rows.rgba.begin(), rows.rgba.end(),
              image_.rgba.begin() + std::ptrdiff_t(first_row) * view_.size.width * 4);
}

}  // namespace cairn::app
