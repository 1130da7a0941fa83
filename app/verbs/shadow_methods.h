#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "app/options/shadow_options.h"
#include "app/verbs/shadow_task.h"
#include "optics/image.h"
#include "renderer/shadow_renderer.h"

/// The ways of `cairn shadow` to a shadow, and how far one is from another.
namespace cairn::app {

/// A shadow, pixel by pixel, row 0 at the top.
struct ShadowResult {
    optics::Image image;
    std::vector<float> shares;    ///< of the light that arrives, [0, 1]; -1: nothing to receive it
    double milliseconds = 0.0;    ///< of the shadow, when all that can be kept is there
    double first_frame_ms = 0.0;  ///< of a picture and all that it needs
    double voxelize_ms = 0.0;     ///< of the pyramid, which is built for each moment
    double pyramid_ms = 0.0;
    double standard_error = 0.0;  ///< the greatest of any pixel, where light was sampled at random
    bool cached = false;          ///< taken from --truth-cache
};

/// Needs a context.
[[nodiscard]] ShadowResult shadow_on_gpu(renderer::ShadowMethod method, const ShadowTask& task,
                                         const ShadowOptions& options);

/// By Embree's rays: also tells which pixels can be shadowed at all, because they show a receiver whose
/// triangle faces the light's middle. The others hold -1.
/// @param cache  of reference::soft_shares().
[[nodiscard]] ShadowResult shadow_by_embree(const ShadowTask& task, const ShadowOptions& options,
                                            const std::optional<std::filesystem::path>& cache = std::nullopt);

/// White where they agree or nothing is compared, red where it is too dark, blue where it is too light.
[[nodiscard]] optics::Image difference_image(const ShadowResult& shadow, const std::vector<float>& truth);

}  // namespace cairn::app
