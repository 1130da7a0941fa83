#pragma once

#include <cstdint>
#include <memory>

#include "gl/shader_source.h"
#include "scenes/snapshot.h"
#include "voxelizer/grid.h"
#include "voxelizer/surface/surface.h"

namespace cairn::voxelizer {

/// The surface of an animated scene, which the GPU moves to any moment: by morph targets, skins with any
/// number of influences, and nodes. Built once for a grid (bounds_over_animation finds bounds that serve all
/// frames), then voxelized by any Voxelizer. Moving it takes no memory, on the CPU or the GPU.
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
/// A frame is built on the CPU, and uploaded as a new surface, if shaders cannot move it exactly: if a
/// triangle reaches the root cube from more than 2^24 units past it (possible only with explicit bounds), or
/// a vertex has more than 16384 morph targets and influences (DEFORM_TURNS in the shaders). was_on_cpu()
/// reports it.
class MovingSurface {
public:
    /// Builds the surface at `when.seconds`. The scene must outlive the surface; needs the current context of
    /// its construction.
    /// @throws Error  as take_snapshot, build_surface and upload do.
    MovingSurface(const scenes::Scene& scene, const scenes::When& when, const Grid& grid,
                  const SurfaceOptions& options = {}, const gl::ShaderSource& shaders = {});
    MovingSurface(MovingSurface&&) noexcept;
    MovingSurface& operator=(MovingSurface&&) noexcept;
    MovingSurface(const MovingSurface&) = delete;
    MovingSurface& operator=(const MovingSurface&) = delete;
    ~MovingSurface();

    /// Moves the surface to a moment. @return the surface there; valid until the next move.
    /// @throws Error  as take_snapshot and build_surface do; the surface is then unusable until the next
    /// move.
    const GpuSurface& move_to(double seconds);

    /// The surface at the moment of the last move.
    [[nodiscard]] const GpuSurface& surface() const;
    /// Whether the last move was done on the CPU.
    [[nodiscard]] bool was_on_cpu() const;
    [[nodiscard]] std::uint64_t triangle_count() const;
    [[nodiscard]] const Grid& grid() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cairn::voxelizer
