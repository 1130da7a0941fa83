#pragma once

#include <cstddef>
#include <fstream>
#include <string>

#include <cairn/optics/image.h>

/// Writes a picture as a binary PPM, which needs no library: a header, then three bytes per pixel. Returns
/// whether that worked.
inline bool write_ppm(const std::string& path, const cairn::optics::Image& image) {
    std::ofstream file(path, std::ios::binary);
    file << "P6\n" << image.width << " " << image.height << "\n255\n";
    for (std::size_t i = 0; i < image.rgba.size(); i += 4)
        file.write(reinterpret_cast<const char*>(&image.rgba[i]), 3);
    file.close();
    return bool(file);
}
