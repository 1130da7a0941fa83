#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "renderer/produce/volume.h"
#include "scenes/volume/volume.h"

namespace cairn::renderer {

/// A volume that is held whole: its samples, their means at every coarser level, and bounds of the densities
/// in boxes.
///
/// The finest voxels are cubes as wide as the least of the volume's spacings. Along an axis of that spacing
/// they are centred on samples; along a wider one they are interpolated linearly. There is no finer level:
/// rays interpolate between voxels, which is the trilinear interpolation of the samples.
class DenseField final : public Field {
public:
    /// The volume is not needed afterwards.
    /// @param n  n of the tree.
    /// @param memory_bytes  bytes that it may take; none: scenes::usual_memory_bytes, and less for a volume
    /// of
    ///                      few samples.
    /// @throws Error  Fault::input if there are many times as many voxels as samples, as of no scan, and
    ///                nobody allowed it; Fault::memory if the voxels would take more than may be taken.
    DenseField(const scenes::Volume& volume, int n, std::optional<std::uint64_t> memory_bytes = std::nullopt);

    [[nodiscard]] const FieldFrame& frame() const override { return frame_; }
    void fill(int coarseness, const glm::i64vec3& low, const glm::ivec3& count, float* values) const override;
    [[nodiscard]] FieldRange range(const glm::i64vec3& low, const glm::i64vec3& high) const override;

private:
    struct Level {
        glm::i64vec3 size{0};
        std::vector<std::uint16_t> means;  ///< x fastest; 65535 is density 1
    };
    /// Bounds of the densities in cells of 2^shift finest voxels per side.
    struct Bounds {
        int shift = 0;
        glm::i64vec3 size{0};
        std::vector<std::array<std::uint16_t, 2>> low_high;
    };
    void build_bounds();

    FieldFrame frame_;
    std::vector<Level> levels_;
    std::vector<Bounds> bounds_;
};

}  // namespace cairn::renderer
