#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "voxelizer/bit_grid.h"
#include "voxelizer/grid.h"
#include "voxelizer/surface/surface.h"

namespace cairn::reference {

/// The true voxels of a region: those whose closed box meets the part of a closed triangle of the surface
/// that the alpha mask leaves. Embree finds candidates; exact predicates in 128-bit integers decide. Runs on
/// all cores.
class ExactVoxels {
public:
    /// Refers to the surface, which must outlive it.
    /// @throws Error  Fault::memory if Embree cannot hold the triangles.
    explicit ExactVoxels(const voxelizer::Surface& surface);
    ExactVoxels(const ExactVoxels&) = delete;
    ExactVoxels& operator=(const ExactVoxels&) = delete;
    ExactVoxels(ExactVoxels&&) = delete;
    ExactVoxels& operator=(ExactVoxels&&) = delete;
    ~ExactVoxels();

    [[nodiscard]] voxelizer::BitGrid in(const voxelizer::Region& region) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The exact voxels of one region alone.
[[nodiscard]] voxelizer::BitGrid exact_voxels(const voxelizer::Surface& surface,
                                              const voxelizer::Region& region);

struct Comparison {
    std::uint64_t occupied = 0;               ///< voxels that are occupied in the truth
    std::uint64_t missing = 0;                ///< voxels occupied in the truth only
    std::uint64_t extra = 0;                  ///< voxels occupied in `ours` only
    std::vector<glm::ivec3> first_different;  ///< at most eight, ordered by z, y, x
};

/// Both grids must have one size.
[[nodiscard]] Comparison compare(const voxelizer::BitGrid& ours, const voxelizer::BitGrid& truth);

}  // namespace cairn::reference
