#include "app/terminal/png.h"

#include <cstdint>
#include <exception>
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
    // An exception must not leave through stb_image_write, which would not free what it holds.
    struct Target {
        OutputFile& file;
        std::exception_ptr failure;
    } target{file, nullptr};
    const auto append = [](void* out, void* data, int size_bytes) {
        auto& to = *static_cast<Target*>(out);
        try {
            if (!to.failure) to.file.write(data, std::size_t(size_bytes));
        } catch (...) {
            to.failure = std::current_exception();
        }
    };
    const int written = stbi_write_png_to_func(append, &target, image.width, image.height, channels,
                                               rgb.data(), image.width * channels);
    if (target.failure) std::rethrow_exception(target.failure);
    if (written == 0) throw std::bad_alloc();  // stb_image_write has no other failure
    file.commit();
}

}  // namespace cairn::app
