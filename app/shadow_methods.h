#pragma once

#include <vector>

#include "app/shadow_options.h"
#include "renderer/renderer.h"

/// The three ways of `cairn shadow` to a shadow, and how far one is from another.
namespace cairn::app {

/// A shadow, pixel by pixel, row 0 at the top.
struct ShadowResult {
    renderer::Image image;
    std::vector<float> shares;    ///< of the light that arrives, [0, 1]; -1: nothing to receive it
    double milliseconds = 0.0;    ///< of the shadow, when all that can be kept is there
    double first_frame_ms = 0.0;  ///< of a picture and all that it needs
};

/// The two on the GPU need a context.
[[nodiscard]] ShadowResult shadow_by_voxels(const ShadowTask& task, const ShadowOptions& options);
[[nodiscard]] ShadowResult shadow_by_map(const ShadowTask& task, const ShadowOptions& options);

/// By Embree's rays: also tells which pixels can be shadowed at all, because they show a receiver whose
/// triangle faces the light's middle. The others hold -1.
[[nodiscard]] ShadowResult shadow_by_embree(const ShadowTask& task, const ShadowOptions& options);

/// Over the pixels that can be shadowed.
struct ShadowError {
    std::size_t pixels = 0;
    std::size_t shadowed = 0;   ///< of them, less than half of the light arrives in truth
    std::size_t too_light = 0;  ///< half of the light and more arrives, where in truth less does
    std::size_t too_dark = 0;   ///< the other way round
    double mean_absolute = 0.0;
    double rmse = 0.0;
    double greatest = 0.0;
    [[nodiscard]] double disagreement() const {
        return pixels == 0 ? 0.0 : double(too_light + too_dark) / double(pixels);
    }
};
[[nodiscard]] ShadowError error_of(const std::vector<float>& shares, const std::vector<float>& truth);

/// White where they agree or nothing is compared, red where it is too dark, blue where it is too light.
[[nodiscard]] renderer::Image difference_image(const ShadowResult& shadow, const std::vector<float>& truth);

}  // namespace cairn::app
