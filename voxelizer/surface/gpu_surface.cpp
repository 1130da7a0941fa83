#include <glad/gl.h>

#include "gl/buffer_texture.h"
#include "gl/limits.h"
#include "shaders/interop/surface.h"
#include "voxelizer/surface/surface.h"
#include "voxelizer/surface/upload_array.h"

namespace cairn::voxelizer {

GpuSurfaceChunk upload_chunk(const SurfaceChunk& chunk) {
    const std::size_t limit = gl::query_limits().shader_storage_bytes;
    return {upload_array(chunk.positions, "surface positions", limit),
            upload_array(chunk.triangles, "surface triangles", limit),
            upload_array(chunk.attributes, "surface attributes", limit),
            std::uint32_t(chunk.triangles.size())};
}

GpuSurface upload(const Surface& surface) {
    const std::size_t limit = gl::query_limits().shader_storage_bytes;
    GpuSurface out;
    for (const SurfaceChunk& chunk : surface.chunks)
        out.chunks.push_back(upload_chunk(chunk));
    out.chunk_triangles = surface.chunk_triangles;
    out.far_triangles = surface.far_triangles;
    out.materials = upload_array(surface.materials, "surface materials", limit);
    out.texels = upload_array(surface.texels, "surface texels",
                              gl::query_limits().texture_buffer_texels * sizeof(surface.texels[0]));
    out.texel_texture = gl::buffer_texture(GL_R32UI, out.texels);
    out.has_texture = !surface.texels.empty();
    out.has_color = surface.has_color;
    out.has_mask = surface.has_mask;
    return out;
}

void GpuSurface::bind(const GpuSurfaceChunk& chunk) const {
    chunk.positions.bind_storage(SSBO_SURFACE_POSITIONS);
    chunk.triangles.bind_storage(SSBO_SURFACE_TRIANGLES);
    chunk.attributes.bind_storage(SSBO_SURFACE_ATTRIBUTES);
    materials.bind_storage(SSBO_SURFACE_MATERIALS);
    bind_texels();
}

void GpuSurface::bind_texels() const {
    glBindTextureUnit(TEXTURE_SURFACE_TEXELS, texel_texture.id());
}

std::vector<std::uint32_t> GpuSurface::subset_in_chunk(std::span<const std::uint32_t> subset,
                                                       std::size_t chunk) const {
    std::vector<std::uint32_t> out;
    for (const std::uint32_t triangle : subset) {
        if (triangle / chunk_triangles == chunk) out.push_back(triangle % chunk_triangles);
    }
    return out;
}

std::size_t GpuSurface::size_bytes() const {
    std::size_t sum = materials.size_bytes() + texels.size_bytes();
    for (const GpuSurfaceChunk& chunk : chunks) {
        sum += chunk.positions.size_bytes() + chunk.triangles.size_bytes() + chunk.attributes.size_bytes();
    }
    return sum;
}

}  // namespace cairn::voxelizer
