#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "gl/program.h"
#include "gl/shader_source.h"
#include "scenes/pose.h"
#include "scenes/snapshot.h"
#include "voxelizer/grid.h"
#include "voxelizer/surface/moving_chunk.h"
#include "voxelizer/surface/surface.h"

namespace cairn::voxelizer {

/// The surface of an animated scene, moved to any moment on the GPU: morph targets, skins with any number of
/// influences, nodes. Built once for a grid (bounds_over_animation finds bounds that serve all frames), then
/// voxelized by any Voxelizer. Moving it takes no memory, on the CPU or the GPU.
///
///     MovingSurface surface(scene, {.animation = 0}, grid);
///     for (const double seconds : scenes::frame_times(scene, {.animation = 0}, 30.0))
///         voxelizer.voxelize_into(surface.move_to(seconds), whole(grid), bits);
///
/// The lattice positions are those of take_snapshot and build_surface, bit for bit, so voxels inside the root
/// cube are too. The GPU must add and multiply doubles as IEEE 754 says, and may take numbers under 2^-126
/// for 0. Differences from build_surface:
/// - triangles that miss the root cube are kept, so a region that reaches out of the cube shows them;
/// - normals (SurfaceOptions::attributes) may differ by the last step of their 16 bits, since drivers need
///   not round quotients and roots alike.
///
/// A frame is built on the CPU, and uploaded as a new surface, where shaders cannot do it exactly: a triangle
/// reaches the root cube from more than 2^24 units past it (only explicit bounds make such), or a vertex has
/// more than DEFORM_TURNS morph targets and influences. `was_on_cpu` tells.
class MovingSurface {
public:
    /// Stands at `when.seconds`. The scene must outlive the surface; needs the current context of its
    /// construction.
    /// @throws Error  as take_snapshot, build_surface and upload do.
    MovingSurface(const scenes::Scene& scene, const scenes::When& when, const Grid& grid,
                  const SurfaceOptions& options = {}, const gl::ShaderSource& shaders = {});

    /// @return the surface at that moment; valid until the next move.
    /// @throws Error  as take_snapshot and build_surface do; the surface then stays unusable until it moves.
    const GpuSurface& move_to(double seconds);

    /// Where it was moved last.
    [[nodiscard]] const GpuSurface& surface() const { return on_cpu_ ? *on_cpu_ : on_gpu_; }
    [[nodiscard]] bool was_on_cpu() const { return on_cpu_.has_value(); }
    [[nodiscard]] std::uint64_t triangle_count() const { return triangle_count_; }
    [[nodiscard]] const Grid& grid() const { return grid_; }

private:
    /// What the snapshot said of an item that no moment changes.
    struct MovingItem {
        int node, instance;
        bool skinned;
    };
    void add_skins(const scenes::Snapshot& snapshot);
    void write_matrices(const scenes::Pose& pose);
    void write_matrix(std::size_t number, const glm::dmat4& matrix);
    /// Whether the GPU could place every vertex that matters.
    [[nodiscard]] bool deform(const scenes::Pose& pose);
    [[nodiscard]] bool any_far_triangle(std::size_t chunk);

    const scenes::Scene& scene_;
    scenes::When when_;
    Grid grid_;
    SurfaceOptions options_;
    scenes::Poser poser_;
    gl::Program deform_;
    gl::Program find_far_;
    std::vector<MovingItem> items_;
    std::vector<std::uint32_t> first_joints_;  ///< one a skin: its first matrix; DEFORM_NONE: not in use
    std::vector<double> matrices_;             ///< twelve numbers each
    gl::Buffer matrix_buffer_;
    std::vector<MovingChunk> chunks_;
    GpuSurface on_gpu_;
    std::optional<GpuSurface> on_cpu_;
    std::uint64_t triangle_count_ = 0;
};

}  // namespace cairn::voxelizer
