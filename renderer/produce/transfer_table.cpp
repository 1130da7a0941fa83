#include "renderer/produce/transfer_table.h"

#include <vector>

#include <fmt/format.h>
#include <glad/gl.h>

#include "base/error.h"
#include "shaders/interop/volume.h"

namespace cairn::renderer {

TransferTable::TransferTable(const TransferFunction& function, const VolumeOptions& options,
                             double voxel_size)
    : view_(sizeof(interop::VolumeView), "volume view") {
    if (options.steps_per_voxel < 1 || options.steps_per_voxel > VOLUME_MOST_STEPS) {
        throw Error(Fault::usage, "volume", fmt::format("{} steps per voxel", options.steps_per_voxel),
                    fmt::format("1 to {} are possible", VOLUME_MOST_STEPS));
    }
    if (!(options.full_gradient >= 0.0 && options.shadow_start >= 0.0))
        throw Error(Fault::usage, "volume", "a gradient or a distance is negative", "0 is the least");
    std::vector<glm::vec4> texels;
    texels.reserve(std::size_t(DENSITY_STEPS) * DENSITY_STEPS);
    for (int to = 0; to < DENSITY_STEPS; ++to)
        for (int from = 0; from < DENSITY_STEPS; ++from)
            texels.emplace_back(function.mean_optics(from, to));
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &id);
    table_ = gl::TextureHandle(id);
    glTextureStorage2D(id, 1, GL_RGBA32F, DENSITY_STEPS, DENSITY_STEPS);
    glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTextureSubImage2D(id, 0, 0, 0, DENSITY_STEPS, DENSITY_STEPS, GL_RGBA, GL_FLOAT, texels.data());
    const interop::VolumeView view{float(voxel_size), float(options.full_gradient),
                                   float(options.shadow_start), 0.0F};
    view_.write(0, &view, sizeof(view));
}

void TransferTable::bind() const {
    view_.bind_uniform(UBO_VOLUME);
    glBindTextureUnit(TEXTURE_TRANSFER, table_.id());
}

}  // namespace cairn::renderer
