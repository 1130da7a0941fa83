#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "scenes/load.h"
#include "scenes/snapshot.h"

namespace cairn::scenes {

/// A box of densities, sampled at the centres of its cells along the world's axes.
///
/// MetaImage and NIfTI files have z upwards. It becomes the world's y, as in glTF, and the direction that a
/// patient faces becomes +z. Lengths are the file's.
struct Volume {
    std::string name;
    glm::ivec3 size{0};                  ///< samples along the world's x, y and z, each at least 1
    glm::dvec3 spacing{1.0};             ///< world units between samples, above 0
    glm::dvec3 origin{0.0};              ///< place of sample (0, 0, 0), world
    double low = 0.0;                    ///< the file's value that sample 0 stands for
    double high = 1.0;                   ///< the file's value that sample 65535 stands for
    std::vector<std::uint16_t> samples;  ///< one per cell; x runs fastest, then y
    std::vector<Warning> warnings;       ///< statements of the file that were not followed

    /// Bounds of the cells, which reach half a spacing past the outer samples.
    [[nodiscard]] Bounds bounds() const;
};

/// Whether the path ends like a volume's: .mha, .mhd, .nii or .nii.gz.
[[nodiscard]] bool is_volume_file(const std::string& path);

/// Reads a volume: MetaImage (.mha; .mhd with its data in a file beside it; raw or zlib), or NIfTI-1 in one
/// file (.nii, .nii.gz). Values are scalars of any type in 3 dimensions; of a series, the first volume is
/// read. 8-bit values keep their range [0, 255]; other values are scaled by the range of the data. Axes that
/// are not along the world's are turned to the nearest ones, with a warning.
///
/// Nothing is allocated that the file's own bytes cannot mean, nor more than LoadOptions::memory_bytes.
/// @throws Error  Fault::input, naming the file, what is wrong and a way out; Fault::memory if the samples
///                would take more than LoadOptions::memory_bytes.
[[nodiscard]] Volume load_volume(const std::string& path, const LoadOptions& options = {});

}  // namespace cairn::scenes
