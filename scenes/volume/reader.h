#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenes/volume/volume.h"

/// Functions that the readers of volume files share; not for use outside scenes/.
namespace cairn::scenes::volume {

enum class SampleType : std::uint8_t { u8, i8, u16, i16, u32, i32, u64, i64, f32, f64 };
[[nodiscard]] std::size_t bytes_of(SampleType type);

/// The layout of a file's samples: i runs fastest, then j, then k.
struct Layout {
    glm::i64vec3 size{0};
    SampleType type = SampleType::u8;
    bool big_endian = false;
    double slope = 1.0;  ///< value = sample * slope + intercept
    double intercept = 0.0;
    /// Steps from one sample to the next along i, j and k, in the world.
    std::array<glm::dvec3, 3> axes{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)};
    /// Place of the first sample, in the world.
    glm::dvec3 origin{0.0};
};

[[noreturn]] void fail(const std::string& name, const std::string& what,
                       const std::string& way_out = "the file is damaged; export it again");

/// Bytes of all samples. @throws Error if a size is not positive, or there are more than 2^33 samples.
[[nodiscard]] std::size_t checked_bytes(const std::string& name, const Layout& layout);

/// The samples, turned to the world's axes. `bytes` holds all samples.
[[nodiscard]] Volume decode(const std::string& name, const Layout& layout, std::span<const std::byte> bytes);

[[nodiscard]] std::vector<std::byte> read_file(const std::string& name, const std::string& path);

/// Unpacks at most `most` bytes of a zlib or gzip stream. @return fewer bytes if the stream ends before.
[[nodiscard]] std::vector<std::byte> inflate(const std::string& name, std::span<const std::byte> packed,
                                             std::size_t most);

[[nodiscard]] Volume read_metaimage(const std::string& path);
[[nodiscard]] Volume read_nifti(const std::string& path);

}  // namespace cairn::scenes::volume
