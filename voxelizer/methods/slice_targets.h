#pragma once

#include <vector>

#include <glad/gl.h>
#include <glm/glm.hpp>

#include "gl/handle.h"

namespace cairn::voxelizer {

/// Render targets of one bit per voxel: RGBA32UI textures of 128 slices each, one layer per direction (Forest
/// et al. 2009, section 2.1).
class SliceTargets {
public:
    SliceTargets() = default;
    /// @param plane   width and height in texels, at most 1024, that suffice for every layer
    /// @param layers  1 or 3
    /// @param slices  at most 1024: eight targets
    /// @throws Error  Fault::memory if the driver refuses the textures.
    SliceTargets(const glm::ivec2& plane, int layers, int slices);

    [[nodiscard]] bool fits(const glm::ivec2& plane, int layers, int slices) const;
    [[nodiscard]] int target_count() const { return int(textures_.size()); }
    [[nodiscard]] GLuint texture(int target) const { return textures_[std::size_t(target)].id(); }

    /// Clears all bits and makes these textures the targets of drawing.
    void begin() const;

    /// Bytes of the textures.
    [[nodiscard]] static std::size_t bytes(const glm::ivec2& plane, int layers, int slices);

private:
    glm::ivec2 plane_{0};
    int layers_ = 0;
    std::vector<gl::TextureHandle> textures_;
    gl::FramebufferHandle framebuffer_;
};

}  // namespace cairn::voxelizer
