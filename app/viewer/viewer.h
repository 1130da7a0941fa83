#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "app/viewer/fly_camera.h"
#include "app/viewer/orbit_camera.h"
#include "app/viewer/pace.h"
#include "app/viewer/refinement.h"
#include "renderer/renderer.h"

namespace cairn::app {

/// What a key asks for.
enum class Command : std::uint8_t {
    next_show,
    toggle_shadow,
    toggle_fly,
    reset_camera,
    finer,
    coarser,
    take_picture,
};

/// A converged picture that was asked for.
struct TakenPicture {
    renderer::View view;
    optics::Image image;
};

/// The viewer without its window: it takes input, does one piece of work at a time, and holds pictures.
///
/// While the view changes, whole frames are rendered with as few pixels as the time allows. When it stands
/// still, the picture grows to full resolution and is refined, in slices that end soon, so that input never
/// waits. Once it has converged, the bricks that a camera that moves closer will need are produced as far as
/// there is room; then the viewer rests.
class Viewer {
public:
    /// @param scene_size  diagonal of the scene in world units, > 0.
    Viewer(renderer::Renderer& renderer, const renderer::View& view, double scene_size);

    /// Renders a few pixels of every kind, so that no frame has to wait for a shader to be compiled.
    void warm_up();

    void command(Command command);
    /// Orbits, or looks around. @param moved  in units of the window's height: x to the right, y downwards.
    void drag_left(const glm::dvec2& moved);
    /// Pans. @param moved  as for drag_left().
    void drag_right(const glm::dvec2& moved);
    /// Zooms, or changes the speed of flying.
    void wheel(double steps);
    void fly(const glm::dvec3& ways) { ways_ = flying_ ? ways : glm::dvec3(0.0); }
    /// @param size  pixels; zero, the size of a minimized window, changes nothing.
    void resize(const glm::ivec2& size);

    /// Does one piece of work, if there is any. @param now  seconds since any moment.
    void step(double now);
    /// Seconds until there may be work if there is no input; 0 if there is work now.
    [[nodiscard]] double rest(double now) const;

    /// A finished picture that was asked for. Each is returned once.
    [[nodiscard]] std::optional<TakenPicture> take_picture();

    /// The last whole picture, of any size.
    [[nodiscard]] const optics::Image& base() const { return base_; }
    /// The picture that grows over base(), or an empty one.
    [[nodiscard]] const Refinement& growing() const { return growing_; }
    [[nodiscard]] std::uint64_t base_revision() const { return base_revision_; }
    [[nodiscard]] std::uint64_t growing_revision() const { return growing_revision_; }

    [[nodiscard]] const renderer::View& view() const { return view_; }
    [[nodiscard]] bool flying() const { return flying_; }
    [[nodiscard]] double fly_speed() const { return fly_.speed(); }
    /// Whether the view is rendered at full size, as well as the pools allow.
    [[nodiscard]] bool settled() const;
    /// Whether, besides, the picture is that of Renderer::render() without a budget.
    [[nodiscard]] bool converged() const;
    [[nodiscard]] std::string statistics_line() const;

    /// Milliseconds of each call of the renderer: of frames while the view changed, and of slices.
    [[nodiscard]] const std::vector<double>& frame_ms() const { return frame_ms_; }
    [[nodiscard]] const std::vector<double>& slice_ms() const { return slice_ms_; }
    [[nodiscard]] std::uint64_t bricks_produced() const { return bricks_produced_; }

private:
    [[nodiscard]] const optics::Camera& camera() const;
    void render_moving_frame();
    void prefetch_for(renderer::View next);
    void grow();
    void continue_picture();
    void prefetch_finer();
    void note(std::vector<double>& times, const renderer::FrameStatistics& statistics);

    renderer::Renderer& renderer_;
    renderer::View view_;  // the wanted view at full size
    optics::Camera first_camera_;
    renderer::ShadowQuality::Kind shadow_kind_;  // kind of shadows if they are on
    double scene_size_;
    OrbitCamera orbit_;
    FlyCamera fly_;
    bool flying_ = false;
    glm::dvec3 ways_{0.0};
    double last_step_ = 0.0;
    double changed_at_ = 0.0;
    bool changed_ = true;

    Pace frame_pace_;
    Pace slice_pace_;
    bool may_prefetch_ = false;                 // there may be more to prefetch at rest
    std::optional<optics::Camera> moved_from_;  // camera of the last moving frame
    optics::Image base_;
    Refinement growing_;
    std::optional<Refinement> picture_;
    std::optional<TakenPicture> taken_;
    std::uint64_t base_revision_ = 0;
    std::uint64_t growing_revision_ = 0;
    renderer::FrameStatistics last_;  // statistics of the last picture
    std::vector<double> frame_ms_;
    std::vector<double> slice_ms_;
    std::uint64_t bricks_produced_ = 0;
};

}  // namespace cairn::app
