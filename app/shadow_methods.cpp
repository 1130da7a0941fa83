#include "app/shadow_methods.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "app/measure.h"
#include "app/progress.h"
#include "reference/area_light.h"
#include "reference/image.h"
#include "renderer/mesh/mesh_raster.h"
#include "renderer/soft_shadow.h"
#include "scenes/transform.h"

namespace cairn::app {
namespace {

/// A directional light stands in the truth as a sphere so many scene diagonals away.
constexpr double far_away = 1e5;
constexpr float embree_albedo = 0.8F;

/// What Embree found at the pixels of a picture.
struct Receivers {
    std::vector<std::size_t> pixels;  ///< those that can be shadowed
    std::vector<glm::dvec3> points, normals;
};

/// The plane of each triangle of a snapshot, in the order of ReferenceImage::primitive.
struct Faces {
    std::vector<glm::dvec3> normals;
    std::vector<int> nodes;
};
Faces faces_of(const scenes::Snapshot& snapshot) {
    Faces faces;
    for (const scenes::Item& item : snapshot.items) {
        if (item.primitive->topology != scenes::Topology::triangles) continue;
        const auto& indices = item.primitive->indices;
        const auto corner = [&](std::size_t i) {
            return scenes::transform_point(item.world_from_mesh, item.positions[indices[i]]);
        };
        for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
            const glm::dvec3 a = corner(i);
            const glm::dvec3 across = glm::cross(corner(i + 1) - a, corner(i + 2) - a);
            const double length = glm::length(across);
            faces.normals.push_back(length > 0.0 ? across / length : glm::dvec3(0.0));
            faces.nodes.push_back(item.node);
        }
    }
    return faces;
}

glm::dvec3 to_light(const renderer::Light& light, const glm::dvec3& point) {
    return glm::normalize(light.positional ? light.position - point : light.towards);
}

/// Row after row, through the pixels' centres.
class PixelRays {
public:
    explicit PixelRays(const renderer::View& view)
        : size_(view.width, view.height), forward_(glm::normalize(view.camera.target - view.camera.eye)) {
        const double half = std::tan(0.5 * view.camera.yfov);
        const glm::dvec3 right = glm::normalize(glm::cross(forward_, view.camera.up));
        up_ = glm::cross(right, forward_) * half;
        right_ = right * (half * view.width / view.height);
    }
    [[nodiscard]] glm::dvec3 direction(std::size_t pixel) const {
        const auto width = std::size_t(size_.x);
        const glm::dvec2 place = (glm::dvec2(double(pixel % width), double(pixel / width)) + 0.5) / size_;
        return glm::normalize(forward_ + (2.0 * place.x - 1.0) * right_ + (1.0 - 2.0 * place.y) * up_);
    }

private:
    glm::dvec2 size_;
    glm::dvec3 forward_, right_, up_;
};

Receivers receivers_of(const ShadowTask& task, const reference::ReferenceImage& seen) {
    const Faces faces = faces_of(task.shown);
    const PixelRays rays(task.view);
    Receivers found;
    for (std::size_t i = 0; i < seen.depth.size(); ++i) {
        const std::uint32_t face = seen.primitive[i];
        if (face == reference::ReferenceImage::no_primitive) continue;
        if (!task.receivers[std::size_t(faces.nodes[face])]) continue;
        const glm::dvec3 direction = rays.direction(i);
        const glm::dvec3 point = task.view.camera.eye + direction * double(seen.depth[i]);
        glm::dvec3 normal = faces.normals[face];
        if (glm::dot(normal, direction) > 0.0) normal = -normal;
        if (!(glm::dot(normal, to_light(task.view.light, point)) > 0.0)) continue;
        found.pixels.push_back(i);
        found.points.push_back(point);
        found.normals.push_back(normal);
    }
    return found;
}

reference::AreaLight area_light_of(const ShadowTask& task) {
    const renderer::Light& light = task.view.light;
    reference::AreaLight area;
    area.shape = reference::AreaLight::Shape::sphere;
    if (!light.positional) {
        const scenes::Bounds& bounds = task.shown.bounds;
        const double distance = far_away * glm::length(bounds.high - bounds.low);
        area.centre = 0.5 * (bounds.low + bounds.high) + distance * glm::normalize(light.towards);
        area.radius = distance * std::sin(light.angle);
        return area;
    }
    area.centre = light.position;
    area.radius = light.radius;
    if (light.shape != renderer::LightShape::sphere) {
        area.shape = light.shape == renderer::LightShape::disk ? reference::AreaLight::Shape::disk
                                                               : reference::AreaLight::Shape::rectangle;
        area.half_u = light.half_u;
        area.half_v = light.half_v;
    }
    return area;
}

/// Grey, shaded as the renderer shades: by the light's middle.
renderer::Image lit_image(const ShadowTask& task, const Receivers& receivers,
                          const std::vector<float>& shares, const reference::ReferenceImage& seen) {
    const renderer::View& view = task.view;
    renderer::Image image{view.width, view.height, std::vector<std::uint8_t>(4 * seen.depth.size(), 255)};
    const auto encoded = [](float linear) {
        const float c = std::clamp(linear, 0.0F, 1.0F);
        const float srgb = c <= 0.0031308F ? 12.92F * c : 1.055F * std::pow(c, 1.0F / 2.4F) - 0.055F;
        return std::uint8_t(std::lround(255.0F * srgb));
    };
    for (std::size_t i = 0; i < seen.depth.size(); ++i) {
        const bool is_there = std::isfinite(seen.depth[i]);
        for (std::size_t c = 0; c < 3; ++c)
            image.rgba[4 * i + c] =
                encoded(is_there ? embree_albedo * view.light.ambient : view.background[int(c)]);
    }
    for (std::size_t k = 0; k < receivers.pixels.size(); ++k) {
        const double facing = glm::dot(receivers.normals[k], to_light(view.light, receivers.points[k]));
        const float direct = float(facing) * shares[receivers.pixels[k]] * (1.0F - view.light.ambient);
        for (std::size_t c = 0; c < 3; ++c)
            image.rgba[4 * receivers.pixels[k] + c] = encoded(embree_albedo * (view.light.ambient + direct));
    }
    return image;
}

}  // namespace

