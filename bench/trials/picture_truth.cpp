#include "bench/trials/picture_truth.h"

#include <algorithm>
#include <cmath>

namespace cairn::bench {
namespace {

constexpr int samples_per_side = 8;  // samples per side of a pixel

}  // namespace

reference::ShadedImage true_picture(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                                    const renderer::View& view) {
    reference::Shading shading;
    shading.light_color = view.light.color;
    shading.ambient = view.light.ambient;
    shading.background = view.background;
    shading.shadows = view.shadow.kind != renderer::ShadowQuality::Kind::none;
    return reference::ImageTracer(scene, snapshot)
        .shade(view.camera, view.light, shading, view.size.width, view.size.height, samples_per_side);
}

PictureErrors picture_errors(const optics::Image& ours, const reference::ShadedImage& truth) {
    double squares = 0.0;
    double wrong = 0.0;
    double covered = 0.0;
    for (std::size_t p = 0; p < truth.srgb.size(); ++p) {
        for (int channel = 0; channel < 3; ++channel) {
            const double apart =
                ours.rgba[4 * p + std::size_t(channel)] / 255.0 - double(truth.srgb[p][channel]);
            squares += apart * apart;
        }
        wrong += std::abs(ours.rgba[4 * p + 3] / 255.0 - double(truth.coverage[p]));
        covered += double(truth.coverage[p]);
    }
    return {std::sqrt(squares / (3.0 * double(truth.srgb.size()))), wrong / std::max(covered, 1.0)};
}

}  // namespace cairn::bench
