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

/// The state of the explorer, without its window: input in, one piece of work at a time, pictures out.
///
/// While the view changes, whole frames are rendered with as few pixels as the time allows. When it stands
/// still the picture grows to full resolution and refines, in slices that end soon, so that input never
/// waits. When it has converged, what a camera that moves closer will need is produced as far as there is
/// room; then the viewer rests.
class Viewer {
public:
    /// @param scene_size  the diagonal of the scene, world units, > 0.
    Viewer(renderer::Renderer& renderer, const renderer::View& view, double scene_size);

    /// Renders a few pixels of every kind, so that no shader is compiled while somebody waits for a frame.
    void warm_up();

    void command(Command command);
    /// A mouse drag, in heights of the window: x to the right, y downwards.
    void drag_left(const glm::dvec2& moved);   ///< orbits, or looks around
    void drag_right(const glm::dvec2& moved);  ///< pans
    void wheel(double steps);                  ///< zooms, or changes the speed
    void fly(const glm::dvec3& ways) { ways_ = flying_ ? ways : glm::dvec3(0.0); }
    void resize(const glm::ivec2& size);  ///< pixels; zero, as of a window out of sight, changes nothing

    /// Does one piece of work, if there is any. @param now  seconds, from any start.
    void step(double now);
    /// Seconds until there may be work, if nothing is put in: 0 when there is some now.
    [[nodiscard]] double rest(double now) const;

    /// A finished picture that was asked for, once.
    [[nodiscard]] std::optional<TakenPicture> take_picture();

    /// The last whole picture, at any size, and the one that is growing over it (or empty).
    [[nodiscard]] const optics::Image& base() const { return base_; }
    [[nodiscard]] const Refinement& growing() const { return growing_; }
    [[nodiscard]] std::uint64_t base_revision() const { return base_revision_; }
    [[nodiscard]] std::uint64_t growing_revision() const { return growing_revision_; }

    [[nodiscard]] const renderer::View& view() const { return view_; }
    [[nodiscard]] bool flying() const { return flying_; }
    [[nodiscard]] double fly_speed() const { return fly_.speed(); }
    [[nodiscard]] bool settled() const;    ///< the view is rendered at full size, as well as the pools allow
    [[nodiscard]] bool converged() const;  ///< and is the picture of Renderer::render() without a budget
    [[nodiscard]] std::string statistics_line() const;

    /// How long each call of the renderer took, for a report.
    [[nodiscard]] const std::vector<double>& frame_ms() const { return frame_ms_; }
    [[nodiscard]] const std::vector<double>& slice_ms() const { return slice_ms_; }
    [[nodiscard]] std::uint64_t bricks_produced() const { return bricks_produced_; }

private:
    [[nodiscard]] const optics::Camera& camera() const;
    void render_moving_frame();
    void prefetch_for(renderer::View next);
    void grow();
    void continue_picture();
    void look_ahead();
    void note(std::vector<double>& times, const renderer::FrameStatistics& statistics);

    renderer::Renderer& renderer_;
    renderer::View view_;  // wanted, at full size
    optics::Camera first_camera_;
    renderer::ShadowQuality::Kind shadow_kind_;  // where there are shadows
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
    bool looks_ahead_ = false;                  // at rest, there may be more to prefetch
    std::optional<optics::Camera> moved_from_;  // the camera of the moving frame before
    optics::Image base_;
    Refinement growing_;
    std::optional<Refinement> picture_;
    std::optional<TakenPicture> taken_;
    std::uint64_t base_revision_ = 0;
    std::uint64_t growing_revision_ = 0;
    renderer::FrameStatistics last_;  // of the last call of the renderer that gave a picture
    std::vector<double> frame_ms_;
    std::vector<double> slice_ms_;
    std::uint64_t bricks_produced_ = 0;
};

}  // namespace cairn::app
