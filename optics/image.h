#pragma once

#include <cstdint>
#include <vector>

/// Pictures: one type for the renderer, the reference and the command.
namespace cairn::optics {

/// A picture of sRGB-encoded RGBA, row 0 at the top. Alpha is the share of a pixel that the scene covers; the
/// background is already blended in.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;
};

/// The share of the light that arrives at each pixel of a picture.
struct LightShares {
    int width = 0;
    int height = 0;
    /// One share per pixel, in [0, 1], row 0 at the top: 0 if the surface turns its back to the light; -1 if
    /// the pixel shows no surface.
    std::vector<float> shares;
};

}  // namespace cairn::optics
