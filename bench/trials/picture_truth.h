#pragma once

#include "optics/image.h"
#include "reference/image.h"
#include "renderer/renderer.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::bench {

/// Embree's picture of a view with 64 samples per pixel, shaded by the renderer's formula.
/// @throws Error (Fault::memory) if Embree cannot hold the triangles.
[[nodiscard]] reference::ShadedImage true_picture(const scenes::Scene& scene,
                                                  const scenes::Snapshot& snapshot,
                                                  const renderer::View& view);

struct PictureErrors {
    double rmse = 0.0;  ///< root mean square error of sRGB values in [0, 1]
    /// Wrongly covered area, per area that the scene covers.
    double silhouette = 0.0;
};
/// Both pictures must have the same size.
[[nodiscard]] PictureErrors picture_errors(const optics::Image& ours, const reference::ShadedImage& truth);

}  // namespace cairn::bench
