#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "gl/shader_source.h"
#include "renderer/shadow/shadow_base.h"
#include "renderer/shadow/shadow_frustum.h"
#include "renderer/shadow/shadow_options.h"
#include "renderer/shadow/soft_shadow_map.h"

namespace cairn::renderer {

/// Pictures of a rasterized scene with the soft shadow of some nodes on others. soft_shadow_map.h tells the
/// limits of the method.
///
/// Lights are rectangles. Of a view, its level of detail does not count, and of ShadowQuality::Kind::rays
/// neither do the samples: the shadow is that of the whole light. Pictures without a shadow, with a hard one
/// or with cones are refused. ShadowTimes::shadow_ms is that of the map on the driver's clock, without
/// drawing the picture.
class MapShadows final : public ShadowRenderer {
public:
    /// What is neither caster nor receiver is not drawn. The scene and the snapshot must outlive the
    /// renderer: windows are fitted to vertices for each light.
    /// @throws Error  Fault::usage when a node is both caster and receiver, for it would shadow itself, or a
    ///                size is out of range; Fault::memory when it does not fit.
    explicit MapShadows(const ShadowScene& scene, const SoftShadowOptions& options = {},
                        const gl::ShaderSource& shaders = {});
    ~MapShadows() override;

    /// @throws Error  as ShadowRenderer does; Fault::usage for a light that is no rectangle, for an anchor,
    /// or
    ///                for an invalid frustum.
    [[nodiscard]] ShadowPicture render(const View& view, const ShadowRequest& request = {}) override;
    void move_to(double seconds) override;

    /// What the map covers in the pictures from now on; none: fit_shadow_frustum().
    void set_frustum(const std::optional<ShadowFrustum>& frustum);

    // Of the last picture.
    [[nodiscard]] const SoftShadowMap& map() const;
    /// Of each pixel, from the eye; infinite: nothing there.
    [[nodiscard]] const std::vector<float>& distances() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cairn::renderer
