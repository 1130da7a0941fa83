#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "gl/handle.h"
#include "scenes/snapshot.h"
#include "voxelizer/grid.h"

namespace cairn::interop {
// The structures that shaders read, laid out in shaders/interop/. Code that only passes surfaces on does not
// need their definitions.
struct SurfaceTriangle;
struct SurfaceAttributes;
struct SurfaceMaterial;
}  // namespace cairn::interop

namespace cairn::voxelizer {

/// Where a vertex of a chunk comes from.
struct SurfaceSource {
    std::uint32_t item;    ///< index into Snapshot::items
    std::uint32_t vertex;  ///< index into Item::positions
};

/// Triangles of a chunk: its buffers stay under the smallest shader-storage limit in use (128 MiB).
constexpr std::uint32_t surface_chunk_triangles = 1U << 21U;

/// At most Surface::chunk_triangles triangles and the vertices they use.
struct SurfaceChunk {
    std::vector<std::array<std::int32_t, 3>> positions;  ///< lattice units, within [-2^24, 2^25]
    std::vector<interop::SurfaceTriangle> triangles;
    /// One per vertex, or empty (SurfaceOptions::attributes).
    std::vector<interop::SurfaceAttributes> attributes;
    /// One per vertex, or empty (SurfaceOptions::unplaced).
    std::vector<SurfaceSource> sources;

    SurfaceChunk();
    SurfaceChunk(const SurfaceChunk&);
    SurfaceChunk(SurfaceChunk&&) noexcept;
    SurfaceChunk& operator=(const SurfaceChunk&);
    SurfaceChunk& operator=(SurfaceChunk&&) noexcept;
    ~SurfaceChunk();
};

/// A triangle that reaches further than 2^24 units past the root cube, so that products of its coordinates
/// pass 53 bits. Only a grid over given bounds (grid_over()) has far triangles. They are voxelized on the
/// CPU, as exactly.
struct FarTriangle {
    std::array<glm::i64vec3, 3> positions;
    std::array<glm::vec2, 3> texcoords;
    std::array<glm::u16vec4, 3> colors;  ///< linear RGBA, 65535 = 1
    std::uint32_t material;

    [[nodiscard]] std::array<std::uint16_t, 3> alphas() const {
        return {colors[0].a, colors[1].a, colors[2].a};
    }
};

/// The triangles of a snapshot on the lattice of a grid. Every voxelization method, the exact reference and
/// the brick producer share it, so that they see the same triangles. Segments and points are degenerate
/// triangles. Triangles whose bounding box misses the root cube, and masked ones that no texel can show, are
/// left out. Vertices go counter-clockwise seen from the front, in mirrored nodes too.
struct Surface {
    Grid grid;
    /// A triangle's global number is chunk * chunk_triangles + its number in the chunk.
    std::vector<SurfaceChunk> chunks;
    std::uint32_t chunk_triangles = surface_chunk_triangles;
    std::vector<FarTriangle> far_triangles;
    /// Triangles that miss the root cube but lie before or behind it along an axis (SurfaceOptions::outside).
    std::vector<std::array<glm::i64vec3, 3>> outside_triangles;
    std::vector<interop::SurfaceMaterial> materials;  ///< at least one
    /// RGBA8 texels of the images that are used, their mip levels, and the masks' counts of passing texels.
    std::vector<std::uint32_t> texels;
    std::uint64_t triangle_count = 0;
    /// Whether the base colour varies: by textures, vertex colours, or factors that differ.
    bool has_color = false;
    /// The linear base colour everywhere, if it does not vary.
    glm::vec3 uniform_color{1.0F};
    /// Whether an alpha mask cuts a triangle that it neither wholly shows nor wholly hides.
    bool has_mask = false;

    Surface();
    Surface(const Surface&);
    Surface(Surface&&) noexcept;
    Surface& operator=(const Surface&);
    Surface& operator=(Surface&&) noexcept;
    ~Surface();
};

struct SurfaceOptions {
    /// Fills SurfaceChunk::attributes too: normals, colours and texture coordinates. The brick producer needs
    /// them.
    bool attributes = false;
    /// Fills Surface::outside_triangles too. A solid fill needs them.
    bool outside = false;
    /// Keeps all triangles, wherever they are, with `sources`, and leaves positions and normals 0, for
    /// MovingSurface to fill in.
    bool unplaced = false;
    /// Triangles per chunk at most, from 1 to surface_chunk_triangles. No voxel depends on it.
    std::uint32_t chunk_triangles = surface_chunk_triangles;
};

/// @throws Error  Fault::memory if the surface would not fit in memory; Fault::usage if a vertex lies past
///                the lattice's limits.
[[nodiscard]] Surface build_surface(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                                    const Grid& grid, const SurfaceOptions& options = {});

/// The matrix for normals that goes with a matrix for points; all 0 if that matrix flattens space, so that
/// normals have no image.
[[nodiscard]] glm::dmat3 normal_from_mesh(const glm::dmat4& world_from_mesh);

/// A surface in the driver's memory.
struct GpuSurfaceChunk {
    gl::Buffer positions;
    gl::Buffer triangles;
    gl::Buffer attributes;
    std::uint32_t triangle_count = 0;
};
struct GpuSurface {
    std::vector<GpuSurfaceChunk> chunks;
    std::uint32_t chunk_triangles = surface_chunk_triangles;  ///< as in Surface
    std::vector<FarTriangle> far_triangles;
    gl::Buffer materials;
    gl::Buffer texels;
    gl::TextureHandle texel_texture;  ///< shaders read the texels through it
    bool has_texture = false;
    bool has_color = false;
    bool has_mask = false;

    /// Binds SSBO_SURFACE_* and TEXTURE_SURFACE_TEXELS for one chunk.
    void bind(std::size_t chunk) const { bind(chunks[chunk]); }
    /// Binds SSBO_SURFACE_* for a chunk of this surface, or for other triangles with the same materials.
    void bind(const GpuSurfaceChunk& chunk) const;
    void bind_texels() const;
    /// The triangles of a subset that lie in one chunk.
    /// @param subset  global numbers of triangles
    /// @return        their numbers in the chunk
    [[nodiscard]] std::vector<std::uint32_t> subset_in_chunk(std::span<const std::uint32_t> subset,
                                                             std::size_t chunk) const;
    [[nodiscard]] std::size_t size_bytes() const;
};

[[nodiscard]] GpuSurface upload(const Surface& surface);
[[nodiscard]] GpuSurfaceChunk upload_chunk(const SurfaceChunk& chunk);

}  // namespace cairn::voxelizer
