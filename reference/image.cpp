#include "reference/image.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "base/error.h"
#include "reference/embree.h"

namespace cairn::reference {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// The texel of an image that a coordinate falls on, by glTF's wrap modes.
int wrapped(double coordinate, int size, scenes::Wrap wrap) {
    if (wrap == scenes::Wrap::clamp_to_edge)
        return int(std::clamp(std::floor(coordinate * size), 0.0, size - 1.0));
    double unit = coordinate - std::floor(coordinate);
    const bool odd = std::fmod(std::abs(std::floor(coordinate)), 2.0) == 1.0;
    if (wrap == scenes::Wrap::mirrored_repeat && odd) unit = 1.0 - unit;
    return std::min(int(unit * size), size - 1);
}

/// A masked primitive, as its rays ask about it.
struct MaskedPrimitive {
    const scenes::Primitive* primitive = nullptr;
    const scenes::Material* material = nullptr;
    const scenes::Texture* texture = nullptr;  ///< or null
    const scenes::Image* image = nullptr;

    [[nodiscard]] bool is_surface(unsigned triangle, float u, float v) const {
        const std::uint32_t* const corner = &primitive->indices[std::size_t(triangle) * 3];
        const glm::vec3 weights(1.0F - u - v, u, v);
        const auto at = [&](const auto& values, auto zero) {
            for (int i = 0; i < 3; ++i)
                zero += weights[i] * decltype(zero)(values[corner[i]]);
            return zero;
        };
        float alpha = material->base_color.a;
        if (!primitive->colors.empty()) alpha *= at(primitive->colors, glm::vec4(0.0F)).a / 255.0F;
        if (image != nullptr) {
            const glm::vec2 own =
                primitive->texcoords.empty() ? glm::vec2(0.0F) : at(primitive->texcoords, glm::vec2(0.0F));
            const glm::vec3 uv = material->uv_from_mesh * glm::vec3(own, 1.0F);
            const int x = wrapped(uv.x, image->width, texture->wrap_s);
            const int y = wrapped(uv.y, image->height, texture->wrap_t);
            alpha *=
                float(image->rgba[4 * (std::size_t(y) * std::size_t(image->width) + std::size_t(x)) + 3]) /
                255.0F;
        }
        return alpha >= material->alpha_cutoff;
    }
};

void drop_holes(const RTCFilterFunctionNArguments* arguments) {
    const auto* const masked = static_cast<const MaskedPrimitive*>(arguments->geometryUserPtr);
    for (unsigned i = 0; i < arguments->N; ++i) {
        if (arguments->valid[i] == 0) continue;
        const unsigned triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
        const float u = RTCHitN_u(arguments->hit, arguments->N, i);
        const float v = RTCHitN_v(arguments->hit, arguments->N, i);
        if (!masked->is_surface(triangle, u, v)) arguments->valid[i] = 0;
    }
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

}  // namespace

struct ImageTracer::Parts {
    Parts(const scenes::Scene& scene, const scenes::Snapshot& snapshot) : device(rtcNewDevice(nullptr)) {
        const auto start = Clock::now();
        if (device == nullptr) throw Error(Fault::memory, "reference", "Embree cannot start");
        tree.reset(rtcNewScene(device.get()));
        if (!snapshot.bounds.empty()) {
            // Floats hold more of a point when they count from the middle of the scene.
            centre = 0.5 * (snapshot.bounds.low + snapshot.bounds.high);
            size = glm::length(snapshot.bounds.high - snapshot.bounds.low);
        }
        masked.reserve(snapshot.items.size());
        std::size_t triangles = 0;
        for (const scenes::Item& item : snapshot.items) {
            if (item.primitive->topology != scenes::Topology::triangles || item.primitive->indices.empty())
                continue;
            add(scene, item);
            first_triangle.push_back(std::uint32_t(triangles));
            triangles += item.primitive->element_count();
        }
        rtcCommitScene(tree.get());
        if (rtcGetDeviceError(device.get()) != RTC_ERROR_NONE) {
            throw Error(Fault::memory, "reference", "Embree cannot hold the triangles",
                        "choose a smaller scene");
        }
        build_milliseconds = milliseconds_since(start);
    }

    void add(const scenes::Scene& scene, const scenes::Item& item) {
        const scenes::Primitive& primitive = *item.primitive;
        const EmbreeGeometry geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
        auto* const vertices = static_cast<float*>(
            rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    3 * sizeof(float), item.positions.size()));
        auto* const indices = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(std::uint32_t), primitive.element_count()));
        if (vertices == nullptr || indices == nullptr) {
            throw Error(Fault::memory, "reference", "Embree cannot hold the triangles",
                        "choose a smaller scene");
        }
        for (std::size_t i = 0; i < item.positions.size(); ++i) {
            const glm::dvec3 world(item.world_from_mesh * glm::dvec4(item.positions[i], 1.0));
            for (int axis = 0; axis < 3; ++axis)
                vertices[3 * i + std::size_t(axis)] = float(world[axis] - centre[axis]);
        }
        std::copy(primitive.indices.begin(), primitive.indices.end(), indices);
        const scenes::Material* const material =
            primitive.material >= 0 ? &scene.materials[std::size_t(primitive.material)] : nullptr;
        if (material != nullptr && material->alpha_mode == scenes::AlphaMode::mask) {
            MaskedPrimitive& mask =
                masked.emplace_back(MaskedPrimitive{&primitive, material, nullptr, nullptr});
            if (material->texture >= 0) {
                mask.texture = &scene.textures[std::size_t(material->texture)];
                if (mask.texture->image >= 0) mask.image = &scene.images[std::size_t(mask.texture->image)];
            }
            rtcSetGeometryUserData(geometry.get(), &mask);
            rtcSetGeometryIntersectFilterFunction(geometry.get(), drop_holes);
            rtcSetGeometryOccludedFilterFunction(geometry.get(), drop_holes);
        }
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometry(tree.get(), geometry.get());
    }

    EmbreeDevice device;
    EmbreeScene tree;
    std::vector<MaskedPrimitive> masked;        ///< Embree points in here
    std::vector<std::uint32_t> first_triangle;  ///< of each geometry
    glm::dvec3 centre{0.0};
    double size = 1.0;
    double build_milliseconds = 0.0;
};

