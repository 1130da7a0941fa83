#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <glad/gl.h>
#include <glm/glm.hpp>

#include "gl/shader_source.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"
#include "shaders/interop/march.h"
#include "voxelizer/grid.h"
#include "voxelizer/surface/surface.h"

namespace cairn::renderer {

/// Where the coordinates of a MarchView lie in the world: world = origin + unit * coordinates.
struct MarchSpace {
    glm::dvec3 origin{0.0};
    double unit = 1.0;
    bool operator==(const MarchSpace&) const = default;
};

/// The nearest triangle at each pixel of some rows of a picture. Distances are those along pixel_ray() of
/// shaders/march/pixel_ray.glsl, from its origin, in the units of the MarchView; texel row 0 is `first_row`.
struct MeshSurface {
    int first_row = 0;
    int rows = 0;
    GLuint nearest = 0;  ///< R32F; MESH_MISS where there is none
    GLuint surface = 0;  ///< RGBA32UI, see shaders/mesh/mesh_surface.glsl
};

/// Where the ray of each pixel meets the first and the last face of a mesh.
struct MeshSpan {
    int first_row = 0;
    int rows = 0;
    GLuint span =
        0;  ///< RG32F: the first distance, and minus the last; MESH_MISS in both where there is none
    GLuint faces = 0;  ///< R32F: fronts less backs; under 0 where the ray starts inside a closed mesh
};

/// A scene as triangles, rasterized through the pixels that the marcher sends its rays through. Base colours
/// are those that voxels get (shaders/voxelize/surface_color.glsl): factor, vertex colour and the nearest
/// texel, with holes where an alpha mask cuts them. Like voxels, triangles are seen from both sides; lines
/// and points, which have no area, are not drawn, nor is what is nearer to the eye than MESH_NEAREST_PART of
/// the mesh's side.
///
/// Distances come from the ray and the triangle's plane, computed from doubles: not from a depth buffer, so
/// neither the scale nor the place in the world matters. Blending keeps the least, so neither does the order.
///
/// Needs the context that was current at its construction.
class MeshRaster {
public:
    /// The scene and the snapshot are not needed afterwards.
    /// @throws Error  Fault::memory when it does not fit.
    MeshRaster(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
               const gl::ShaderSource& shaders = {});
    /// A surface of the caller's, with attributes, which must outlive the raster or what it shows instead.
    MeshRaster(const voxelizer::GpuSurface& surface, const voxelizer::Grid& lattice,
               const gl::ShaderSource& shaders = {});
    MeshRaster(MeshRaster&&) noexcept;
    MeshRaster& operator=(MeshRaster&&) noexcept;
    MeshRaster(const MeshRaster&) = delete;
    MeshRaster& operator=(const MeshRaster&) = delete;
    ~MeshRaster();

    /// Draws the rows around one row of the picture; which rows those are depends on the picture's size
    /// alone, so that a row has the same pixels whoever asks for it. Done already for this camera, it costs
    /// nothing. What it returns is valid until the next call.
    /// @param view  the camera and the picture's size count.
    [[nodiscard]] MeshSurface draw_surface(const interop::MarchView& view, const MarchSpace& space, int row);
    [[nodiscard]] MeshSpan draw_span(const interop::MarchView& view, const MarchSpace& space, int row);

    /// The vertices of the surface have moved in its lattice (voxelizer/surface/moving_surface.h).
    void surface_moved();
    /// Shows another surface in the same lattice, of the same materials, from now on.
    void show(const voxelizer::GpuSurface& surface);

    [[nodiscard]] std::uint64_t triangle_count() const;
    /// In the driver's memory, without what is drawn to and what is the caller's.
    [[nodiscard]] std::size_t size_bytes() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cairn::renderer
