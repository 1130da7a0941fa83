#pragma once

#include <cstdint>
#include <vector>

/// Pictures, as the renderer, the reference and the command mean them alike.
namespace cairn::optics {

/// sRGB-encoded RGBA, row 0 at the top; alpha is the coverage by the scene (the background is already blended
/// in).
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;
};

/// What of the light each pixel of a picture gets.
struct LightShares {
    int width = 0;
    int height = 0;
    /// In [0, 1], row 0 at the top; 0 where the surface turns its back to the light; -1: nothing is there.
    std::vector<float> shares;
};

}  // namespace cairn::optics