ShadowResult shadow_by_voxels(const ShadowTask& task, const ShadowOptions& options) {
    const gl::ShaderSource& shaders = options.common.driver.shaders;
    renderer::Renderer renderer(task.input.scene, task.shown, options.view.tree, shaders);
    renderer.set_mix({.meshes = std::make_shared<renderer::MeshRaster>(task.input.scene, task.shown, shaders),
                      .mesh_shadows = true,
                      .meshes_are_voxelized = true,
                      .voxels_hidden = true});
    Progress progress("shadowing", options.common.report.quiet);
    ShadowResult result;
    result.image = renderer.render(task.view, [&](double share) { progress.set(share); });
    result.first_frame_ms = renderer.statistics().milliseconds;
    result.shares = renderer.light_shares(task.view).shares;
    result.milliseconds = renderer.statistics().milliseconds;
    return result;
}

ShadowResult shadow_by_map(const ShadowTask& task, const ShadowOptions& options) {
    renderer::SoftShadowRenderer renderer(task.input.scene, task.input.snapshot, task.occluders,
                                          task.receivers, options.map, options.common.driver.shaders);
    const renderer::Light& light = task.view.light;
    renderer::SoftShadowView view;
    view.width = task.view.width;
    view.height = task.view.height;
    view.camera = task.view.camera;
    view.light = {light.position, light.half_u, light.half_v};
    view.light_color = light.color;
    view.ambient = light.ambient;
    view.background = task.view.background;
    Stopwatch watch;
    renderer::SoftShadowPicture picture = renderer.render(view);
    const double first_ms = watch.lap_ms();
    picture = renderer.render(view);
    return {std::move(picture.image), std::move(picture.visible), renderer.map().statistics().milliseconds,
            first_ms};
}

ShadowResult shadow_by_embree(const ShadowTask& task, const ShadowOptions& options) {
    const Progress progress("tracing", options.common.report.quiet);
    const renderer::View& view = task.view;
    const renderer::Camera& camera = view.camera;
    Stopwatch watch;
    const reference::ImageTracer tracer(task.input.scene, task.shown);
    const reference::ReferenceImage seen = tracer.trace(
        {camera.eye, camera.target, camera.up, camera.yfov},
        {view.light.positional, view.light.position, view.light.towards}, view.width, view.height);
    const Receivers receivers = receivers_of(task, seen);
    ShadowResult result;
    result.milliseconds = seen.milliseconds;
    result.shares.assign(seen.depth.size(), -1.0F);
    if (task.is_soft) {
        Stopwatch sampling;
        const auto found = reference::area_light_visibility(
            tracer, receivers.points, receivers.normals, area_light_of(task),
            {.least_samples = options.truth_samples, .most_samples = options.truth_samples * 4});
        result.milliseconds = sampling.lap_ms();
        for (std::size_t k = 0; k < found.size(); ++k)
            result.shares[receivers.pixels[k]] = float(found[k].visible);
    } else {
        for (const std::size_t pixel : receivers.pixels)
            result.shares[pixel] = float(seen.lit[pixel]);
    }
    result.first_frame_ms = watch.lap_ms();
    result.image = lit_image(task, receivers, result.shares, seen);
    return result;
}

ShadowError error_of(const std::vector<float>& shares, const std::vector<float>& truth) {
    ShadowError error;
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        // Two rasterizers need not agree on what a pixel at an edge shows.
        if (truth[i] < 0.0F || shares[i] < 0.0F) continue;
        const double difference = double(shares[i]) - double(truth[i]);
        ++error.pixels;
        error.shadowed += truth[i] < 0.5F ? 1 : 0;
        error.too_light += truth[i] < 0.5F && shares[i] >= 0.5F ? 1 : 0;
        error.too_dark += truth[i] >= 0.5F && shares[i] < 0.5F ? 1 : 0;
        sum += std::abs(difference);
        squares += difference * difference;
        error.greatest = std::max(error.greatest, std::abs(difference));
    }
    if (error.pixels == 0) return error;
    error.mean_absolute = sum / double(error.pixels);
    error.rmse = std::sqrt(squares / double(error.pixels));
    return error;
}

renderer::Image difference_image(const ShadowResult& shadow, const std::vector<float>& truth) {
    renderer::Image image{shadow.image.width, shadow.image.height,
                          std::vector<std::uint8_t>(4 * truth.size(), 255)};
    for (std::size_t i = 0; i < truth.size(); ++i) {
        if (truth[i] < 0.0F || shadow.shares[i] < 0.0F) continue;
        const float difference = std::clamp(shadow.shares[i] - truth[i], -1.0F, 1.0F);
        const auto left = std::uint8_t(std::lround(255.0F * (1.0F - std::abs(difference))));
        image.rgba[4 * i + (difference < 0.0F ? 2 : 0)] = left;
        image.rgba[4 * i + 1] = left;
    }
    return image;
}

}  // namespace cairn::app
