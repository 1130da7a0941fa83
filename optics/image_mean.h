#pragma once

#include <cstdint>
#include <vector>

#include "optics/image.h"

namespace cairn::optics {

/// The mean of pictures of one size, in linear light.
class ImageMean {
public:
    /// @throws Error (Fault::internal) if the picture has another size than those before it.
    void add(const Image& image);
    [[nodiscard]] int count() const { return count_; }
    /// The mean so far; an empty picture before the first one.
    [[nodiscard]] Image mean() const;

private:
    Image last_;
    std::vector<float>
        sums_;  ///< linear colour and alpha, four per pixel; empty until there are two pictures
    int count_ = 0;
};

}  // namespace cairn::optics
