#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "renderer/pool/tree_shape.h"

namespace cairn::renderer {

class BrickPool;

/// A brick that a producer fills on the CPU, voxel by voxel, and sends to its slot: the way for a producer of
/// your own. For surfaces; mip levels stay empty.
class CpuBrick {
public:
    /// All voxels are empty.
    /// @param channels  must be those of the pool that the brick is sent to.
    CpuBrick(const TreeShape& shape, Channels channels);

    /// @param place     voxels from the brick's low corner, each in [-1, m]. -1 and m are the border, which
    ///                  holds what the neighbours hold there.
    /// @param coverage  share of the voxel that is opaque, in [0, 1]. Rounded to 8 bits; 0 is an empty voxel.
    /// @param normal    of length 1, or 0 if the voxel has no normal. Not read if the channels have no
    /// normal.
    /// @param color     linear, each in [0, 1]. Not read if the channels have no colour.
    void set(const glm::ivec3& place, double coverage, const glm::vec3& normal, const glm::vec3& color = {});

    /// Writes the whole slot: texels of all channels, border included, and masks. Needs the pool's context.
    void send_to(const BrickPool& pool, int slot) const;

    /// Is every voxel, border included, empty?
    [[nodiscard]] bool is_empty() const { return occupied_ == 0; }

private:
    TreeShape shape_;
    Channels channels_;
    /// Voxels of the brick and its border that are not empty.
    std::size_t occupied_ = 0;
    /// Colour texels as the pool holds them: 4 bytes each, or 1 without a colour; x runs fastest.
    std::vector<std::uint8_t> texels_;
    /// Normals as shaders/pool/brick_normals.glsl packs them.
    std::vector<std::uint32_t> normals_;
    std::vector<std::uint64_t> masks_;
};

}  // namespace cairn::renderer
