#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "gl/program.h"
#include "voxelizer/grid.h"
#include "voxelizer/methods/voxelizer.h"
#include "voxelizer/surface/surface.h"

namespace cairn::voxelizer {

/// A voxel of the root cube, and a triangle of a chunk whose mask decides about it.
struct MaskCandidate {
    glm::ivec3 voxel;
    std::int32_t triangle;
};

/// Marks the queued triangles that an alpha mask cuts: one pass lists the voxels that they meet, a second
/// looks at the texels, one thread per voxel, because the work for a voxel varies a thousandfold.
class MaskedMarker {
public:
    MaskedMarker(const gl::ShaderSource& shaders, const BatchLimits& limits);

    /// Marks the voxels of the queued triangles. Bits, queue and surface must be bound.
    /// @return the candidates that the shader left to the CPU.
    [[nodiscard]] std::vector<MaskCandidate> mark(const Region& region, unsigned queue, unsigned count);

private:
    /// Some triangles of a queue, and a range of rows of the bounding box of each.
    struct Work {
        unsigned first, count;
        unsigned first_row, last_row;
    };
    /// The first words of the buffer of candidates (shaders/voxelize/candidates.glsl).
    struct Header {
        std::uint32_t listed, undecided;
    };
    [[nodiscard]] Header header() const;
    /// Makes room for the candidates of a row of the region at least.
    void reserve(const Region& region);
    [[nodiscard]] unsigned list(const Region& region, unsigned queue, const Work& work);
    void decide(unsigned count, std::vector<MaskCandidate>& undecided);

    gl::Program list_;
    gl::Program decide_;
    BatchLimits limits_;
    std::size_t room_ = 0;  ///< candidates that have room
    gl::Buffer candidates_;
    std::vector<Work> waiting_;
};

/// The voxels of those candidates that are surface, decided on the CPU. Reads the triangles back from the
/// driver.
[[nodiscard]] std::vector<glm::ivec3> decide_on_cpu(const std::vector<MaskCandidate>& candidates,
                                                    const GpuSurface& surface, std::size_t chunk,
                                                    const Region& region);

/// Sets the region of a program that includes voxelize/bits.glsl.
void set_region(const gl::Program& program, const Region& region);

}  // namespace cairn::voxelizer
