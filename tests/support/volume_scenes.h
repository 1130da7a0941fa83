#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/produce/volume.h"
#include "renderer/view/view.h"
#include "scenes/volume/volume.h"

/// Volumes for tests, and the comparison of their pictures.
namespace cairn::test {

/// Soft blobs in empty space, with values on all sides of the box.
inline scenes::Volume blobs(const glm::ivec3& size, unsigned seed, int count = 12) {
    std::mt19937 rng(seed);
    const auto unit = [&] { return double(rng() >> 8U) * 0x1p-24; };
    struct Blob {
        glm::dvec3 place;
        double radius, height;
    };
    std::vector<Blob> all;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 place(unit(), unit(), unit());
        const double radius = 0.05 + 0.15 * unit();
        all.push_back({place, radius, 0.3 + 0.7 * unit()});
    }
    scenes::Volume volume;
    volume.name = fmt::format("blobs, seed {}", seed);
    volume.size = size;
    volume.spacing = glm::dvec3(2.0 / std::max({size.x, size.y, size.z}));
    volume.origin = glm::dvec3(-1.0) + 0.5 * volume.spacing;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                double value = 0.0;
                for (const Blob& blob : all) {
                    const double d =
                        glm::distance((glm::dvec3(x, y, z) + 0.5) / double(size.x), blob.place) / blob.radius;
                    if (d < 1.0) value = std::max(value, blob.height * (1.0 - d * d));
                }
                volume.samples.push_back(std::uint16_t(std::lround(std::min(value, 1.0) * 65535.0)));
            }
    return volume;
}

/// A transfer function: nothing below a threshold, then a coloured ramp.
inline renderer::TransferFunction ramp(double extinction, double threshold = 0.1) {
    return renderer::TransferFunction({{0.0, {0.9, 0.2, 0.1}, 0.0},
                                       {threshold, {0.9, 0.2, 0.1}, 0.0},
                                       {0.5, {0.9, 0.8, 0.3}, 0.3 * extinction},
                                       {1.0, {0.2, 0.4, 1.0}, extinction}});
}

/// A view lit alike from everywhere and without shadows: a pixel shows what the volume emits and lets
/// through.
inline renderer::View glowing_view(const scenes::Bounds& bounds, int width = 64, int height = 48) {
    renderer::View view;
    view.size.width = width;
    view.size.height = height;
    view.camera = optics::framing_camera(bounds, double(width) / height);
    view.light.ambient = 1.0F;
    view.shadow.kind = renderer::ShadowQuality::Kind::none;
    view.detail.pixel_error = 1e-6;
    return view;
}

struct PictureDifference {
    int largest = 0;
    std::size_t over = 0;  ///< pixels that differ by more than the threshold
    std::string worst;
};
inline PictureDifference difference_of(const optics::Image& a, const optics::Image& b, int threshold = 0) {
    PictureDifference difference;
    EXPECT_EQ(a.rgba.size(), b.rgba.size());
    for (std::size_t pixel = 0; 4 * pixel < std::min(a.rgba.size(), b.rgba.size()); ++pixel) {
        int most = 0;
        for (std::size_t k = 0; k < 4; ++k)
            most = std::max(most, std::abs(int(a.rgba[4 * pixel + k]) - int(b.rgba[4 * pixel + k])));
        if (most > threshold) ++difference.over;
        if (most <= difference.largest) continue;
        difference.largest = most;
        const auto text = [pixel](const optics::Image& image) {
            const std::uint8_t* p = &image.rgba[4 * pixel];
            return fmt::format("{} {} {} {}", p[0], p[1], p[2], p[3]);
        };
        difference.worst = fmt::format("pixel ({}, {}): {} against {}", pixel % std::size_t(a.width),
                                       pixel / std::size_t(a.width), text(a), text(b));
    }
    return difference;
}

}  // namespace cairn::test
