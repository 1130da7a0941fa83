#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "bench/trials/shadow_scene.h"
#include "gl/shader_source.h"
#include "renderer/pool/tree_options.h"
#include "renderer/shadow_renderer.h"

namespace cairn::bench {

struct ShadowRun {
    double milliseconds = 0.0;
    std::vector<float> shares;  ///< one a pixel of the picture, in [0, 1]; -1: not known
    bool fills_caches = false;  ///< it did work that is not done again
    bool from_nothing = false;  ///< nothing was kept before it
};

/// Shadows of one scene by one method, of which all that can be kept is kept from one to the next.
class ShadowFrames {
public:
    ShadowFrames(renderer::ShadowMethod method, const ShadowScene& scene,
                 const renderer::ShadowOptions& options, const gl::ShaderSource& shaders = {});

    /// The shares of the light, and the time of the whole frame; of a soft shadow map, which other pictures
    /// could be drawn with, that of the map alone.
    [[nodiscard]] ShadowRun run(const renderer::View& view);

private:
    renderer::ShadowMethod method_;
    std::unique_ptr<renderer::ShadowRenderer> renderer_;
    bool is_first_ = true;
};

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
