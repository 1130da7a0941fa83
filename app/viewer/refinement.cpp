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

renderer::View Refinement::sample_view() const {
    if (view_.samples == 1) return view_;
    renderer::View view = view_;
    view.samples = 1;
    view.pixel_place = renderer::sample_place(sample_, view_.samples);
    return view;
}

bool Refinement::settled() const {
    const bool is_settled = swept() && std::all_of(work().begin(), work().end(), [](const Band& band) {
                                return band.converged || band.stuck;
                            });
    return is_settled && (converged() || !sample_converged());
}

bool Refinement::sample_converged() const {
    return swept() &&
           std::all_of(work().begin(), work().end(), [](const Band& band) { return band.converged; });
}

bool Refinement::converged() const {
    return has_all_samples_ || view_.size.height == 0;
}

/// If the sample has converged, adds it to the mean and begins the next one.
void Refinement::finish_sample() {
    if (has_all_samples_ || !sample_converged()) return;
    mean_.add(target());
    image_ = mean_.mean();
    if (sample_ + 1 == view_.samples) {
        has_all_samples_ = true;
        return;
    }
    sample_image_ = image_;
    ++sample_;
    sample_bands_.clear();
    next_row_ = 0;
}

double Refinement::share_done() const {
    if (converged()) return 1.0;
    int rows = 0;
    for (const Band& band : work())
        rows += band.converged || band.stuck ? band.rows.count : 0;
    return (sample_ + double(rows) / view_.size.height) / view_.samples;
}

/// Chooses the next rows of the first sweep; after it, the last band that lacks bricks, until nothing more
/// can be done for that band. If the pools held one band but not all, bands in turn would evict each other's
/// bricks. Bands go from the last to the first, because the pools hold the bricks that the sweep used last. A
/// band is cut if it would take too long.
Band& Refinement::choose(const Pace& pace) {
    const int rows = rows_at(pace, view_.size.width);
    std::vector<Band>& bands = work();
    if (!swept()) {
        const int count = std::min(rows, view_.size.height - next_row_);
        bands.push_back({{next_row_, count}});
        next_row_ += count;
        return bands.back();
    }
    const auto last = std::find_if(bands.rbegin(), bands.rend(),
                                   [](const Band& band) { return !band.converged && !band.stuck; });
    if (last->rows.count < 2 * rows) return *last;
    const int kept = last->rows.count - rows;
    const Band cut{{last->rows.first + kept, rows}};
    last->rows.count = kept;
    return *bands.insert(last.base(), cut);
}

renderer::FrameStatistics Refinement::step(renderer::Renderer& renderer, Pace& pace) {
    Band& band = choose(pace);
    const auto [rows, statistics] =
        renderer.render(sample_view(), {.rows = band.rows, .budget = Milliseconds(pace.aim_ms())});
    band.converged = statistics.converged;
    note_visit(band, rows, statistics);
    pace.learn(statistics.march_ms, double(view_.size.width) * band.rows.count);
    put(rows, band.rows.first);
    finish_sample();
    return statistics;
}

void Refinement::note_visit(Band& band, const optics::Image& rows,
                            const renderer::FrameStatistics& statistics) {
    const auto before = target().rgba.begin() + std::ptrdiff_t(band.rows.first) * view_.size.width * 4;
    const bool answered =
        statistics.bricks_produced > 0 || statistics.bricks_restored > 0 || statistics.nodes_subdivided > 0;
    const bool same = std::equal(rows.rgba.begin(), rows.rgba.end(), before);
    band.idle_visits = same && !answered ? band.idle_visits + 1 : 0;
    ++band.visits;
    band.stuck = !band.converged && (band.idle_visits >= most_idle_visits || band.visits >= most_visits);
}

std::optional<renderer::FrameStatistics> Refinement::finish_stuck(renderer::Renderer& renderer) {
    for (Band& band : work()) {
        if (band.converged) continue;
        const renderer::Frame frame = renderer.render(sample_view(), {.rows = band.rows});
        put(frame.image, band.rows.first);
        band.converged = true;
        band.stuck = false;
        finish_sample();
        return frame.statistics;
    }
    return std::nullopt;
}

void Refinement::put(const optics::Image& rows, int first_row) {
    std::copy(rows.rgba.begin(), rows.rgba.end(),
              target().rgba.begin() + std::ptrdiff_t(first_row) * view_.size.width * 4);
}

}  // namespace cairn::app
