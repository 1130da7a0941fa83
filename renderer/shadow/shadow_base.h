#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "optics/image.h"
#include "renderer/view/view.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

/// What all methods of shadows have in common, and the options of each (renderer/shadow_renderer.h makes
/// them).
namespace cairn::renderer {

/// What a shadow ray tests of a node of the xy-reduced pyramid. Both find the same voxels.
enum class ColumnMask : std::uint8_t {
    /// The ray tests the node's cube (Forest et al. 2009, Figure 10(a)): for comparison.
    mip_level,
    /// The ray tests the voxels of the column that it passes (Forest et al. 2009, Figure 10(b)).
    adaptive,
};

/// Options of ShadowMethod::pyramid (renderer/shadow/pyramid_shadows.h).
struct PyramidShadowOptions {
    int resolution = 512;  ///< voxels across the scene: a power of two, 8 to 2048
    ColumnMask mask = ColumnMask::adaptive;
};

/// Which faces of the occluders become micro-patches (Atty et al. 2005, section 3.5).
enum class ShadowPasses : std::uint8_t {
    /// The faces closest to the light.
    one,
    /// The faces furthest from the light as well, in a map of their own. Of both maps, the one that hides
    /// more light counts.
    two,
};

/// Number format of the sums of light that micro-patches hide (Atty et al. 2005, appendix A).
enum class ShadowFormat : std::uint8_t {
    /// 16-bit floats: a summand under 2^-11 of the sum is lost.
    fp16,
    /// 16-bit floats, in as many batches as the square root of the micro-patches. Each batch is summed alone.
    fp16_batches,
    fp32,
};

/// The most texels per side of a map of SoftShadowOptions.
constexpr int max_shadow_map_size = 2048;

/// Options of ShadowMethod::soft_shadow_map (renderer/shadow/soft_shadow_map.h).
struct SoftShadowOptions {
    /// Texels per side of the occluder map, [1, max_shadow_map_size]. 128 are mostly enough (Atty et
    /// al. 2005).
    int occluder_size = 128;
    /// Texels per side of the receiver map and of the soft shadow map, [1, max_shadow_map_size].
    int receiver_size = 256;
    ShadowPasses passes = ShadowPasses::two;
    ShadowFormat format = ShadowFormat::fp32;
    bool operator==(const SoftShadowOptions&) const = default;
};

/// An animation that a shadow renderer follows.
struct ShadowMotion {
    /// The animation, and the moment to begin with.
    scenes::When when;
    /// Bounds of the scene at all times that will be asked for (scenes::bounds_over_animation). Voxels
    /// outside them cast no shadow.
    scenes::Bounds bounds;
};

/// What casts shadows, and on what they fall. The scene and the snapshot must outlive the shadow renderer.
struct ShadowScene {
    const scenes::Scene& scene;
    /// Snapshot of the scene; with a motion, at its first moment.
    const scenes::Snapshot& snapshot;
    /// Nodes that cast shadows, one flag per node of the scene; none: all nodes of the snapshot.
    std::optional<scenes::NodeSelection> casters = std::nullopt;
    /// Nodes that shadows fall on, one flag per node of the scene; none: all nodes of the snapshot.
    std::optional<scenes::NodeSelection> receivers = std::nullopt;
    /// None: the shadow renderer is for one moment.
    std::optional<ShadowMotion> motion = std::nullopt;
};

/// Which results are wanted. A method computes no other result if it can save the work.
struct ShadowRequest {
    bool image = true;  ///< the shaded scene
    bool light = true;  ///< the share of the light that each pixel gets
    /// Called with the share of pixels that are done, in [0, 1], by methods that take several passes.
    std::function<void(double)> progress = {};
};

/// Times of one picture, by the wall clock from an idle driver to an idle driver. A time is 0 if the method
/// has no such part, or did not have to do it.
struct ShadowTimes {
    double milliseconds = 0.0;  ///< all results, with preparation and read-back
    double shadow_ms = 0.0;     ///< the shadow alone; ShadowMethod says what counts
    double move_ms = 0.0;       ///< moving the vertices since the picture before
    double voxelize_ms = 0.0;   ///< voxelizing the casters
    double pyramid_ms = 0.0;    ///< building the levels above the voxels
    double raster_ms = 0.0;     ///< rasterizing the receivers
    double trace_ms = 0.0;      ///< shadow rays and their shading
    int passes = 0;             ///< passes of shadow rays, in all bands of the picture
    std::size_t pyramid_bytes = 0;
    bool has_prepared = false;  ///< the next picture finds something ready that this one made
};

/// The results that were asked for are as large as the view; the others are empty.
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
    /// @throws Error  Fault::usage if the view is invalid, or if the method cannot show it; with a way out.
    [[nodiscard]] virtual ShadowPicture render(const View& view, const ShadowRequest& request = {}) = 0;

    /// Shows the scene at another moment of its ShadowMotion, as a shadow renderer made at that moment would,
    /// bit for bit.
    /// @throws Error  Fault::usage if the shadow renderer was made without a motion; as scenes::take_snapshot
    ///                does.
    virtual void move_to(double seconds);
};

}  // namespace cairn::renderer
