#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "scenes/snapshot.h"

namespace cairn::scenes {

/// A box of densities, sampled at the centres of its cells along the world's axes.
///
/// Files of the body's kind (MetaImage, NIfTI) have z upwards; it becomes the world's y, as glTF has it, and
/// what the body faces becomes +z. Lengths are those of the file.
struct Volume {
    std::string name;
    glm::ivec3 size{0};                  ///< samples along the world's x, y and z, each at least 1
    glm::dvec3 spacing{1.0};             ///< world units between samples, above 0
    glm::dvec3 origin{0.0};              ///< world; where sample (0, 0, 0) lies
    double low = 0.0;                    ///< the file's value that sample 0 stands for
    double high = 1.0;                   ///< the file's value that sample 65535 stands for
    std::vector<std::uint16_t> samples;  ///< x fastest, then y; one for each cell
    std::vector<std::string> warnings;   ///< what of the file was not followed

    /// The cells' box: half a spacing around the outer samples.
    [[nodiscard]] Bounds bounds() const;
};

/// Does its name say that it is a volume: .mha, .mhd, .nii or .nii.gz?
[[nodiscard]] bool is_volume_file(const std::string& path);

/// Reads a volume: MetaImage (.mha; .mhd with its data in a file beside it; raw or zlib), or NIfTI-1 in one
/// file (.nii, .nii.gz). Scalars of any type, 3 dimensions; of a longer series, the first volume. 8-bit
/// values keep their range [0, 255]; others are spread over that of the data. Axes that are not along the
/// world's are turned to the nearest ones, with a warning.
///
/// Memory is taken as data is read, so a header alone cannot ask for more than the file can hold.
/// @throws Error  Fault::input, naming the file, what is wrong and a way out.
[[nodiscard]] Volume load_volume(const std::string& path);

}  // namespace cairn::scenes
