#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>

#include <glm/glm.hpp>

/// The curve of sRGB (IEC 61966-2-1), with which pictures are encoded. Its twins in the shaders are
/// srgb_from_linear() of march/picture.glsl and linear_from_srgb() of voxelize/surface_color.glsl.
namespace cairn::optics {

/// @param linear  clamped to [0, 1].
/// @return        in [0, 1].
template <std::floating_point Real>
[[nodiscard]] Real srgb_from_linear(Real linear) {
    const Real c = std::clamp(linear, Real(0.0), Real(1.0));
    return c <= Real(0.0031308) ? Real(12.92) * c
                                : Real(1.055) * std::pow(c, Real(1.0) / Real(2.4)) - Real(0.055);
}

/// @param encoded  in [0, 1].
/// @return         in [0, 1].
template <std::floating_point Real>
[[nodiscard]] Real linear_from_srgb(Real encoded) {
    return encoded <= Real(0.04045) ? encoded / Real(12.92)
                                    : std::pow((encoded + Real(0.055)) / Real(1.055), Real(2.4));
}

/// Encodes to the nearest of 256 steps.
/// @param linear  clamped to [0, 1].
template <std::floating_point Real>
[[nodiscard]] std::uint8_t srgb8_from_linear(Real linear) {
    return std::uint8_t(std::lround(Real(255.0) * srgb_from_linear(linear)));
}

/// Encodes each channel, in double.
[[nodiscard]] inline glm::u8vec3 srgb8_from_linear(const glm::vec3& linear) {
    return {srgb8_from_linear(double(linear.r)), srgb8_from_linear(double(linear.g)),
            srgb8_from_linear(double(linear.b))};
}

}  // namespace cairn::optics
