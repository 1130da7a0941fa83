#include "renderer/shadow/column_shadows.h"

#include <chrono>
#include <string>

#include "base/clock.h"
#include "base/error.h"
#include "shaders/interop/columns.h"
#include "shaders/interop/mesh.h"
#include "shaders/interop/shadow_rays.h"
#include "shaders/interop/threads.h"

namespace cairn::renderer {
namespace {

static_assert(int(ColumnMask::mip_level) == COLUMN_MASK_MIP_LEVEL &&
              int(ColumnMask::adaptive) == COLUMN_MASK_ADAPTIVE);

}  // namespace

gl::Defines defines(const ColumnVariant& variant) {
    return {{"COLUMN_MASK", std::to_string(int(variant.mask))},
            {"SOFT_SHADOWS", variant.is_soft ? "1" : "0"}};
}

ColumnShadows::ColumnShadows(const ColumnPyramid& pyramid, ColumnMask mask, const gl::ShaderSource& shaders)
    : mask_(mask),
      programs_([common = pyramid.defines(), shaders](const ColumnVariant& variant) {
          gl::Defines all = common;
          for (const auto& define : defines(variant))
              all.push_back(define);
          return gl::build_compute(shaders, "shadow/light_columns.comp.glsl", all);
      }),
      view_(sizeof(interop::MarchView), "view of shadow rays"),
      counts_(sizeof(glm::uvec4), "counts of shadow rays") {}

std::vector<std::uint32_t> ColumnShadows::light(const interop::MarchView& view, const ColumnPyramid& pyramid,
                                                const ColumnReceivers& receivers) {
    const std::size_t pixels = std::size_t(view.width) * std::size_t(view.row_count);
    if (image_.size_bytes() < pixels * sizeof(std::uint32_t)) {
        image_ = gl::Buffer(pixels * sizeof(std::uint32_t), "picture");
        sums_ = gl::Buffer(pixels * sizeof(interop::ShadowSum), "sums of shadow rays");
    }
    view_.write(0, &view, sizeof(view));
    const gl::Program& lighting = programs_.get({mask_, view.is_soft != 0});
    lighting.set("mesh_first_row", receivers.first_row);
    lighting.set("mesh_shadows", 1);
    lighting.set("mesh_self_shadow_height", receivers.self_shadow_height);
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    view_.bind_uniform(UBO_VIEW);
    image_.bind_storage(SSBO_PICTURE);
    sums_.bind_storage(SSBO_SHADOW_SUMS);
    counts_.bind_storage(SSBO_COLUMN_COUNTS);
    pyramid.bind_for_reading();
    glBindTextureUnit(TEXTURE_MESH_NEAREST, receivers.nearest);
    glBindTextureUnit(TEXTURE_MESH_SURFACE, receivers.surface);
    glm::uvec4 counts(1);
    for (last_passes_ = 0; counts.x != 0; ++last_passes_) {
        // Each pass ends at least one ray of every pixel.
        if (last_passes_ > MAX_SHADOW_RAYS)
            throw Error(Fault::internal, "shadow rays", "a ray did not come to an end");
        counts_.fill(0);
        lighting.set("first_pass", int(last_passes_ == 0));
        lighting.use();
        gl::dispatch_threads(pixels, THREADS_PER_GROUP);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
        counts_.read(0, &counts, sizeof(counts));
    }
    last_milliseconds_ = milliseconds_since(start);
    return image_.read_all<std::uint32_t>(pixels);
}

}  // namespace cairn::renderer
