#include "renderer/frame/kept_picture.h"

#include <algorithm>

namespace cairn::renderer {

optics::Image KeptPicture::rows(const View& view, Rows rows) const {
    if (finished_.empty() || !(view == view_)) return {};
    const auto first = finished_.begin() + rows.first;
    if (!std::all_of(first, first + rows.count, [](bool finished) { return finished; })) return {};
    const auto row_bytes = std::ptrdiff_t(view.size.width) * 4;
    const auto from = image_.rgba.begin() + rows.first * row_bytes;
    return {view.size.width, rows.count, {from, from + rows.count * row_bytes}};
}

void KeptPicture::keep(const View& view, Rows rows, const optics::Image& image) {
    const std::size_t bytes = std::size_t(view.size.width) * std::size_t(view.size.height) * 4;
    if (bytes > limit_bytes) return forget();
    if (finished_.empty() || !(view == view_)) {
        view_ = view;
        image_ = {view.size.width, view.size.height, {}};
        image_.rgba.resize(bytes);
        finished_.assign(std::size_t(view.size.height), false);
    }
    std::copy(image.rgba.begin(), image.rgba.end(),
              image_.rgba.begin() + std::ptrdiff_t(rows.first) * view.size.width * 4);
    std::fill_n(finished_.begin() + rows.first, rows.count, true);
}

void KeptPicture::forget() {
    finished_.clear();
    image_ = {};
}

}  // namespace cairn::renderer
