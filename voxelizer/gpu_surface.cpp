#include <fmt/format.h>

#include "base/error.h"
#include "gl/limits.h"
#include "shaders/interop/bindings.h"
#include "voxelizer/surface.h"

namespace cairn::voxelizer {
namespace {

template <typename T>
gl::Buffer upload_array(const std::vector<T>& values, const std::string& name, std::size_t limit_bytes) {
    const std::size_t bytes = values.size() * sizeof(T);
    if (bytes > limit_bytes) {
        throw Error(Fault::memory, name,
                    fmt::format("{:.1f} MiB are more than a shader of this driver can see ({:.1f} MiB)",
                                double(bytes) / 0x1p20, double(limit_bytes) / 0x1p20),
                    "use smaller images, or another driver");
    }
    return gl::Buffer::of(std::span<const T>(values), name);
}

}  // namespace

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
    out.far_triangles = surface.far_triangles;
    out.materials = upload_array(surface.materials, "surface materials", limit);
    out.texels = upload_array(surface.texels, "surface texels", limit);
    out.has_color = surface.has_color;
    out.has_mask = surface.has_mask;
    return out;
}

void GpuSurface::bind(const GpuSurfaceChunk& chunk) const {
    chunk.positions.bind_storage(SSBO_SURFACE_POSITIONS);
    chunk.triangles.bind_storage(SSBO_SURFACE_TRIANGLES);
    chunk.attributes.bind_storage(SSBO_SURFACE_ATTRIBUTES);
    materials.bind_storage(SSBO_SURFACE_MATERIALS);
    texels.bind_storage(SSBO_SURFACE_TEXELS);
}

std::size_t GpuSurface::size_bytes() const {
    std::size_t sum = materials.size_bytes() + texels.size_bytes();
    for (const GpuSurfaceChunk& chunk : chunks) {
        sum += chunk.positions.size_bytes() + chunk.triangles.size_bytes() + chunk.attributes.size_bytes();
    }
    return sum;
}

}  // namespace cairn::voxelizer
