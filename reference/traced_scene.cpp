#include "reference/traced_scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/error.h"
#include "optics/camera.h"
#include "optics/light.h"
#include "optics/srgb.h"

namespace cairn::reference {
namespace {

/// The texel of an image that a coordinate falls on, by glTF's wrap modes. A coordinate that is not finite
/// counts as 0.
int wrapped(double coordinate, int size, scenes::Wrap wrap) {
    if (!std::isfinite(coordinate)) return 0;
    if (wrap == scenes::Wrap::clamp_to_edge)
        return int(std::clamp(std::floor(coordinate * size), 0.0, size - 1.0));
    double unit = coordinate - std::floor(coordinate);
    const bool odd = std::fmod(std::abs(std::floor(coordinate)), 2.0) == 1.0;
    if (wrap == scenes::Wrap::mirrored_repeat && odd) unit = 1.0 - unit;
    return std::min(int(unit * size), size - 1);
}

/// Sum of a vertex attribute's values at the corners, weighted.
template <typename Sum, typename Values>
Sum blend(const Values& values, const scenes::Primitive& primitive, const TrianglePoint& point) {
    Sum sum(0.0F);
    for (int i = 0; i < 3; ++i)
        sum += point.weights[i] *
               Sum(values[primitive.indices[std::size_t(point.triangle) * 3 + std::size_t(i)]]);
    return sum;
}

void drop_holes(const RTCFilterFunctionNArguments* arguments) {
    const auto* const look = static_cast<const PrimitiveLook*>(arguments->geometryUserPtr);
    for (unsigned i = 0; i < arguments->N; ++i) {
        if (arguments->valid[i] == 0) continue;
        const float u = RTCHitN_u(arguments->hit, arguments->N, i);
        const float v = RTCHitN_v(arguments->hit, arguments->N, i);
        const TrianglePoint point{RTCHitN_primID(arguments->hit, arguments->N, i),
                                  glm::vec3(1.0F - u - v, u, v)};
        if (look->alpha_at(point) < look->material->alpha_cutoff) arguments->valid[i] = 0;
    }
}

std::string shown(const glm::dvec3& place) {
    return fmt::format("({}, {}, {})", place.x, place.y, place.z);
}

}  // namespace

PrimitiveLook::PrimitiveLook(const scenes::Scene& scene, const scenes::Item& from) : item(&from) {
    const int index = from.primitive->material;
    if (index < 0) return;
    material = &scene.materials[std::size_t(index)];
    if (material->texture < 0) return;
    texture = &scene.textures[std::size_t(material->texture)];
    if (texture->image >= 0) image = &scene.images[std::size_t(texture->image)];
}

glm::vec4 PrimitiveLook::texel_at(const TrianglePoint& point) const {
    if (image == nullptr) return glm::vec4(1.0F);
    const scenes::Primitive& primitive = *item->primitive;
    const glm::vec2 own = primitive.texcoords.empty()
                              ? glm::vec2(0.0F)
                              : blend<glm::vec2>(primitive.texcoords, primitive, point);
    const glm::vec3 uv = material->uv_from_mesh * glm::vec3(own, 1.0F);
    const int x = wrapped(uv.x, image->width, texture->wrap_s);
    const int y = wrapped(uv.y, image->height, texture->wrap_t);
    const std::uint8_t* const texel =
        &image->rgba[4 * (std::size_t(y) * std::size_t(image->width) + std::size_t(x))];
    return glm::vec4(texel[0], texel[1], texel[2], texel[3]) / 255.0F;
}

glm::vec4 PrimitiveLook::vertex_color_at(const TrianglePoint& point) const {
    const scenes::Primitive& primitive = *item->primitive;
    if (primitive.colors.empty()) return glm::vec4(1.0F);
    return blend<glm::vec4>(primitive.colors, primitive, point) / 65535.0F;
}

glm::vec3 PrimitiveLook::color_at(const TrianglePoint& point) const {
    const glm::vec3 vertex(vertex_color_at(point));
    if (material == nullptr) return vertex;
    const glm::vec4 texel = texel_at(point);
    const glm::vec3 linear(optics::linear_from_srgb(texel.r), optics::linear_from_srgb(texel.g),
                           optics::linear_from_srgb(texel.b));
    return glm::vec3(material->base_color) * vertex * (image != nullptr ? linear : glm::vec3(1.0F));
}

float PrimitiveLook::alpha_at(const TrianglePoint& point) const {
    const float own = material != nullptr ? material->base_color.a : 1.0F;
    return own * vertex_color_at(point).a * texel_at(point).a;
}

glm::dvec3 PrimitiveLook::normal_at(const TrianglePoint& point) const {
    const glm::dmat3 normal_from_mesh = glm::transpose(glm::inverse(glm::dmat3(item->world_from_mesh)));
    if (!item->normals.empty()) {
        const glm::dvec3 n =
            normal_from_mesh * glm::dvec3(blend<glm::vec3>(item->normals, *item->primitive, point));
        if (glm::length(n) > 1e-12) return glm::normalize(n);
    }
    const std::uint32_t* const corner = &item->primitive->indices[std::size_t(point.triangle) * 3];
    const auto world = [&](int i) { return item->world(corner[i]); };
    const glm::dvec3 n = glm::cross(world(1) - world(0), world(2) - world(0));
    return glm::length(n) > 0.0 ? glm::normalize(n) : glm::dvec3(0.0, 1.0, 0.0);
}

TracedScene::TracedScene(const scenes::Scene& scene, const scenes::Snapshot& snapshot)
    : device(rtcNewDevice(nullptr)) {
    const auto start = std::chrono::steady_clock::now();
    if (device == nullptr) throw Error(Fault::memory, "reference", "Embree cannot start");
    tree.reset(rtcNewScene(device.get()));
    if (!snapshot.bounds.empty()) {
        centre = 0.5 * (snapshot.bounds.low + snapshot.bounds.high);
        size = glm::length(snapshot.bounds.high - snapshot.bounds.low);
        if (!(size + glm::length(centre) <= optics::farthest_place))
            throw Error(Fault::input, "reference",
                        fmt::format("the scene reaches from {} to {}", shown(snapshot.bounds.low),
                                    shown(snapshot.bounds.high)),
                        fmt::format("rays reach {}: scale the scene down, or move it to the origin",
                                    optics::farthest_place));
    }
    looks.reserve(snapshot.items.size());
    std::size_t triangles = 0;
    for (const scenes::Item& item : snapshot.items) {
        if (item.primitive->topology != scenes::Topology::triangles || item.primitive->indices.empty())
            continue;
        add(item, looks.emplace_back(scene, item));
        first_triangle.push_back(std::uint32_t(triangles));
        triangles += item.primitive->element_count();
    }
    rtcCommitScene(tree.get());
    if (rtcGetDeviceError(device.get()) != RTC_ERROR_NONE) {
        throw Error(Fault::memory, "reference", "Embree cannot hold the triangles", "choose a smaller scene");
    }
    build_milliseconds = milliseconds_since(start);
}

void TracedScene::add(const scenes::Item& item, const PrimitiveLook& look) {
    const scenes::Primitive& primitive = *item.primitive;
    const EmbreeGeometry geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    auto* const vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), item.vertex_count()));
    auto* const indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), primitive.element_count()));
    if (vertices == nullptr || indices == nullptr) {
        throw Error(Fault::memory, "reference", "Embree cannot hold the triangles", "choose a smaller scene");
    }
    for (std::size_t i = 0; i < item.vertex_count(); ++i) {
        const glm::dvec3 world = item.world(i);
        for (int axis = 0; axis < 3; ++axis)
            vertices[3 * i + std::size_t(axis)] = float(world[axis] - centre[axis]);
    }
    std::copy(primitive.indices.begin(), primitive.indices.end(), indices);
    if (look.material != nullptr && look.material->alpha_mode == scenes::AlphaMode::mask) {
        rtcSetGeometryUserData(geometry.get(),
                               const_cast<PrimitiveLook*>(&look));  // Embree's type; only read
        rtcSetGeometryIntersectFilterFunction(geometry.get(), drop_holes);
        rtcSetGeometryOccludedFilterFunction(geometry.get(), drop_holes);
    }
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(tree.get(), geometry.get());
}

