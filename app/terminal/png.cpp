#include "app/terminal/png.h"

#include <cstdint>
#include <new>
#include <vector>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

#include "base/output_file.h"

namespace cairn::app {

void write_png(const optics::Image& image, const std::filesystem::path& path) {
    constexpr int channels = 3;
    const std::size_t pixel_count = std::size_t(image.width) * std::size_t(image.height);
    std::vector<std::uint8_t> rgb(pixel_count * channels);
    for (std::size_t i = 0; i < pixel_count; ++i) {
        for (std::size_t c = 0; c < channels; ++c)
            rgb[i * channels + c] = image.rgba[i * 4 + c];
    }
    OutputFile file(path);
    const auto append = [](void* out, void* data, int size_bytes) {
        static_cast<OutputFile*>(out)->write(data, std::size_t(size_bytes));
    };
    if (stbi_write_png_to_func(append, &file, image.width, image.height, channels, rgb.data(),
                               image.width * channels) == 0) {
        throw std::bad_alloc();  // stb_image_write has no other failure
    }
    file.commit();
}

}  // namespace cairn::app
