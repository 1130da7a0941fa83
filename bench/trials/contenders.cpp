#include "bench/trials/contenders.h"

#include <chrono>
#include <utility>

#include "bench/peers/cpu_row_span.h"
#include "bench/peers/three_directions.h"
#include "gl/context.h"
#include "voxelizer/files/voxel_tiles.h"
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

Contender of_method(voxelizer::Voxelizer& voxelizer, voxelizer::Method method, const Trial& trial) {
    return {std::string(voxelizer::name_of(method)), gl::driver_name(),
            [&voxelizer, trial](voxelizer::BitGrid* voxels) {
                voxelizer::BitGrid found = voxelizer.voxelize(trial.on_gpu, trial.region);
                if (voxels != nullptr) *voxels = std::move(found);
                return voxelizer.last_milliseconds();
            }};
}

/// As the command voxelizes large grids: region by region, each from its own triangles.
Contender by_regions(voxelizer::Voxelizer& voxelizer, voxelizer::Method method, const Trial& trial) {
    const auto index = std::make_shared<voxelizer::TriangleIndex>(trial.surface);
    return {std::string(voxelizer::name_of(method)), gl::driver_name(),
            [&voxelizer, index, trial](voxelizer::BitGrid* voxels) {
                if (voxels != nullptr) *voxels = voxelizer::BitGrid(trial.region.size);
                return voxelizer::voxelize_tiles(voxelizer, trial.on_gpu, *index, trial.surface.grid,
                                                 [voxels](voxelizer::VoxelTile&& tile) {
                                                     if (voxels != nullptr)
                                                         voxelizer::put_tile(tile, *voxels);
                                                 })
                    .milliseconds;
            }};
}

Contender three_directions(const Trial& trial) {
    const auto raster = std::make_shared<ThreeDirections>(trial.surface, 1 << trial.region.level);
    return {"three-directions", gl::driver_name(),
            [raster](voxelizer::BitGrid* /*none*/) { return raster->draw(); }, false};
}

Contender cpu_row_span(const Trial& trial) {
    const auto bits = std::make_shared<voxelizer::BitGrid>(trial.region.size);
    return {cpu_row_span_name, on_cpu, [bits, trial](voxelizer::BitGrid* voxels) {
                const auto start = std::chrono::steady_clock::now();
                mark_row_spans(trial.surface, trial.region, *bits);
                const auto end = std::chrono::steady_clock::now();
                if (voxels != nullptr) *voxels = *bits;
                return std::chrono::duration<double, std::milli>(end - start).count();
            }};
}

#ifdef CAIRN_BENCH_OPENVDB
/// Far triangles are left out, for the library takes floats.
Contender openvdb(const Trial& trial) {
    const double unit = 1.0 / trial.region.voxel_side();
    std::vector<glm::vec3> points;
    std::vector<glm::uvec3> triangles;
    for (const voxelizer::SurfaceChunk& chunk : trial.surface.chunks) {
        const auto first = unsigned(points.size());
        for (const auto& p : chunk.positions)
            points.emplace_back(glm::dvec3(p[0], p[1], p[2]) * unit - glm::dvec3(trial.region.origin));
        for (const interop::SurfaceTriangle& triangle : chunk.triangles)
            triangles.push_back(first + triangle.vertices);
    }
    const OpenVdbMesh mesh(points, triangles);
    return {"openvdb", on_cpu, [mesh, size = trial.region.size](voxelizer::BitGrid* voxels) {
                if (voxels != nullptr) *voxels = voxelizer::BitGrid(size);
                return mesh.convert(voxels);
            }};
}
#endif

}  // namespace

struct Contenders::Parts {
    struct Named {
        voxelizer::Method method;
        std::unique_ptr<voxelizer::Voxelizer> voxelizer;
    };
    std::vector<Named> methods;  ///< conservative first
};

Contenders::Contenders(const gl::ShaderSource& shaders) : parts_(new Parts{{}}) {
    for (const voxelizer::Method method : voxelizer::methods())
        parts_->methods.push_back({method, voxelizer::make_voxelizer(method, shaders)});
}
Contenders::~Contenders() = default;

std::vector<Contender> Contenders::at(const Trial& trial) const {
    std::vector<Contender> all;
    // The raster methods cut large grids themselves, in tiles of slices.
    const bool is_large = voxelizer::bit_bytes(trial.region.size) > voxelizer::TileOptions{}.whole_bytes;
    for (const Parts::Named& named : parts_->methods) {
        const bool regions = is_large && named.method == voxelizer::Method::conservative;
        all.push_back((regions ? by_regions : of_method)(*named.voxelizer, named.method, trial));
    }
    all.push_back(three_directions(trial));
    all.push_back(cpu_row_span(trial));
#ifdef CAIRN_BENCH_OPENVDB
    all.push_back(openvdb(trial));
#endif
    return all;
}

double Contenders::pyramid_ms(const Trial& trial) const {
    voxelizer::Voxelizer& conservative = *parts_->methods.front().voxelizer;
    (void)conservative.voxelize_pyramid(trial.on_gpu, trial.region);
    return conservative.last_pyramid_milliseconds();
}

std::vector<std::string> Contenders::absent() {
#ifdef CAIRN_BENCH_OPENVDB
    return {};
#else
    return {"openvdb was not found when cairn was built (package libopenvdb-dev)"};
#endif
}

}  // namespace cairn::bench