namespace {

/// One image's worth of rays.
class Rays {
public:
    Rays(const ReferenceCamera& camera, const ReferenceLight& light, const glm::dvec3& centre,
         double scene_size, ReferenceImage& image)
        : light_(light),
          eye_(camera.eye - centre),
          centre_(centre),
          gap_(float(1e-5 * scene_size)),
          image_(image) {
        forward_ = glm::normalize(camera.target - camera.eye);
        const glm::dvec3 right = glm::normalize(glm::cross(forward_, camera.up));
        const double half_height = std::tan(0.5 * camera.yfov);
        right_ = right * (half_height * image.width / image.height);
        up_ = glm::cross(right, forward_) * half_height;
    }

    void trace_row(RTCScene tree, const std::vector<std::uint32_t>& first_triangle, int y) const {
        for (int x = 0; x < image_.width; ++x) {
            const double across = (2.0 * x + 1.0) / image_.width - 1.0;
            const double above = 1.0 - (2.0 * y + 1.0) / image_.height;
            const glm::dvec3 direction = glm::normalize(forward_ + across * right_ + above * up_);
            RTCRayHit ray;
            set_ray(ray.ray, glm::vec3(eye_), glm::vec3(direction), 0.0F,
                    std::numeric_limits<float>::infinity());
            ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            intersect(tree, ray);
            if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
            const std::size_t pixel = std::size_t(y) * std::size_t(image_.width) + std::size_t(x);
            image_.depth[pixel] = ray.ray.tfar;
            image_.primitive[pixel] = first_triangle[ray.hit.geomID] + ray.hit.primID;
            image_.lit[pixel] = sees_light(tree, eye_ + direction * double(ray.ray.tfar)) ? 1 : 0;
        }
    }

private:
    [[nodiscard]] bool sees_light(RTCScene tree, const glm::dvec3& point) const {
        const glm::dvec3 way = light_.positional ? light_.position - centre_ - point : light_.towards;
        const double length = glm::length(way);
        const float far = light_.positional ? float(length) : std::numeric_limits<float>::infinity();
        RTCRay ray;
        set_ray(ray, glm::vec3(point), glm::vec3(way / length), gap_, far);
        occluded(tree, ray);
        return ray.tfar >= 0.0F;
    }

    const ReferenceLight& light_;
    glm::dvec3 eye_, centre_, forward_, right_, up_;
    float gap_;  ///< shadow rays start so far from the surface, not to meet it again
    ReferenceImage& image_;
};

}  // namespace

ImageTracer::ImageTracer(const scenes::Scene& scene, const scenes::Snapshot& snapshot)
    : parts_(std::make_unique<Parts>(scene, snapshot)) {}
ImageTracer::~ImageTracer() = default;

bool ImageTracer::blocked(const glm::dvec3& from, const glm::dvec3& to) const {
    const glm::dvec3 way = to - from;
    const double length = glm::length(way);
    const double gap = 1e-5 * parts_->size;
    if (!(length > 2.0 * gap)) return false;
    RTCRay ray;
    set_ray(ray, glm::vec3(from - parts_->centre), glm::vec3(way / length), float(gap), float(length - gap));
    occluded(parts_->tree.get(), ray);
    return ray.tfar < 0.0F;
}

double ImageTracer::build_milliseconds() const {
    return parts_->build_milliseconds;
}

ReferenceImage ImageTracer::trace(const ReferenceCamera& camera, const ReferenceLight& light, int width,
                                  int height, int threads) const {
    ReferenceImage image;
    image.width = width;
    image.height = height;
    const std::size_t pixels = std::size_t(width) * std::size_t(height);
    image.depth.assign(pixels, std::numeric_limits<float>::infinity());
    image.lit.assign(pixels, 0);
    image.primitive.assign(pixels, ReferenceImage::no_primitive);
    const Rays rays(camera, light, parts_->centre, parts_->size, image);
    tbb::task_arena arena(threads > 0 ? threads : int(tbb::task_arena::automatic));
    const auto start = Clock::now();
    arena.execute([&] {
        tbb::parallel_for(0, height,
                          [&](int y) { rays.trace_row(parts_->tree.get(), parts_->first_triangle, y); });
    });
    image.milliseconds = milliseconds_since(start);
    return image;
}

}  // namespace cairn::reference
