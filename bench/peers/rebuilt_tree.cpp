#include "bench/peers/rebuilt_tree.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "base/error.h"
#include "scenes/snapshot.h"

namespace cairn::bench {
namespace {

bool is_drawn(const scenes::Item& item) {
    return item.primitive->topology == scenes::Topology::triangles && !item.primitive->indices.empty();
}

}  // namespace

RebuiltTree::RebuiltTree(const scenes::Snapshot& snapshot, RTCBuildQuality quality)
    : device_(rtcNewDevice(nullptr)), tree_(rtcNewScene(device_.get())) {
    rtcSetSceneBuildQuality(tree_.get(), quality);
    if (quality == RTC_BUILD_QUALITY_LOW) rtcSetSceneFlags(tree_.get(), RTC_SCENE_FLAG_DYNAMIC);
    for (const scenes::Item& item : snapshot.items) {
        if (is_drawn(item)) add(item, quality);
    }
    if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE)
        throw Error(Fault::memory, "Embree", "it cannot hold the triangles");
}

void RebuiltTree::write(const scenes::Snapshot& snapshot) {
    std::size_t next = 0;
    for (const scenes::Item& item : snapshot.items) {
        if (!is_drawn(item)) continue;
        const Geometry& geometry = geometries_[next++];
        for (std::size_t i = 0; i < item.vertex_count(); ++i) {
            const glm::vec3 world(item.world(i));
            for (int axis = 0; axis < 3; ++axis)
                geometry.vertices[3 * i + std::size_t(axis)] = world[axis];
        }
        rtcUpdateGeometryBuffer(geometry.owner.get(), RTC_BUFFER_TYPE_VERTEX, 0);
    }
}

void RebuiltTree::build() const {
    for (const Geometry& geometry : geometries_)
        rtcCommitGeometry(geometry.owner.get());
    rtcCommitScene(tree_.get());
}

void RebuiltTree::add(const scenes::Item& item, RTCBuildQuality quality) {
    reference::EmbreeGeometry owner(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    auto* const vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        owner.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), item.vertex_count()));
    auto* const indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(owner.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), item.primitive->element_count()));
    if (vertices == nullptr || indices == nullptr)
        throw Error(Fault::memory, "Embree", "it cannot hold the triangles");
    std::copy(item.primitive->indices.begin(), item.primitive->indices.end(), indices);
    rtcSetGeometryBuildQuality(owner.get(), quality);
    rtcAttachGeometry(tree_.get(), owner.get());
    geometries_.push_back({std::move(owner), vertices});
}

}  // namespace cairn::bench
