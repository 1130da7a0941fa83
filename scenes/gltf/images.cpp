#include "scenes/gltf/images.h"

#include <cstddef>
#include <cstdlib>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "scenes/gltf/failure.h"

namespace {

/// The largest single block that stb_image may allocate: a few kilobytes of zlib data can claim to be
/// gigabytes.
thread_local std::size_t largest_block = 0;

void* bounded_malloc(std::size_t bytes) {
    return bytes > largest_block ? nullptr : std::malloc(bytes);
}
void* bounded_realloc(void* block, std::size_t bytes) {
    return bytes > largest_block ? nullptr : std::realloc(block, bytes);
}

}  // namespace

#define STBI_MALLOC(bytes) bounded_malloc(bytes)
#define STBI_REALLOC(block, bytes) bounded_realloc(block, bytes)
#define STBI_FREE(block) std::free(block)
#define STBI_NO_STDIO
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_MAX_DIMENSIONS 16384
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>

namespace cairn::scenes::gltf {
namespace {

static_assert(widest_image == STBI_MAX_DIMENSIONS);

constexpr const char* way_out = "only PNG and JPEG are read; convert the image";

}  // namespace

Image decode_image(const std::string& where, std::span<const std::uint8_t> file, Budget& budget,
                   std::uint64_t most_bytes) {
    if (file.size() > std::numeric_limits<int>::max())
        fail(where, "the image file passes 2 GiB", "make it smaller");
    const auto file_bytes = static_cast<int>(file.size());
    largest_block = 1U << 20U;
    int width = 0;
    int height = 0;
    int channels = 0;
    if (stbi_info_from_memory(file.data(), file_bytes, &width, &height, &channels) == 0)
        fail(where, fmt::format("the image cannot be read ({})", stbi_failure_reason()), way_out);
    const std::uint64_t bytes = 4ULL * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    const std::string size = fmt::format("the image has {} x {} texels", width, height);
    if (width > widest_image || height > widest_image)
        fail(where, fmt::format("{}, and {} along a side are the limit", size, widest_image),
             "scale it down");
    if (bytes > most_bytes) fail_limit(where, size, &Limits::image_bytes, bytes);
    budget.grant(file.size());
    budget.charge(where, bytes, 1);

    // 16 bits per channel and one filter byte per row; zlib's buffer grows by doubling.
    largest_block = 2 * (2 * bytes + static_cast<std::size_t>(height)) + (1U << 20U);
    const std::unique_ptr<stbi_uc, decltype(&std::free)> texels(
        stbi_load_from_memory(file.data(), file_bytes, &width, &height, &channels, 4), &std::free);
    if (texels == nullptr)
        fail(where, fmt::format("the image cannot be read ({})", stbi_failure_reason()), way_out);
    Image image;
    image.width = width;
    image.height = height;
    image.rgba.assign(texels.get(), texels.get() + bytes);
    return image;
}

}  // namespace cairn::scenes::gltf
