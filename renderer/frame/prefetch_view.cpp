#include "renderer/frame/prefetch_view.h"

#include <algorithm>

#include "renderer/march/marcher.h"
#include "shaders/interop/march.h"

namespace cairn::renderer {
namespace {

/// Pixels of a band: a pass through it takes some milliseconds.
constexpr int prefetch_pixels = 4096;
/// The most pixels per ray, along each axis.
constexpr int prefetch_stride = 2;

/// The view with one ray per stride^2 pixels. Each ray sees the levels that it would see in the whole
/// picture.
View thinned_by(const View& view, int stride) {
    View thin = view;
    thin.size.width = (view.size.width + stride - 1) / stride;
    thin.size.height = (view.size.height + stride - 1) / stride;
    thin.detail.pixel_error = view.detail.pixel_error * thin.size.height / view.size.height;
    return thin;
}

}  // namespace

View thinned(const View& view) {
    int stride = 4;
    View thin = thinned_by(view, stride);
    while (view.size.width > 1 && Marcher::band_rows(thin.size.width, thin.size.height) < thin.size.height)
        thin = thinned_by(view, stride *= 2);
    return thin;
}

View finer(const View& view, const TreeShape& shape) {
    View fine = view;
    fine.detail.pixel_error = view.detail.pixel_error / shape.n;
    return thinned_by(fine, std::clamp(int(shape.m * fine.detail.pixel_error), 1, prefetch_stride));
}

bool band_from_middle(const View& view, int number, Rows& rows) {
    const int count = std::max(prefetch_pixels / view.size.width / PIXEL_BLOCK_SIDE, 1) * PIXEL_BLOCK_SIDE;
    const int bands = (view.size.height + count - 1) / count;
    if (number >= bands) return false;
    const int middle = bands / 2;
    const int band = number % 2 == 0 ? middle + number / 2 : middle - (number + 1) / 2;
    rows = {band * count, std::min(count, view.size.height - band * count)};
    return true;
}

}  // namespace cairn::renderer
