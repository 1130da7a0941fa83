#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "app/options/shadow_options.h"
#include "app/verbs/shadow_task.h"
#include "optics/image.h"
#include "renderer/shadow_renderer.h"

/// The methods of `cairn shadow`, and the difference between their shadows.
namespace cairn::app {

/// A shadow, pixel by pixel, row 0 at the top.
struct ShadowResult {
    optics::Image image;
    /// Share of the light that arrives, per pixel, in [0, 1]; -1 if the pixel shows no receiver.
    std::vector<float> shares;
    /// Time of the shadow if all that can be kept is kept.
    double milliseconds = 0.0;
    /// Time of a picture and of all that it needs.
    double first_frame_ms = 0.0;
    /// Times of voxelizing and of building the pyramid, which is built for each moment.
    double voxelize_ms = 0.0;
    double pyramid_ms = 0.0;
    /// The greatest standard error of any pixel, if the light was sampled at random.
    double standard_error = 0.0;
    bool cached = false;  ///< shares were taken from --truth-cache
};

/// A shadow by one of the renderer's methods. Needs a current context.
[[nodiscard]] ShadowResult shadow_on_gpu(renderer::ShadowMethod method, const ShadowTask& task,
                                         const ShadowOptions& options);

/// A shadow by Embree's rays. Only pixels that show a receiver whose triangle faces the light's middle have a
/// share; the others hold -1.
/// @param cache  folder for reference::soft_shares().
[[nodiscard]] ShadowResult shadow_by_embree(const ShadowTask& task, const ShadowOptions& options,
                                            const std::optional<std::filesystem::path>& cache = std::nullopt);

/// A picture of the difference: white where both agree or nothing is compared, red where the shadow is too
/// dark, blue where it is too light.
[[nodiscard]] optics::Image difference_image(const ShadowResult& shadow, const std::vector<float>& truth);

}  // namespace cairn::app
