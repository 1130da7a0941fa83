#pragma once

/// Embree 3 (Debian 12) or 4 (Ubuntu 24.04) behind the calls that both have in one shape or the other.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <memory>
#include <type_traits>

namespace cairn::reference {

#if RTC_VERSION_MAJOR >= 4
inline void intersect(RTCScene scene, RTCRayHit& hit) {
    rtcIntersect1(scene, &hit);
}
inline void occluded(RTCScene scene, RTCRay& ray) {
    rtcOccluded1(scene, &ray);
}
#else
inline void intersect(RTCScene scene, RTCRayHit& hit) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &hit);
}
inline void occluded(RTCScene scene, RTCRay& ray) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
}
#endif

struct EmbreeDelete {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
template <typename Handle>
using EmbreeOwner = std::unique_ptr<std::remove_pointer_t<Handle>, EmbreeDelete>;
using EmbreeDevice = EmbreeOwner<RTCDevice>;
using EmbreeScene = EmbreeOwner<RTCScene>;
using EmbreeGeometry = EmbreeOwner<RTCGeometry>;

}  // namespace cairn::reference
