#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gl/handle.h"
#include "gl/program_family.h"
#include "shaders/interop/voxelize.h"
#include "voxelizer/methods/raster_tiles.h"
#include "voxelizer/methods/slice_targets.h"
#include "voxelizer/methods/voxelizer.h"

namespace cairn::voxelizer {

/// How a primitive is sent to its layer.
enum class LayerPath : std::uint8_t {
    /// By a geometry shader, with OpenGL 4.5 alone.
    geometry_shader,
    /// By the vertex shader, which needs ARB_shader_viewport_layer_array and storage buffers in vertex
    /// shaders.
    vertex_shader
};

/// The key of the programs that rasterize.
struct RasterVariant {
    int corners = 3;     ///< corners of a primitive: 3, 2 or 1
    bool cover = false;  ///< primitives are enlarged to all pixels that they touch
    /// Directions in which a primitive is drawn: 1 or 3; 0: the one that sees it most squarely.
    int axes = 1;
    bool masked = false;  ///< alpha masks cut triangles
    int targets = 1;      ///< render targets that hold the slices: 1, 2, 4 or 8
    [[nodiscard]] auto operator<=>(const RasterVariant&) const = default;
};
[[nodiscard]] gl::Defines defines(const RasterVariant& variant);
/// Every variant that a method of RasterVoxelizer may ask for.
[[nodiscard]] std::vector<RasterVariant> valid_raster_variants();

/// Voxelizes by rasterization into one bit per slice: the methods of Forest et al. 2009, section 2, to
/// compare with. None of them is exact (`cairn check` counts their errors).
///
/// `slice_map` looks along z alone, as Eisemann and Décoret 2006: a fragment marks the voxel at its pixel's
/// centre. Surfaces that are steep to z have holes, and surfaces parallel to z vanish.
///
/// `three_axis` looks along x, y and z and joins the three results. Surfaces have no gaps that a path through
/// voxel faces could pass, but are thin: a voxel that a triangle touches stays empty if the triangle covers
/// no pixel's centre there. Things smaller than a voxel may vanish.
///
/// `three_axis_conservative` draws each triangle in the direction that sees it most squarely, enlarged to all
/// pixels that it touches (Hasselgren et al. 2005), and marks all slices that its plane meets in the pixel.
/// It misses no voxel, but also marks voxels beside edges, which touch the triangle in this projection and
/// not in the others.
///
/// For all three methods: segments and points are GL's lines and points, which leave out the pixel that a
/// line ends in (enlarged like triangles in the conservative one). Alpha masks are decided at the pixel's
/// centre, or the triangle's nearest point, so that even the conservative method can miss a voxel whose only
/// visible texel lies elsewhere. A face in the region's far end belongs to the region's last voxel. Far
/// triangles (Surface::far_triangles) are cut to the lattice's range first, to the nearest lattice point.
/// Lines to points more than 2^16 voxels away are bent by the driver's rounding. A point within a float's
/// rounding of a boundary may fall to another side of it in another region.
///
/// Memory: targets of one bit per voxel and direction, at most BatchLimits::target_bytes at a time, and 16
/// MiB of lists.
class RasterVoxelizer final : public Voxelizer {
public:
    /// @param method  one of the three above
    /// @throws Error  Fault::context if the driver does not offer `path`.
    explicit RasterVoxelizer(Method method, const gl::ShaderSource& shaders = {},
                             LayerPath path = LayerPath::geometry_shader, const BatchLimits& limits = {});

    /// Whether the current driver offers LayerPath::vertex_shader.
    [[nodiscard]] static bool has_vertex_path();

private:
    using Counts = std::array<std::uint32_t, RASTER_KINDS>;

    void mark(const GpuSurface& surface, const Region& region, std::span<const ChunkPart> parts,
              gl::Buffer& bits) override;
    void draw_chunk(const gl::Buffer& positions, const RasterTile& tile, const ChunkPart& part, bool masked);
    /// Lists the primitives of a batch. @return number of primitives of each kind.
    [[nodiscard]] Counts list_batch(const RasterTile& tile, std::size_t first, std::size_t count,
                                    bool has_subset);
    void draw_list(unsigned kind, unsigned count, const RasterTile& tile, bool masked);
    void unite(const Region& region, const RasterTile& tile);
    [[nodiscard]] const gl::Program& program(unsigned kind, bool cover, bool masked);
    [[nodiscard]] bool is_conservative() const { return method_ == Method::three_axis_conservative; }
    [[nodiscard]] int directions() const { return method_ == Method::slice_map ? 1 : 3; }

    Method method_;
    BatchLimits limits_;
    bool vertex_path_;
    gl::Program list_;
    gl::Program unite_along_x_;
    gl::Program unite_;  ///< along y and z
    gl::ProgramFamily<RasterVariant> programs_;
    SliceTargets targets_;
    gl::Buffer lists_;
    gl::VertexArrayHandle vertex_array_;
};

}  // namespace cairn::voxelizer
