#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "bench/trials/shadow_scene.h"
#include "gl/shader_source.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/shadow_renderer.h"

namespace cairn::bench {

/// One run of a contender.
struct ShadowRun {
    double milliseconds = 0.0;
    /// Share of the light per pixel, in [0, 1]; -1: unknown.
    std::vector<float> shares;
    bool fills_caches = false;  ///< did work that later runs do not repeat
    bool from_nothing = false;  ///< started with empty caches
};

/// Shadows of one scene by one method. Everything that can be kept is kept from one run to the next.
class ShadowFrames {
public:
    ShadowFrames(renderer::ShadowMethod method, const ShadowScene& scene,
                 const renderer::ShadowOptions& options, const gl::ShaderSource& shaders = {});

    /// Computes the shares of the light. The time is that of the whole frame; for soft shadow maps that of
    /// the map alone, because other views could use the same map.
    [[nodiscard]] ShadowRun run(const renderer::View& view);

private:
    renderer::ShadowMethod method_;
    std::unique_ptr<renderer::ShadowRenderer> renderer_;
    bool is_first_ = true;
};

/// A tree of exactly `resolution` voxels per side: a power of two, at least 8.
[[nodiscard]] renderer::TreeOptions tree_of(int resolution);
/// A pixel error at which rays take the finest voxels of their tree, whatever the size of pixels.
constexpr double always_finest = 1e-3;

/// Repeated runs of one contender.
///
/// Runs follow each other, after one that does not count: llvmpipe drops compiled programs when others come,
/// so contenders that took turns would compile theirs each time. Contenders are swept twice, with half of the
/// runs each, so that a drift of the machine's speed affects all of them.
class RepeatedRuns {
public:
    explicit RepeatedRuns(std::function<ShadowRun()> run) : run_(std::move(run)) {}

    /// @param runs       number of runs in all after this sweep
    /// @param budget_ms  no run begins once all have taken so long; at least one does
    void sweep(int runs, double budget_ms);

    /// Median time of the runs.
    [[nodiscard]] double ms() const;
    /// Time of the run with empty caches, if there was one.
    [[nodiscard]] const std::optional<double>& first_ms() const { return first_ms_; }
    /// Shares of the last run.
    [[nodiscard]] const std::vector<float>& shares() const { return shares_; }
    /// Time of all runs together.
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
