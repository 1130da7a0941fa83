#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "bench/trials/shadow_scene.h"
#include "gl/shader_source.h"
#include "renderer/pyramid_shadow.h"
#include "renderer/renderer.h"

namespace cairn::bench {

struct ShadowRun {
    double milliseconds = 0.0;
    std::vector<float> shares;  ///< one a pixel of the picture, in [0, 1]; -1: not known
    bool fills_caches = false;  ///< it did work that is not done again
    bool from_nothing = false;  ///< nothing was kept before it
};

/// Frames of which only the shadow comes from voxels: the scene is rasterized, and rays go from its pixels to
/// the light (Forest et al. 2009, section 3.1), as `cairn shadow` has it.
[[nodiscard]] std::shared_ptr<renderer::Renderer> shadowing_renderer(const ShadowScene& scene,
                                                                     const renderer::TreeOptions& tree,
                                                                     const renderer::RendererOptions& options,
                                                                     const gl::ShaderSource& shaders);
/// Marches a frame, whatever was shown before.
[[nodiscard]] ShadowRun shadow_frame(renderer::Renderer& renderer, const renderer::View& view);

/// Frames of one scene, of which all but the rays is kept from one to the next.
using ShadowFrames = std::function<ShadowRun(const renderer::View& view)>;

/// Such frames with the rays of Forest et al. 2009 (renderer/pyramid_shadow.h).
[[nodiscard]] ShadowFrames pyramid_frames(const ShadowScene& scene,
                                          const renderer::PyramidShadowOptions& options,
                                          const gl::ShaderSource& shaders);

/// A tree of exactly so many voxels a side: 8, or 16 and more, a power of two.
[[nodiscard]] renderer::TreeOptions tree_of(int resolution);
/// Rays go by the finest voxels of their tree, whatever a pixel shows.
constexpr double always_finest = 1e-3;  // pixel error

/// Repeated runs of one contender.
///
/// They follow each other, and one that does not count goes before them: llvmpipe drops compiled programs
/// when others come, and contenders that took turns would compile theirs each time. So that a drift of the
/// machine's speed shows in all, contenders are swept twice, with half of the runs each.
class RepeatedRuns {
public:
    explicit RepeatedRuns(std::function<ShadowRun()> run) : run_(std::move(run)) {}

    /// @param runs       that shall be there after it
    /// @param budget_ms  no run begins once all have taken so long; there is one at least
    void sweep(int runs, double budget_ms);

    [[nodiscard]] double ms() const;                                                   ///< median
    [[nodiscard]] const std::optional<double>& first_ms() const { return first_ms_; }  ///< from nothing
    [[nodiscard]] const std::vector<float>& shares() const { return shares_; }         ///< of the last
    [[nodiscard]] double spent_ms() const { return spent_ms_; }

private:
    ShadowRun once();

    std::function<ShadowRun()> run_;
    std::optional<double> first_ms_;
    std::vector<double> samples_ms_;
    std::vector<float> shares_;
    double spent_ms_ = 0.0;
};

}  // namespace cairn::bench
