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

/// The surface at one resolution, and the region to voxelize.
struct VoxelCase {
    const voxelizer::Surface& surface;
    const voxelizer::GpuSurface& on_gpu;
    voxelizer::Region region;
};

/// Something that turns triangles into voxels, or only draws them.
struct VoxelContender {
    std::string name;
    std::string driver;
    /// Voxelizes once. @param voxels  receives the result if not null. @return milliseconds of the work
    /// alone: no upload, no read-back, no allocation of what can be kept.
    std::function<double(voxelizer::BitGrid* voxels)> run;
    bool finds_voxels = true;
};

/// Makes the contenders of a case; kept apart so that compiled programs outlive a case.
class VoxelContenders {
public:
    explicit VoxelContenders(const gl::ShaderSource& shaders);
    ~VoxelContenders();
    VoxelContenders(const VoxelContenders&) = delete;
    VoxelContenders& operator=(const VoxelContenders&) = delete;

    /// All contenders at one case, which must outlive what is returned: every method of the voxelizer, plain
    /// rasterization, and the peers on the CPU.
    [[nodiscard]] std::vector<VoxelContender> at(const VoxelCase& voxel_case) const;

    /// All coarser levels of the pyramid, right after their finest level was voxelized: milliseconds.
    [[nodiscard]] double pyramid_ms(const VoxelCase& voxel_case) const;

    /// What cannot take part in this build, in words; one a line.
    [[nodiscard]] static std::vector<std::string> absent();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

constexpr const char* cpu_row_span_name = "cpu-row-span";

}  // namespace cairn::bench
