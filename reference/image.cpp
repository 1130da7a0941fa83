#include "reference/image.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "base/clock.h"
#include "optics/srgb.h"
#include "reference/traced_scene.h"

namespace cairn::reference {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
/// Pixels of a packet: 4 x 2.
constexpr int packet_width = 4;
constexpr int packet_rays = 8;

void put(RTCRay8& to, int i, const RTCRay& ray) {
    to.org_x[i] = ray.org_x;
    to.org_y[i] = ray.org_y;
    to.org_z[i] = ray.org_z;
    to.dir_x[i] = ray.dir_x;
    to.dir_y[i] = ray.dir_y;
    to.dir_z[i] = ray.dir_z;
    to.tnear[i] = ray.tnear;
    to.tfar[i] = ray.tfar;
    to.time[i] = ray.time;
    to.mask[i] = ray.mask;
    to.id[i] = ray.id;
    to.flags[i] = ray.flags;
}

/// One picture's worth of rays.
struct Work {
    const TracedScene& scene;
    PictureRays rays;
    ReferenceImage& image;

    [[nodiscard]] std::size_t pixel(int x, int y) const {
        return std::size_t(y) * std::size_t(image.width) + std::size_t(x);
    }

    void trace_row(int y) const {
        for (int x = 0; x < image.width; ++x) {
            const glm::dvec3 direction = rays.direction({x + 0.5, y + 0.5});
            RTCRayHit ray;
            set_ray(ray.ray, glm::vec3(rays.eye()), glm::vec3(direction), 0.0F, infinite);
            ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            intersect(scene.tree.get(), ray);
            if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
            image.depth[pixel(x, y)] = ray.ray.tfar;
            image.primitive[pixel(x, y)] = scene.first_triangle[ray.hit.geomID] + ray.hit.primID;
            RTCRay shadow;
            rays.aim_at_light(shadow, rays.eye() + direction * double(ray.ray.tfar));
            occluded(scene.tree.get(), shadow);
            image.lit[pixel(x, y)] = shadow.tfar >= 0.0F ? 1 : 0;
        }
    }

    /// Rows y and y + 1, in blocks of 4 x 2 pixels.
    void trace_packets(int y) const {
        for (int x = 0; x < image.width; x += packet_width)
            trace_packet(x, y);
    }

private:
    void trace_packet(int x0, int y0) const {
        alignas(32) std::array<int, packet_rays> valid{};
        alignas(32) std::array<int, packet_rays> shadowed{};
        std::array<glm::dvec3, packet_rays> directions;
        RTCRayHit8 hits;
        for (int i = 0; i < packet_rays; ++i) {
            const int x = x0 + i % packet_width;
            const int y = y0 + i / packet_width;
            valid[std::size_t(i)] = x < image.width && y < image.height ? -1 : 0;
            directions[std::size_t(i)] = rays.direction({x + 0.5, y + 0.5});
            RTCRay ray;
            set_ray(ray, glm::vec3(rays.eye()), glm::vec3(directions[std::size_t(i)]), 0.0F, infinite);
            put(hits.ray, i, ray);
            hits.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
            hits.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        }
        intersect8(valid.data(), scene.tree.get(), hits);
        RTCRay8 shadows;
        bool any = false;
        for (int i = 0; i < packet_rays; ++i) {
            const bool hit = valid[std::size_t(i)] != 0 && hits.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
            shadowed[std::size_t(i)] = hit ? -1 : 0;
            any = any || hit;
            RTCRay ray;
            rays.aim_at_light(ray, hit ? rays.eye() + directions[std::size_t(i)] * double(hits.ray.tfar[i])
                                       : glm::dvec3(0.0));
            put(shadows, i, ray);
        }
        if (!any) return;
        occluded8(shadowed.data(), scene.tree.get(), shadows);
        for (int i = 0; i < packet_rays; ++i) {
            if (shadowed[std::size_t(i)] == 0) continue;
            const std::size_t p = pixel(x0 + i % packet_width, y0 + i / packet_width);
            image.depth[p] = hits.ray.tfar[i];
            image.primitive[p] = scene.first_triangle[hits.hit.geomID[i]] + hits.hit.primID[i];
            image.lit[p] = shadows.tfar[i] >= 0.0F ? 1 : 0;
        }
    }
};

}  // namespace

struct ImageTracer::Impl {
    TracedScene scene;
};

ImageTracer::ImageTracer(const scenes::Scene& scene, const scenes::Snapshot& snapshot)
    : impl_(new Impl{TracedScene(scene, snapshot)}) {}
ImageTracer::~ImageTracer() = default;

bool ImageTracer::blocked(const glm::dvec3& from, const glm::dvec3& to) const {
    const glm::dvec3 way = to - from;
    const double length = glm::length(way);
    const double gap = 1e-5 * impl_->scene.size;
    if (!(length > 2.0 * gap)) return false;
    RTCRay ray;
    set_ray(ray, glm::vec3(from - impl_->scene.centre), glm::vec3(way / length), float(gap),
            float(length - gap));
    occluded(impl_->scene.tree.get(), ray);
    return ray.tfar < 0.0F;
}

