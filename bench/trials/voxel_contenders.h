#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gl/shader_source.h"
#include "voxelizer/bit_grid.h"
#include "voxelizer/grid.h"
#include "voxelizer/surface/surface.h"

namespace cairn::bench {

/// A surface at one resolution, and the region to voxelize.
struct VoxelCase {
    const voxelizer::Surface& surface;
    const voxelizer::GpuSurface& on_gpu;
    voxelizer::Region region;
};

/// A method that turns triangles into voxels, or only draws them.
struct VoxelContender {
    std::string name;
    std::string driver;
    /// Voxelizes once. @param voxels  receives the result if not null. @return milliseconds, without uploads,
    /// read-backs and the allocation of what can be kept.
    std::function<double(voxelizer::BitGrid* voxels)> run;
    bool finds_voxels = true;
};

/// Makes the contenders of cases. It outlives a case, so that programs are compiled once.
class VoxelContenders {
public:
    explicit VoxelContenders(const gl::ShaderSource& shaders);
    ~VoxelContenders();
    VoxelContenders(const VoxelContenders&) = delete;
    VoxelContenders& operator=(const VoxelContenders&) = delete;
    VoxelContenders(VoxelContenders&&) = delete;
    VoxelContenders& operator=(VoxelContenders&&) = delete;

    /// All contenders of a case: every method of the voxelizer, plain rasterization, and the peers on the
    /// CPU. The case must outlive them.
    [[nodiscard]] std::vector<VoxelContender> at(const VoxelCase& voxel_case) const;

    /// Milliseconds of all coarser levels of the pyramid, right after its finest level was voxelized.
    [[nodiscard]] double pyramid_ms(const VoxelCase& voxel_case) const;

    /// Contenders that are not in this build, in words; one per entry.
    [[nodiscard]] static std::vector<std::string> absent();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

constexpr const char* cpu_row_span_name = "cpu-row-span";

}  // namespace cairn::bench
