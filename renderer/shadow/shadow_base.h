#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "optics/image.h"
#include "renderer/view/view.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

/// What all methods of shadows have in common (renderer/shadow_renderer.h makes them).
namespace cairn::renderer {

/// An animation that a renderer of shadows follows.
struct ShadowMotion {
    scenes::When when;  ///< the animation, and the moment to begin with
    /// Hold the scene at all times that will be asked for (scenes::bounds_over_animation): voxels outside
    /// cast no shadow.
    scenes::Bounds bounds;
};

/// What throws shadows, and on what they fall. The scene and the snapshot must outlive the renderer.
struct ShadowScene {
    const scenes::Scene& scene;
    const scenes::Snapshot& snapshot;  ///< of the scene; with a motion, at its first moment
    /// Nodes that throw shadows, one flag per node of the scene; none: all of the snapshot's.
    std::optional<scenes::NodeSelection> casters = std::nullopt;
    /// Nodes that shadows fall on, likewise.
    std::optional<scenes::NodeSelection> receivers = std::nullopt;
    /// None: the renderer is for one moment.
    std::optional<ShadowMotion> motion = std::nullopt;
};

/// What of a shadow is wanted. What is not asked for is not computed, where a method can save it.
struct ShadowRequest {
    bool image = true;  ///< the shaded scene
    bool light = true;  ///< what each pixel gets of the light
    /// Called with the share of pixels that are done, in [0, 1], by methods that take several passes.
    std::function<void(double)> progress = {};
};

/// Of one picture, by the wall clock from an idle driver to an idle driver; 0 where a method has no such
/// part, or did not have to do it.
struct ShadowTimes {
    double milliseconds = 0.0;  ///< all that was asked for, with what had to be prepared, and reading it
    double shadow_ms = 0.0;     ///< the shadow alone, as the method's header tells it
    double move_ms = 0.0;       ///< moving the vertices since the picture before
    double voxelize_ms = 0.0;   ///< their voxels
    double pyramid_ms = 0.0;    ///< all levels above these voxels
    double raster_ms = 0.0;     ///< the receivers
    double trace_ms = 0.0;      ///< the shadow rays and their shading
    int passes = 0;             ///< of shadow rays, in all bands of the picture
    std::size_t pyramid_bytes = 0;
    bool has_prepared = false;  ///< something was made that the next picture finds ready
};

/// What was asked for is as large as the view; the rest is empty.
struct ShadowPicture {
    optics::Image image;
    optics::LightShares light;
    ShadowTimes times;
};

/// Pictures of a scene with the shadow of one light. Needs the context that was current at its construction.
class ShadowRenderer {
public:
    ShadowRenderer() = default;
    ShadowRenderer(const ShadowRenderer&) = delete;
    ShadowRenderer& operator=(const ShadowRenderer&) = delete;
    ShadowRenderer(ShadowRenderer&&) = delete;
    ShadowRenderer& operator=(ShadowRenderer&&) = delete;
    virtual ~ShadowRenderer() = default;

    /// The picture depends on the view and the moment alone.
    /// @throws Error  Fault::usage for an invalid view, and for one that the method cannot show, with a way
    ///                out.
    [[nodiscard]] virtual ShadowPicture render(const View& view, const ShadowRequest& request = {}) = 0;

    /// Shows the scene at another moment of its ShadowMotion, as a renderer made then would, bit for bit.
    /// @throws Error  Fault::usage when it was made for one moment; as scenes::take_snapshot does.
    virtual void move_to(double seconds);
};

/// Refuses what rays through voxels of the whole snapshot cannot tell apart.
/// @throws Error  Fault::usage when a node of the snapshot is no caster or no receiver.
void check_casts_and_receives_all(const ShadowScene& scene);
/// @throws Error  Fault::usage for selections that have not one flag per node.
void check_selections(const ShadowScene& scene);
/// @throws Error  Fault::usage when the view shows something else than the surface.
void check_shows_surface(const View& view);

}  // namespace cairn::renderer