int ImageTracer::count_reached(const glm::dvec3& from, std::span<const glm::dvec3> to, Rays kind) const {
    if (kind == Rays::single)
        return int(
            std::count_if(to.begin(), to.end(), [&](const glm::dvec3& p) { return !blocked(from, p); }));
    const double gap = 1e-5 * impl_->scene.size;
    const glm::vec3 origin(from - impl_->scene.centre);
    int reached = 0;
    while (!to.empty()) {
        const std::size_t count = std::min(to.size(), std::size_t(packet_rays));
        alignas(32) std::array<int, packet_rays> valid{};
        RTCRay8 rays;
        for (std::size_t i = 0; i < packet_rays; ++i) {
            const glm::dvec3 way = to[std::min(i, count - 1)] - from;
            const double length = glm::length(way);
            const bool is_ray = i < count && length > 2.0 * gap;
            reached += i < count && !is_ray ? 1 : 0;
            valid[i] = is_ray ? -1 : 0;
            RTCRay ray;
            set_ray(ray, origin, glm::vec3(way / length), float(gap), float(length - gap));
            put(rays, int(i), ray);
        }
        occluded8(valid.data(), impl_->scene.tree.get(), rays);
        for (std::size_t i = 0; i < packet_rays; ++i)
            reached += valid[i] != 0 && rays.tfar[i] >= 0.0F ? 1 : 0;
        to = to.subspan(count);
    }
    return reached;
}

double ImageTracer::build_milliseconds() const {
    return impl_->scene.build_milliseconds;
}

const glm::dvec3& ImageTracer::centre() const {
    return impl_->scene.centre;
}
double ImageTracer::diagonal() const {
    return impl_->scene.size;
}

ReferenceImage ImageTracer::trace(const optics::Camera& camera, const optics::Light& light, int width,
                                  int height, int threads, Rays kind) const {
    ReferenceImage image;
    image.width = width;
    image.height = height;
    const std::size_t pixels = std::size_t(width) * std::size_t(height);
    image.depth.assign(pixels, infinite);
    image.lit.assign(pixels, 0);
    image.primitive.assign(pixels, ReferenceImage::no_primitive);
    const Work work{impl_->scene, PictureRays(camera, light, impl_->scene, {width, height}), image};
    tbb::task_arena arena(threads > 0 ? threads : int(tbb::task_arena::automatic));
    const auto start = Clock::now();
    arena.execute([&] {
        if (kind == Rays::single) {
            tbb::parallel_for(0, height, [&](int y) { work.trace_row(y); });
        } else {
            tbb::parallel_for(0, (height + 1) / 2, [&](int pair) { work.trace_packets(2 * pair); });
        }
    });
    image.milliseconds = milliseconds_since(start);
    return image;
}

namespace {

/// Light that a surface sends to the eye, linear (shaders/march/shade.glsl has the same formula).
glm::vec3 shade(const TracedScene& scene, const PictureRays& rays, const Shading& shading,
                const glm::dvec3& direction) {
    RTCRayHit ray;
    set_ray(ray.ray, glm::vec3(rays.eye()), glm::vec3(direction), 0.0F, infinite);
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    intersect(scene.tree.get(), ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return glm::vec3(-1.0F);
    const PrimitiveLook& look = scene.looks[ray.hit.geomID];
    const TrianglePoint at{ray.hit.primID, glm::vec3(1.0F - ray.hit.u - ray.hit.v, ray.hit.u, ray.hit.v)};
    glm::dvec3 normal = look.normal_at(at);
    if (glm::dot(normal, direction) > 0.0) normal = -normal;  // surfaces have two sides
    const glm::dvec3 point = rays.eye() + direction * double(ray.ray.tfar);
    float facing = float(std::max(glm::dot(normal, rays.towards_light(point)), 0.0));
    if (shading.shadows && facing > 0.0F) {
        RTCRay shadow;
        rays.aim_at_light(shadow, point);
        occluded(scene.tree.get(), shadow);
        if (shadow.tfar < 0.0F) facing = 0.0F;
    }
    const float sky = shading.ambient * (0.75F + 0.25F * float(normal.y));
    return look.color_at(at) * shading.light_color * (sky + (1.0F - shading.ambient) * facing);
}

}  // namespace

ShadedImage ImageTracer::shade(const optics::Camera& camera, const optics::Light& light,
                               const Shading& shading, int width, int height, int samples_per_side) const {
    const TracedScene& scene = impl_->scene;
    const PictureRays rays(camera, light, scene, {width, height});
    ShadedImage image;
    image.width = width;
    image.height = height;
    image.srgb.resize(std::size_t(width) * std::size_t(height));
    image.coverage.resize(image.srgb.size());
    const float share = 1.0F / float(samples_per_side * samples_per_side);
    const auto start = Clock::now();
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x) {
            glm::vec3 sum(0.0F);
            float covered = 0.0F;
            for (int s = 0; s < samples_per_side * samples_per_side; ++s) {
                const glm::ivec2 cell(s % samples_per_side, s / samples_per_side);
                const glm::dvec2 in_pixel = (glm::dvec2(cell) + 0.5) / double(samples_per_side);
                const glm::vec3 light_seen =
                    reference::shade(scene, rays, shading, rays.direction(glm::dvec2(x, y) + in_pixel));
                covered += light_seen.x < 0.0F ? 0.0F : share;
                sum += share * (light_seen.x < 0.0F ? shading.background : light_seen);
            }
            const std::size_t p = std::size_t(y) * std::size_t(width) + std::size_t(x);
            image.srgb[p] = {optics::srgb_from_linear(sum.r), optics::srgb_from_linear(sum.g),
                             optics::srgb_from_linear(sum.b)};
            image.coverage[p] = covered;
        }
    });
    image.milliseconds = milliseconds_since(start);
    return image;
}

}  // namespace cairn::reference
