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
struct ViewSpace {
    glm::dvec3 origin{0.0};
    double unit = 1.0;
    bool operator==(const ViewSpace&) const = default;
};

/// The nearest triangle at each pixel of some rows of a picture. Distances count along pixel_ray() of
/// shaders/march/pixel_ray.glsl, from its origin, in the units of the MarchView. Texel row 0 is `first_row`.
struct MeshSurface {
    int first_row = 0;
    int rows = 0;
    GLuint nearest = 0;  ///< R32F: distance of the triangle; MESH_MISS if there is none
    GLuint surface = 0;  ///< RGBA32UI, see shaders/mesh/mesh_surface.glsl
};

/// Where the ray of each pixel meets the first and the last face of a mesh. Distances count as in
/// MeshSurface.
struct MeshSpan {
    int first_row = 0;
    int rows = 0;
    /// RG32F: distance of the first face, and minus that of the last; MESH_MISS in both if there is no face.
    GLuint span = 0;
    /// R32F: front faces less back faces; below 0 if the ray starts inside a closed mesh.
    GLuint faces = 0;
};

/// How much a MeshRaster draws at a time. No pixel depends on it. A number under the least is taken for the
/// least.
struct MeshRasterLimits {
    std::uint32_t triangles = 1U << 18U;      ///< per draw call; at least 1
    std::int32_t strip_pixels = 4096 * 1024;  ///< of a picture that are drawn at once; at least one row's
};

/// A scene as triangles, rasterized through the pixels that the marcher sends its rays through. Triangles get
/// the base colours that voxels get (shaders/voxelize/surface_color.glsl): factor, vertex colour and the
/// nearest texel, with holes where an alpha mask cuts them. Like voxels, triangles are seen from both sides.
/// Lines and points, which have no area, are not drawn. Neither is anything nearer to the eye than
/// MESH_NEAREST_PART of the mesh's side.
///
/// Distances are computed in doubles from the ray and the triangle's plane, and not read from a depth buffer.
/// So neither the scale of the mesh nor its place in the world matters. Blending keeps the least distance, so
/// the order of triangles does not matter.
///
/// Needs the context that was current at its construction.
class MeshRaster {
public:
    /// The scene and the snapshot are not needed afterwards.
    /// @throws Error  Fault::memory if the surface does not fit.
    MeshRaster(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
               const gl::ShaderSource& shaders = {});
    /// For a surface of the caller's, with attributes. It must outlive the raster, or stay until show()
    /// replaces it.
    MeshRaster(const voxelizer::GpuSurface& surface, const voxelizer::Grid& lattice,
               const gl::ShaderSource& shaders = {}, const MeshRasterLimits& limits = {});
    MeshRaster(MeshRaster&&) noexcept;
    MeshRaster& operator=(MeshRaster&&) noexcept;
    MeshRaster(const MeshRaster&) = delete;
    MeshRaster& operator=(const MeshRaster&) = delete;
    ~MeshRaster();

    /// Draws the rows around one row of the picture. Which rows depends on the picture's size and the limits
    /// alone, so that a row always has the same pixels. Rows that are drawn already for this camera cost
    /// nothing. The textures are valid until the next call.
    /// @param view  only the camera and the picture's size are read.
    [[nodiscard]] MeshSurface draw_surface(const interop::MarchView& view, const ViewSpace& space, int row);
    /// Draws the first and the last faces in the rows around one row of the picture, like draw_surface().
    [[nodiscard]] MeshSpan draw_span(const interop::MarchView& view, const ViewSpace& space, int row);

    /// Call it after the vertices of the surface have moved in its lattice
    /// (voxelizer/surface/moving_surface.h).
    void surface_moved();
    /// Shows another surface in the same lattice, of the same materials, from now on.
    void show(const voxelizer::GpuSurface& surface);

    [[nodiscard]] std::uint64_t triangle_count() const;
    /// Bytes in the driver's memory, without render targets and without the caller's surface.
    [[nodiscard]] std::size_t size_bytes() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cairn::renderer
