#include "app/viewer/viewer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include "app/options/view_options.h"

namespace cairn::app {
namespace {

/// Milliseconds of a frame while the view changes, and of a slice while it stands still. Each may take about
/// as long again if bricks are produced.
constexpr double frame_aim_ms = 50.0;
constexpr double slice_aim_ms = 30.0;
constexpr double least_prefetch_ms = 5.0;
// Milliseconds of prefetching at a time while nothing moves.
constexpr double ahead_ms = 8.0;
constexpr double first_pixels = 60000.0;
/// The view stands still once it has not changed for this long, which is more than the time between two
/// events of a slow drag.
constexpr double settle_seconds = 0.15;
/// From this scale on, the next stage is the full resolution.
constexpr double nearly_full = 0.6;
constexpr double pixel_error_a_step = 1.4142135623730951;
constexpr double least_pixel_error = 0.0625;
constexpr double largest_pixel_error = 64.0;
constexpr double longest_fly_step = 0.2;  // seconds; after a pause the camera must not leap
constexpr int least_side = 16;
constexpr double forever = 1e9;

/// The view with its width and height scaled, and one ray per pixel.
renderer::View scaled(renderer::View view, double scale) {
    view.samples = 1;
    view.size.width = std::clamp(int(std::lround(view.size.width * scale)),
                                 std::min(least_side, view.size.width), view.size.width);
    view.size.height = std::clamp(int(std::lround(view.size.height * scale)),
                                  std::min(least_side, view.size.height), view.size.height);
    return view;
}

}  // namespace

Viewer::Viewer(renderer::Renderer& renderer, const renderer::View& view, double scene_size)
    : renderer_(renderer),
      view_(view),
      first_camera_(snapped(view.camera)),
      shadow_kind_(view.shadow.kind == renderer::ShadowQuality::Kind::none
                       ? renderer::ShadowQuality::Kind::hard
                       : view.shadow.kind),
      scene_size_(scene_size),
      orbit_(first_camera_, scene_size),
      fly_(first_camera_, scene_size),
      frame_pace_(frame_aim_ms, first_pixels),
      slice_pace_(slice_aim_ms, first_pixels) {
    view_.camera = first_camera_;
}

const optics::Camera& Viewer::camera() const {
    return flying_ ? fly_.camera() : orbit_.camera();
}

void Viewer::warm_up() {
    renderer::View small = scaled(view_, 0.0);
    for (const renderer::Show show : {renderer::Show::levels, renderer::Show::surface}) {
        small.show = show;
        (void)renderer_.render(small, {.budget = Milliseconds(0.0)});
    }
}

void Viewer::command(Command command) {
    const renderer::View before = view_;
    switch (command) {
        case Command::next_show:
            view_.show = renderer::Show((int(view_.show) + 1) % 3);
            break;
        case Command::toggle_shadow:
            view_.shadow.kind = view_.shadow.kind == renderer::ShadowQuality::Kind::none
                                    ? shadow_kind_
                                    : renderer::ShadowQuality::Kind::none;
            break;
        case Command::toggle_fly:
            if (flying_) {
                orbit_ = OrbitCamera(fly_.camera(), scene_size_);
            } else {
                fly_ = FlyCamera(orbit_.camera(), scene_size_);
            }
            flying_ = !flying_;
            ways_ = glm::dvec3(0.0);
            break;
        case Command::reset_camera:
            orbit_ = OrbitCamera(first_camera_, scene_size_);
            fly_ = FlyCamera(first_camera_, scene_size_);
            break;
        case Command::finer:
            view_.detail.pixel_error =
                std::max(view_.detail.pixel_error / pixel_error_a_step, least_pixel_error);
            break;
        case Command::coarser:
            view_.detail.pixel_error =
                std::min(view_.detail.pixel_error * pixel_error_a_step, largest_pixel_error);
            break;
        case Command::take_picture:
            picture_ = growing_.view() == view_ && !changed_ ? growing_ : Refinement(view_);
            break;
    }
    changed_ = changed_ || !(view_ == before);
}

void Viewer::drag_left(const glm::dvec2& moved) {
    if (flying_) {
        fly_.look(1.5 * view_.camera.yfov * moved);
    } else {
        orbit_.orbit(glm::pi<double>() * moved);
    }
}

void Viewer::drag_right(const glm::dvec2& moved) {
    if (flying_) {
        OrbitCamera panned(fly_.camera(), scene_size_);
        panned.pan(moved);
        fly_.place(panned.camera());
    } else {
        orbit_.pan(moved);
    }
}

void Viewer::wheel(double steps) {
    if (flying_) {
        fly_.change_speed(steps);
    } else {
        orbit_.zoom(steps);
    }
}

void Viewer::resize(const glm::ivec2& size) {
    if (size.x < 1 || size.y < 1 || size == glm::ivec2(view_.size.width, view_.size.height)) return;
    view_.size.width = size.x;
    view_.size.height = size.y;
    changed_ = true;
}

void Viewer::step(double now) {
    if (flying_) fly_.move(ways_, std::clamp(now - last_step_, 0.0, longest_fly_step));
    last_step_ = now;
    const optics::Camera wanted = snapped(camera());
    changed_ = changed_ || !(wanted == view_.camera);
    if (changed_) {
        view_.camera = wanted;
        changed_ = false;
        changed_at_ = now;
        render_moving_frame();
    } else if (rest(now) <= 0.0) {
        moved_from_.reset();
        if (picture_) {
            continue_picture();
        } else if (!settled()) {
            grow();
        } else {
            prefetch_finer();
        }
    }
}

double Viewer::rest(double now) const {
    if (changed_ || ways_ != glm::dvec3(0.0) || !(snapped(camera()) == view_.camera)) return 0.0;
    if (settled() && !picture_ && !may_prefetch_) return forever;
    return std::max(changed_at_ + settle_seconds - now, 0.0);
}

void Viewer::render_moving_frame() {
    const double pixels = double(view_.size.width) * view_.size.height;
    const renderer::View small = scaled(view_, std::min(std::sqrt(frame_pace_.pixels() / pixels), 1.0));
    auto [image, statistics] = renderer_.render(small, {.budget = Milliseconds(frame_aim_ms)});
    base_ = std::move(image);
    note(frame_ms_, statistics);
    // Time of marching and of production: until the picture is there.
    frame_pace_.learn(statistics.milliseconds, double(small.size.width) * small.size.height);
    ++base_revision_;
    growing_ = Refinement();
    ++growing_revision_;
    prefetch_for(small);
}

/// Produces bricks of the next moving frame in the time that the last one has left.
void Viewer::prefetch_for(renderer::View next) {
    const double left_ms = frame_aim_ms - last_.milliseconds;
    const optics::Camera from = moved_from_.value_or(next.camera);
    moved_from_ = next.camera;
    if (!last_.converged || left_ms < least_prefetch_ms || from == next.camera) return;
    next.camera = optics::extrapolated(from, next.camera);
    bricks_produced_ += renderer_.prefetch(next, Milliseconds(left_ms));
}

/// Renders the next slice of the growing picture. A complete coarse picture is followed by a finer one.
void Viewer::grow() {
    if (growing_.empty() || (growing_.complete() && !(growing_.view() == view_))) {
        if (!growing_.empty()) {
            base_ = growing_.image();
            ++base_revision_;
        }
        const double scale = 2.0 * base_.width / view_.size.width;
        growing_ = Refinement(scale < nearly_full ? scaled(view_, scale) : view_);
    }
    note(slice_ms_, growing_.step(renderer_, slice_pace_));
    ++growing_revision_;
    may_prefetch_ = converged();
}

/// Produces bricks for a camera that moves closer.
void Viewer::prefetch_finer() {
    const renderer::PrefetchResult ahead = renderer_.prefetch_finer(Milliseconds(ahead_ms));
    may_prefetch_ = ahead.more;
    bricks_produced_ += ahead.bricks;
}

void Viewer::continue_picture() {
    if (!picture_->settled()) {
        note(slice_ms_, picture_->step(renderer_, slice_pace_));
    } else if (const auto finished = picture_->finish_stuck(renderer_)) {
        note(slice_ms_, *finished);
    }
    if (picture_->converged()) {
        taken_ = TakenPicture{picture_->view(), picture_->image()};
        if (picture_->view() == view_) growing_ = *picture_;
        picture_.reset();
        ++growing_revision_;
    }
}

void Viewer::note(std::vector<double>& times, const renderer::FrameStatistics& statistics) {
    last_ = statistics;
    times.push_back(statistics.milliseconds);
    bricks_produced_ += statistics.bricks_produced;
}

std::optional<TakenPicture> Viewer::take_picture() {
    return std::exchange(taken_, std::nullopt);
}

bool Viewer::settled() const {
    return !changed_ && growing_.view() == view_ && growing_.settled();
}

bool Viewer::converged() const {
    return settled() && growing_.converged();
}

std::string Viewer::statistics_line() const {
    const bool is_growing = !growing_.empty();
    const int width = is_growing ? growing_.view().size.width : base_.width;
    std::string state = "moving";
    if (picture_) {
        state = fmt::format("taking a picture {:.0f}%", 100.0 * picture_->share_done());
    } else if (converged()) {
        state = "converged";
    } else if (settled()) {
        state = "pools full: as fine as they allow";
    } else if (is_growing) {
        state = fmt::format("refining {:.0f}%", 100.0 * growing_.share_done());
    }
    return fmt::format("{:.0f} ms   {}x{} at {:.0f}%   {} bricks in {:.0f} of {:.0f} MiB, {} produced   {}",
                       last_.milliseconds, view_.size.width, view_.size.height,
                       100.0 * width / view_.size.width, last_.bricks_resident,
                       double(last_.brick_bytes_resident) / 0x1p20, double(last_.brick_pool_bytes) / 0x1p20,
                       bricks_produced_, state);
}

}  // namespace cairn::app
