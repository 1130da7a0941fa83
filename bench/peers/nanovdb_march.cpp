#include "bench/peers/nanovdb_march.h"

#include <chrono>

#include <nanovdb/util/GridBuilder.h>
#include <nanovdb/util/HDDA.h>
#include <nanovdb/util/Ray.h>
#include <tbb/parallel_for.h>

#include "base/clock.h"

namespace cairn::bench {
namespace {

using Ray = nanovdb::Ray<float>;
using Vec = nanovdb::Vec3<float>;

/// Distance in voxels at which a shadow ray starts from the surface, so as not to meet it again.
constexpr float shadow_gap = 3.0F;

Vec vec(const glm::dvec3& v) {
    return {float(v.x), float(v.y), float(v.z)};
}

}  // namespace

struct NanoVdbMarch::Grid {
    nanovdb::GridHandle<> handle;
};

NanoVdbMarch::NanoVdbMarch(const voxelizer::BitGrid& voxels) : grid_(std::make_unique<Grid>()) {
    nanovdb::GridBuilder<float> builder(0.0F);
    auto accessor = builder.getAccessor();
    for (int z = 0; z < voxels.size.z; ++z) {
        for (int y = 0; y < voxels.size.y; ++y) {
            for (int x = 0; x < voxels.size.x; ++x) {
                if (x % 32 == 0 && voxels.words[voxels.word_index(x, y, z)] == 0) {
                    x += 31;
                } else if (voxels.at({x, y, z})) {
                    accessor.setValue({x, y, z}, 1.0F);
                }
            }
        }
    }
    grid_->handle = builder.getHandle<>();
}

NanoVdbMarch::~NanoVdbMarch() = default;

NanoVdbMarch::Result NanoVdbMarch::march(const GridView& view) const {
    Result result;
    result.hit.assign(std::size_t(view.width) * std::size_t(view.height), 0);
    const auto* const grid = grid_->handle.grid<float>();
    const Vec eye = vec(view.eye);
    const Vec light = vec(glm::normalize(view.towards_light));
    const auto start = std::chrono::steady_clock::now();
    tbb::parallel_for(0, view.height, [&](int y) {
        auto accessor = grid->getAccessor();
        for (int x = 0; x < view.width; ++x) {
            const glm::dvec3 way = view.forward + ((2.0 * x + 1.0) / view.width - 1.0) * view.right +
                                   (1.0 - (2.0 * y + 1.0) / view.height) * view.up;
            Ray ray(eye, vec(glm::normalize(way)));
            nanovdb::Coord voxel;
            float t = 0.0F;
            if (!nanovdb::firstActive(ray, accessor, voxel, t)) continue;
            Ray shadow(ray(t) + light * shadow_gap, light);
            const bool shadowed = nanovdb::firstActive(shadow, accessor, voxel, t);
            result.hit[std::size_t(y) * std::size_t(view.width) + std::size_t(x)] = shadowed ? 1 : 2;
        }
    });
    result.milliseconds = milliseconds_since(start);
    return result;
}

}  // namespace cairn::bench
