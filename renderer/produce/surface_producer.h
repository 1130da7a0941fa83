#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "renderer/produce/content.h"
#include "shaders/interop/produce.h"
#include "voxelizer/surface/surface.h"
#include "voxelizer/surface/triangle_index.h"

namespace cairn::renderer {

/// How much a SurfaceProducer does at a time. No brick depends on it. A number under the least is taken for
/// the least.
struct SurfaceProducerLimits {
    std::size_t scratch_bytes = std::size_t(24) << 20U;  ///< of the bricks of a batch; at least one brick's
    std::size_t pairs = std::size_t(1)
                        << 18U;  ///< of triangle and tile, sent to the driver at once; at least 1
};

/// Fills bricks by voxelizing the tile's region four times finer, from the triangles in the tile's list:
/// these are the voxels' marks; a slab holds the surface where normals are alike, and takes the place of
/// marks that tell no more; and base colour and normal are means over the surface. All work is on the GPU,
/// for many bricks at once; the CPU only learns how much room each brick needs. Each mip is voxelized like a
/// brick of its own, so that it equals the matching part of the parent's brick.
class SurfaceProducer final : public Producer {
public:
    /// Refers to the surface and the lists, which must outlive it.
    SurfaceProducer(const TreeShape& shape, const voxelizer::GpuSurface& surface,
                    voxelizer::TriangleIndex& lists, const gl::ShaderSource& shaders,
                    const SurfaceProducerLimits& limits = {});

    std::vector<ProducedTile> produce(std::span<const BrickRequest> requests, BrickPool& pool) override;

private:
    void produce_batch(std::span<const BrickRequest> requests, BrickPool& pool,
                       std::span<ProducedTile> produced);
    /// Rays meet whole voxels where those are cut in thirds.
    [[nodiscard]] bool has_slabs() const {
        return shape_.cell_base() == 2 && (unsigned(shape_.geometry) & unsigned(VoxelGeometry::slabs)) != 0;
    }
    void number_records(std::size_t tile_count);
    void find_slabs(std::size_t tile_count);
    void find_room(std::span<const BrickRequest> requests, BrickPool& pool, std::span<ProducedTile> produced);
    void pack(std::size_t tile_count, const BrickPool& pool);
    void dispatch(gl::Program& program, std::size_t tile_count, std::size_t threads) const;
    void gather_pairs(std::span<const BrickRequest> requests);
    void gather_pairs_of_mip(const Tile& tile, std::uint32_t number, int mip,
                             std::span<const std::uint32_t> triangles);
    void run_pairs(gl::Program& program, std::size_t chunk);

    TreeShape shape_;
    const voxelizer::GpuSurface& surface_;
    voxelizer::TriangleIndex& lists_;
    int batch_ = 1;          ///< bricks at a time
    std::size_t pair_room_;  ///< pairs that are sent to the driver at once
    gl::Program splat_;
    gl::Program normals_;
    gl::Program slabs_;
    gl::Program flat_voxels_;
    gl::Program count_marks_;
    gl::Program masks_;
    gl::Program border_masks_;
    gl::Program summarize_;
    gl::Program count_records_;
    gl::Program store_heads_;
    gl::Program resolve_;
    std::vector<interop::BrickTile> batch_tiles_;
    std::size_t record_count_ = 0;  ///< of the batch's bricks
    gl::Buffer tiles_;
    gl::Buffer heads_;
    gl::Buffer counts_;
    gl::Buffer marked_;
    gl::Buffer record_places_;
    gl::Buffer scratch_;
    gl::Buffer pair_buffer_;
    std::vector<std::uint32_t> listed_;                   // triangles of a tile
    std::vector<std::vector<interop::BrickPair>> pairs_;  // one list per surface chunk
};

}  // namespace cairn::renderer