void set_ray(RTCRay& ray, const glm::vec3& origin, const glm::vec3& direction, float near, float far) {
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tnear = near;
    ray.tfar = far;
    ray.time = 0.0F;
    ray.mask = 0xFFFFFFFFU;
    ray.id = 0;
    ray.flags = 0;
}

PictureRays::PictureRays(const optics::Camera& camera, const optics::Light& light, const TracedScene& scene,
                         glm::ivec2 size)
    : light_(light),
      size_(size),
      eye_(camera.eye - scene.centre),
      centre_(scene.centre),
      gap_(float(1e-5 * scene.size)) {
    optics::check_camera(camera);
    optics::check_light(light);
    forward_ = glm::normalize(camera.target - camera.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward_, camera.up));
    const double half_height = std::tan(0.5 * camera.yfov);
    right_ = right * (half_height * size.x / size.y);
    up_ = glm::cross(right, forward_) * half_height;
}

glm::dvec3 PictureRays::direction(const glm::dvec2& place) const {
    const double across = 2.0 * place.x / size_.x - 1.0;
    const double above = 1.0 - 2.0 * place.y / size_.y;
    return glm::normalize(forward_ + across * right_ + above * up_);
}

glm::dvec3 PictureRays::towards_light(const glm::dvec3& point) const {
    return glm::normalize(light_.positional ? light_.position - centre_ - point : light_.towards);
}

void PictureRays::aim_at_light(RTCRay& ray, const glm::dvec3& point) const {
    const glm::dvec3 way = light_.positional ? light_.position - centre_ - point : light_.towards;
    const double length = glm::length(way);
    const float far = light_.positional ? float(length) : std::numeric_limits<float>::infinity();
    set_ray(ray, glm::vec3(point), glm::vec3(way / length), gap_, far);
}

}  // namespace cairn::reference
