#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "gl/buffer.h"
#include "renderer/produce/content.h"
#include "renderer/produce/transfer_table.h"
#include "renderer/produce/volume.h"

namespace cairn::renderer {

/// Marks the visible ones of the 256 densities that a brick distinguishes. A density between two of them is
/// visible if one of the two is.
using VisibleDensities = std::array<bool, 256>;

/// Tests whether densities within bounds are visible.
class DensityTest {
public:
    explicit DensityTest(const VisibleDensities& visible);
    /// Is any density in [low, high] visible?
    [[nodiscard]] bool shows(std::uint8_t low, std::uint8_t high) const {
        return before_[high + 1U] != before_[low];
    }

private:
    std::array<std::uint16_t, 257> before_{};  // visible densities below each density
};

/// A tree's shape and the field's coarseness at its finest level.
struct VolumeShape {
    TreeShape tree;
    int finest_coarseness = 0;  ///< above 0 if the resolution was limited

    /// Coarseness of the voxels of a level.
    [[nodiscard]] int coarseness(int level) const { return finest_coarseness + tree.max_level - level; }
    /// Side of the finest voxels, in samples of the field.
    [[nodiscard]] std::int64_t finest_voxel_side() const;
};

/// The least tree that holds the field at its finest, but with at most `max_resolution` voxels along its
/// longest axis: voxels are as many times coarser as a whole power of n makes them.
/// @throws Error (Fault::usage) as make_tree_shape() does, and if the field is made for another n.
[[nodiscard]] VolumeShape make_volume_shape(const FieldFrame& frame, int n, int m, int max_resolution);

/// Finds empty tiles by the bounds of the field's densities there, the border of the brick included.
class VolumeOracle final : public Oracle {
public:
    /// Refers to the field and the test, which must outlive it.
    VolumeOracle(const VolumeShape& shape, const Field& field, const DensityTest& test);
    [[nodiscard]] glm::uvec2 child_mask(const Tile& tile) override;
    [[nodiscard]] bool is_empty(const Tile& tile) override;

private:
    VolumeShape shape_;
    const Field& field_;
    const DensityTest& test_;
};

/// Fills bricks with densities on the CPU, many at once, and uploads them through a pixel-unpack buffer. A
/// voxel is marked in the masks if a trilinear fetch anywhere in it may be visible.
class VolumeProducer final : public Producer {
public:
    /// Refers to the field and the test, which must outlive it.
    /// @param batch_bytes  texels that are made and sent at once; at least one brick's. No brick depends on
    /// it.
    VolumeProducer(const VolumeShape& shape, const Field& field, const DensityTest& test,
                   std::size_t batch_bytes = std::size_t(4) << 20U);
    std::vector<ProducedTile> produce(std::span<const BrickRequest> requests, BrickPool& pool) override;
    [[nodiscard]] double upload_ms() const override { return upload_ms_; }

private:
    void produce_batch(std::span<const BrickRequest> requests, const BrickPool& pool,
                       std::vector<ProducedTile>& produced);

    VolumeShape shape_;
    const Field& field_;
    const DensityTest& test_;
    std::size_t batch_;
    std::vector<std::uint8_t> texels_;
    std::vector<std::uint64_t> masks_;
    gl::Buffer upload_;
    double upload_ms_ = 0.0;
};

/// A field of densities, as Crassin et al. 2008 explore them.
///
/// The transfer function is fixed: one that shows other densities needs another content.
class VolumeContent final : public Content {
public:
    /// @throws Error (Fault::usage) if VolumeOptions are out of range.
    VolumeContent(const VolumeShape& shape, std::shared_ptr<const Field> field,
                  const TransferFunction& transfer, const VolumeOptions& options = {});

    [[nodiscard]] const TreeShape& shape() const override { return shape_.tree; }
    [[nodiscard]] Oracle& oracle() override { return oracle_; }
    [[nodiscard]] Producer& producer() override { return producer_; }
    [[nodiscard]] const voxelizer::Grid& grid() const override { return grid_; }
    [[nodiscard]] bool has_color() const override { return false; }
    [[nodiscard]] Channels channels() const override { return {.color = false, .normal = false}; }
    [[nodiscard]] glm::vec3 uniform_color() const override { return glm::vec3(1.0F); }
    [[nodiscard]] ContentProgram program() const override;
    [[nodiscard]] bool has_constant() const override { return true; }

private:
    VolumeShape shape_;
    std::shared_ptr<const Field> field_;
    DensityTest test_;
    voxelizer::Grid grid_;
    int steps_per_voxel_;
    std::shared_ptr<const TransferTable> table_;
    VolumeOracle oracle_;
    VolumeProducer producer_;
};

}  // namespace cairn::renderer
