#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gl/buffer.h"
#include "scenes/pose.h"
#include "scenes/snapshot.h"
#include "shaders/interop/deform.h"
#include "voxelizer/surface/surface.h"

namespace cairn::voxelizer {

/// The buffers that move the vertices of one chunk of a surface: their data at rest, and the weights of a
/// frame. Matrices are numbered as in the moving surface.
class MovingChunk {
public:
    /// @param chunk         must have `sources`, ordered by item
    /// @param first_joints  per skin of the scene, the number of the matrix of its first joint
    /// @param normals       whether the chunk's normals move too
    /// @throws Error  Fault::memory when a buffer passes the driver's shader-storage limit.
    MovingChunk(const scenes::Scene& scene, const scenes::Snapshot& snapshot, const SurfaceChunk& chunk,
                std::span<const std::uint32_t> first_joints, bool normals);

    /// Number of the matrix world_from_mesh of an item of the snapshot; the one after it moves its normals.
    [[nodiscard]] static std::uint32_t matrix_of_item(std::size_t item) { return std::uint32_t(2 * item); }

    /// Starts a frame: weights and the lattice go to the driver, counters to 0.
    void write_frame(const scenes::Scene& scene, const scenes::Pose& pose, const Grid& grid);
    [[nodiscard]] interop::DeformHeader read_header() const;
    /// Binds SSBO_DEFORM_*, except for the matrices.
    void bind() const;
    void bind_frame() const { frame_.bind_storage(SSBO_DEFORM_FRAME); }

    [[nodiscard]] std::uint32_t vertex_count() const { return vertex_count_; }
    /// Greatest number of loop turns for a vertex; past DEFORM_TURNS a driver may end the loop early.
    [[nodiscard]] std::size_t most_turns() const { return most_turns_; }

private:
    struct Arrays;  ///< data to be uploaded
    /// The place in a Pose of a target's weight.
    struct WeightSource {
        std::size_t node, target;
    };
    void add_run(const scenes::Snapshot& snapshot, std::span<const SurfaceSource> run,
                 std::span<const std::uint32_t> first_joints, const scenes::Scene& scene, bool normals,
                 Arrays& arrays);
    void add_targets(const scenes::Item& item, std::span<const SurfaceSource> run, bool normals,
                     Arrays& arrays);

    std::uint32_t vertex_count_ = 0;
    std::size_t most_turns_ = 0;
    std::vector<interop::DeformTarget> targets_;
    std::vector<WeightSource> weight_sources_;  ///< one per target
    gl::Buffer vertices_;
    gl::Buffer vectors_;
    gl::Buffer influences_;
    gl::Buffer items_;
    gl::Buffer frame_;
};

}  // namespace cairn::voxelizer
