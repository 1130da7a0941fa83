#pragma once

/// Embree 3 (Debian 12) or 4 (Ubuntu 24.04) behind the same functions.
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
/// Traces eight rays in nearly the same direction; `valid` holds -1 for each ray that counts.
inline void intersect8(const int* valid, RTCScene scene, RTCRayHit8& hits) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect8(valid, scene, &hits, &arguments);
}
inline void occluded8(const int* valid, RTCScene scene, RTCRay8& rays) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcOccluded8(valid, scene, &rays, &arguments);
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
/// Traces eight rays in nearly the same direction; `valid` holds -1 for each ray that counts.
inline void intersect8(const int* valid, RTCScene scene, RTCRayHit8& hits) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(valid, scene, &context, &hits);
}
inline void occluded8(const int* valid, RTCScene scene, RTCRay8& rays) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded8(valid, scene, &context, &rays);
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
