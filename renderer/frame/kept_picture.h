#pragma once

#include <cstddef>
#include <vector>

#include "optics/image.h"
#include "renderer/view/view.h"

namespace cairn::renderer {

/// The last view's picture, as far as its rows are finished: a view that does not change is marched once.
class KeptPicture {
public:
    /// Those rows, when all of them were kept for just this view; else an empty image.
    [[nodiscard]] optics::Image rows(const View& view, Rows rows) const;

    /// Keeps finished rows; those of another view are forgotten. Pictures past the limit are not kept.
    void keep(const View& view, Rows rows, const optics::Image& image);

    void forget();

    static constexpr std::size_t limit_bytes = std::size_t(64) << 20U;

private:
    View view_;
    optics::Image image_;
    std::vector<bool> finished_;  // a row each
};

}  // namespace cairn::renderer
