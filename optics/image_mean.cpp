#include "optics/image_mean.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/error.h"
#include "optics/srgb.h"

namespace cairn::optics {
namespace {

constexpr std::size_t channels = 4;

float linear_of(std::size_t channel, std::uint8_t byte) {
    static const std::array<float, 256> linear = [] {
        std::array<float, 256> table{};
        for (std::size_t i = 0; i < table.size(); ++i)
            table[i] = linear_from_srgb(float(i) / 255.0F);
        return table;
    }();
    return channel == channels - 1 ? float(byte) / 255.0F : linear[byte];
}

/// srgb8_from_linear() by a table: a picture has a million values, and an exponential takes long.
class Encoder {
public:
    Encoder() {
        // The least float that is encoded as each byte, by halving.
        for (std::size_t byte = 1; byte < 256; ++byte) {
            float low = 0.0F;
            float high = 1.0F;
            while (std::nextafter(low, 1.0F) < high) {
                const float middle = 0.5F * (low + high);
                (srgb8_from_linear(middle) < byte ? low : high) = middle;
            }
            least_[byte] = high;
        }
        least_[256] = std::numeric_limits<float>::infinity();
        std::size_t byte = 0;
        for (std::size_t i = 0; i < first_.size(); ++i) {
            while (least_[byte + 1] <= float(i) / float(first_.size()))
                ++byte;
            first_[i] = std::uint8_t(byte);
        }
    }
    [[nodiscard]] std::uint8_t operator()(float linear) const {
        const auto place = std::min(std::size_t(linear * float(first_.size())), first_.size() - 1);
        std::size_t byte = first_[place];
        while (least_[byte + 1] <= linear)
            ++byte;
        return std::uint8_t(byte);
    }

private:
    std::array<float, 257> least_{};
    std::array<std::uint8_t, 4096> first_{};
};

std::uint8_t encoded(float linear) {
    static const Encoder encoder;
    return encoder(linear);
}

}  // namespace

void ImageMean::add(const Image& image) {
    if (count_ != 0 && (image.width != last_.width || image.height != last_.height))
        throw Error(Fault::internal, "mean of pictures", "pictures of different sizes");
    // A single picture stays as it is.
    if (count_ == 1) {
        sums_.resize(last_.rgba.size());
        for (std::size_t i = 0; i < sums_.size(); ++i)
            sums_[i] = linear_of(i % channels, last_.rgba[i]);
    }
    if (count_ != 0) {
        for (std::size_t i = 0; i < sums_.size(); ++i)
            sums_[i] += linear_of(i % channels, image.rgba[i]);
    }
    last_ = image;
    ++count_;
}

Image ImageMean::mean() const {
    Image mean = last_;
    for (std::size_t i = 0; i < sums_.size(); ++i) {
        const float value = sums_[i] / float(count_);
        mean.rgba[i] =
            i % channels == channels - 1 ? std::uint8_t(std::lround(255.0F * value)) : encoded(value);
    }
    return mean;
}

}  // namespace cairn::optics
