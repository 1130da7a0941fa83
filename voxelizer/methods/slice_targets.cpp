#include "voxelizer/methods/slice_targets.h"

#include <array>

#include <fmt/format.h>

#include "base/error.h"
#include "shaders/interop/voxelize.h"

namespace cairn::voxelizer {
namespace {

int targets_for(int slices) {
    return (slices + RASTER_TARGET_SLICES - 1) / RASTER_TARGET_SLICES;
}

}  // namespace

std::size_t SliceTargets::bytes(const glm::ivec2& plane, int layers, int slices) {
    constexpr std::size_t texel_bytes = RASTER_TARGET_SLICES / 8;
    return texel_bytes * std::size_t(plane.x) * std::size_t(plane.y) * std::size_t(layers) *
           std::size_t(targets_for(slices));
}

SliceTargets::SliceTargets(const glm::ivec2& plane, int layers, int slices) : plane_(plane), layers_(layers) {
    GLuint framebuffer = 0;
    glCreateFramebuffers(1, &framebuffer);
    framebuffer_ = gl::FramebufferHandle(framebuffer);
    std::array<GLenum, RASTER_TARGETS> draw_buffers{};
    const int count = targets_for(slices);
    for (int target = 0; target < count; ++target) {
        GLuint texture = 0;
        glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &texture);
        textures_.emplace_back(texture);
        glTextureStorage3D(texture, 1, GL_RGBA32UI, plane.x, plane.y, layers);
        glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glNamedFramebufferTexture(framebuffer, GLenum(GL_COLOR_ATTACHMENT0 + target), texture, 0);
        draw_buffers[std::size_t(target)] = GLenum(GL_COLOR_ATTACHMENT0 + target);
    }
    glNamedFramebufferDrawBuffers(framebuffer, count, draw_buffers.data());
    if (glGetError() == GL_OUT_OF_MEMORY ||
        glCheckNamedFramebufferStatus(framebuffer, GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        throw Error(Fault::memory, "render targets of the voxelizer",
                    fmt::format("the driver refuses {} of {} x {} x {} texels, {:.1f} MiB", count, plane.x,
                                plane.y, layers, double(bytes(plane, layers, slices)) / 0x1p20),
                    "choose a lower resolution, or Method::conservative");
    }
}

bool SliceTargets::fits(const glm::ivec2& plane, int layers, int slices) const {
    return plane_ == plane && layers_ == layers && target_count() == targets_for(slices);
}

void SliceTargets::begin() const {
    constexpr std::array<GLuint, 4> none{};
    for (int target = 0; target < target_count(); ++target)
        glClearNamedFramebufferuiv(framebuffer_.id(), GL_COLOR, target, none.data());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.id());
}

}  // namespace cairn::voxelizer
