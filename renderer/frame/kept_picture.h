#pragma once

#include <cstddef>
#include <vector>

#include "optics/image.h"
#include "renderer/view/view.h"

namespace cairn::renderer {

/// The finished rows of the last view's picture, so that a view that does not change is marched once.
class KeptPicture {
public:
    /// The rows, if all of them were kept for this view; else an empty image.
    [[nodiscard]] optics::Image rows(const View& view, Rows rows) const;

    /// Keeps finished rows, and forgets those of another view. A picture larger than the limit is not kept.
    void keep(const View& view, Rows rows, const optics::Image& image);

    void forget();

    static constexpr std::size_t limit_bytes = std::size_t(64) << 20U;

private:
    View view_;
    optics::Image image_;
    std::vector<bool> finished_;  // one flag per row
};

}  // namespace cairn::renderer
