#include "bench/trials/voxel_contenders.h"

#include <chrono>
#include <utility>

#include "bench/peers/cpu_row_span.h"
#include "bench/peers/three_directions.h"
#include "gl/context.h"
#include "shaders/interop/surface.h"
#include "voxelizer/files/voxel_tiles.h"
#include "voxelizer/methods/pyramid_builder.h"
#include "voxelizer/methods/voxelize_tiles.h"
#include "voxelizer/methods/voxelizer.h"
#include "voxelizer/surface/triangle_index.h"
#ifdef CAIRN_BENCH_OPENVDB
#include "bench/peers/openvdb_mesh.h"
#include "shaders/interop/surface.h"
#endif

namespace cairn::bench {
namespace {

constexpr const char* on_cpu = "none: CPU";

VoxelContender of_method(voxelizer::Voxelizer& voxelizer, voxelizer::Method method,
                         const VoxelCase& voxel_case) {
    return {std::string(voxelizer::name_of(method)), gl::driver_name(),
            [&voxelizer, voxel_case](voxelizer::BitGrid* voxels) {
                voxelizer::BitGrid found = voxelizer.voxelize(voxel_case.on_gpu, voxel_case.region);
                if (voxels != nullptr) *voxels = std::move(found);
                return voxelizer.last_milliseconds();
            }};
}

/// Voxelizes as the command does for large grids: region by region, each from its own triangles.
VoxelContender by_regions(voxelizer::Voxelizer& voxelizer, voxelizer::Method method,
                          const VoxelCase& voxel_case) {
    const auto index = std::make_shared<voxelizer::TriangleIndex>(voxel_case.surface);
    return {std::string(voxelizer::name_of(method)), gl::driver_name(),
            [&voxelizer, index, voxel_case](voxelizer::BitGrid* voxels) {
                if (voxels != nullptr) *voxels = voxelizer::BitGrid(voxel_case.region.size);
                return voxelizer::voxelize_tiles(voxelizer, voxel_case.on_gpu, *index,
                                                 voxel_case.surface.grid,
                                                 [voxels](voxelizer::VoxelTile&& tile) {
                                                     if (voxels != nullptr)
                                                         voxelizer::put_tile(tile, *voxels);
                                                 })
                    .milliseconds;
            }};
}

VoxelContender three_directions(const VoxelCase& voxel_case) {
    const auto raster = std::make_shared<ThreeDirections>(voxel_case.surface, 1 << voxel_case.region.level);
    return {"three-directions", gl::driver_name(),
            [raster](voxelizer::BitGrid* /*none*/) { return raster->draw(); }, false};
}

VoxelContender cpu_row_span(const VoxelCase& voxel_case) {
    const auto bits = std::make_shared<voxelizer::BitGrid>(voxel_case.region.size);
    return {cpu_row_span_name, on_cpu, [bits, voxel_case](voxelizer::BitGrid* voxels) {
                const auto start = std::chrono::steady_clock::now();
                mark_row_spans(voxel_case.surface, voxel_case.region, *bits);
                const auto end = std::chrono::steady_clock::now();
                if (voxels != nullptr) *voxels = *bits;
                return std::chrono::duration<double, std::milli>(end - start).count();
            }};
}

#ifdef CAIRN_BENCH_OPENVDB
/// Far triangles are left out, because the library takes floats.
VoxelContender openvdb(const VoxelCase& voxel_case) {
    const double unit = 1.0 / voxel_case.region.voxel_side();
    std::vector<glm::vec3> points;
    std::vector<glm::uvec3> triangles;
    for (const voxelizer::SurfaceChunk& chunk : voxel_case.surface.chunks) {
        const auto first = unsigned(points.size());
        for (const auto& p : chunk.positions)
            points.emplace_back(glm::dvec3(p[0], p[1], p[2]) * unit - glm::dvec3(voxel_case.region.origin));
        for (const interop::SurfaceTriangle& triangle : chunk.triangles)
            triangles.push_back(first + triangle.vertices);
    }
    const OpenVdbMesh mesh(points, triangles);
    return {"openvdb", on_cpu, [mesh, size = voxel_case.region.size](voxelizer::BitGrid* voxels) {
                if (voxels != nullptr) *voxels = voxelizer::BitGrid(size);
                return mesh.convert(voxels);
            }};
}
#endif

}  // namespace

struct VoxelContenders::Impl {
    struct NamedMethod {
        voxelizer::Method method;
        std::unique_ptr<voxelizer::Voxelizer> voxelizer;
    };
    std::vector<NamedMethod> methods;  ///< methods, conservative first
};

VoxelContenders::VoxelContenders(const gl::ShaderSource& shaders) : impl_(new Impl{{}}) {
    for (const voxelizer::Method method : voxelizer::methods())
        impl_->methods.push_back({method, voxelizer::make_voxelizer(method, shaders)});
}
VoxelContenders::~VoxelContenders() = default;

std::vector<VoxelContender> VoxelContenders::at(const VoxelCase& voxel_case) const {
    std::vector<VoxelContender> all;
    // The raster methods cut large grids themselves, in tiles of slices.
    const bool is_large = voxelizer::bit_bytes(voxel_case.region.size) > voxelizer::TileOptions{}.whole_bytes;
    for (const Impl::NamedMethod& named : impl_->methods) {
        const bool regions = is_large && named.method == voxelizer::Method::conservative;
        all.push_back((regions ? by_regions : of_method)(*named.voxelizer, named.method, voxel_case));
    }
    all.push_back(three_directions(voxel_case));
    all.push_back(cpu_row_span(voxel_case));
#ifdef CAIRN_BENCH_OPENVDB
    all.push_back(openvdb(voxel_case));
#endif
    return all;
}

double VoxelContenders::pyramid_ms(const VoxelCase& voxel_case) const {
    voxelizer::Voxelizer& conservative = *impl_->methods.front().voxelizer;
    (void)conservative.voxelize_pyramid(voxel_case.on_gpu, voxel_case.region);
    return conservative.last_pyramid_milliseconds();
}

std::vector<std::string> VoxelContenders::absent() {
#ifdef CAIRN_BENCH_OPENVDB
    return {};
#else
    return {"openvdb was not found when cairn was built (package libopenvdb-dev)"};
#endif
}

}  // namespace cairn::bench
