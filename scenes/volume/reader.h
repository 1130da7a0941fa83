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

/// Bytes of all samples in the file.
/// @throws Error  Fault::input if a size is not positive; Fault::memory if the samples, as they are in the
/// file
///                and as Volume::samples, would take more than so many bytes.
[[nodiscard]] std::size_t checked_bytes(const std::string& name, const Layout& layout,
                                        std::uint64_t memory_bytes);

/// The samples, turned to the world's axes. `bytes` holds all samples, whose layout checked_bytes() has
/// passed.
[[nodiscard]] Volume decode(const std::string& name, const Layout& layout, std::span<const std::byte> bytes);

/// @param folder  the folder that the file must lie in, once links are followed; empty: any.
/// @throws Error  Fault::memory if the file is larger than `most_bytes`.
[[nodiscard]] std::vector<std::byte> read_file(const std::string& name, const std::string& path,
                                               std::uint64_t most_bytes, const std::string& folder = {});

/// @throws Error  if no zlib stream of `packed` bytes can hold so many.
void check_ratio(const std::string& name, std::size_t packed, std::size_t needed);

/// Unpacks at most `most` bytes of a zlib stream, or of a gzip stream, which may have several members one
/// after the other (RFC 1952, 2.2). @return fewer bytes if the stream ends before.
[[nodiscard]] std::vector<std::byte> inflate(const std::string& name, std::span<const std::byte> packed,
                                             std::size_t most);

[[nodiscard]] Volume read_metaimage(const std::string& path, const LoadOptions& options);
[[nodiscard]] Volume read_nifti(const std::string& path, const LoadOptions& options);

}  // namespace cairn::scenes::volume
