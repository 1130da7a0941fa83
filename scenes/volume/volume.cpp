#include "scenes/volume/volume.h"

#include <algorithm>
#include <cctype>

#include "scenes/volume/reader.h"

namespace cairn::scenes {
namespace {

bool ends_with(const std::string& path, std::string_view ending) {
    if (path.size() < ending.size()) return false;
    return std::equal(ending.begin(), ending.end(), path.end() - std::ptrdiff_t(ending.size()),
                      [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

bool is_metaimage(const std::string& path) {
    return ends_with(path, ".mha") || ends_with(path, ".mhd");
}

bool is_nifti(const std::string& path) {
    return ends_with(path, ".nii") || ends_with(path, ".nii.gz");
}

}  // namespace

Bounds Volume::bounds() const {
    const glm::dvec3 low_corner = origin - 0.5 * spacing;
    return {low_corner, low_corner + spacing * glm::dvec3(size)};
}

bool is_volume_file(const std::string& path) {
    return !path.starts_with("builtin:") && (is_metaimage(path) || is_nifti(path));
}

Volume load_volume(const std::string& path, const LoadOptions& options) {
    if (is_metaimage(path)) return volume::read_metaimage(path, options);
    if (is_nifti(path)) return volume::read_nifti(path, options);
    volume::fail(path, "its name is that of no volume format", "volumes end in .mha, .mhd, .nii or .nii.gz");
}

}  // namespace cairn::scenes
