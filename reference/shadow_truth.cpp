#include "reference/shadow_truth.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/clock.h"
#include "reference/light_cache.h"
#include "reference/traced_scene.h"
#include "scenes/snapshot.h"

namespace cairn::reference {
namespace {

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
        const auto corner = [&](std::size_t i) { return item.world(indices[i]); };
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

/// Row after row, through the pixels' centres.
class PixelRays {
public:
    PixelRays(const optics::Camera& camera, int width, int height)
        : size_(width, height), forward_(glm::normalize(camera.target - camera.eye)) {
        const double half = std::tan(0.5 * camera.yfov);
        const glm::dvec3 right = glm::normalize(glm::cross(forward_, camera.up));
        up_ = glm::cross(right, forward_) * half;
        right_ = right * (half * width / height);
    }
    [[nodiscard]] glm::dvec3 direction(std::size_t pixel) const {
        const auto width = std::size_t(size_.x);
        const std::size_t row = pixel / width;
        const glm::dvec2 place = (glm::dvec2(double(pixel % width), double(row)) + 0.5) / size_;
        return glm::normalize(forward_ + (2.0 * place.x - 1.0) * right_ + (1.0 - 2.0 * place.y) * up_);
    }

private:
    glm::dvec2 size_;
    glm::dvec3 forward_, right_, up_;
};

double ratio(double sum, std::size_t count) {
    return count == 0 ? 0.0 : sum / double(count);
}

}  // namespace

ShadowReceivers shadow_receivers(const ImageTracer& tracer, const ShadowQuestion& question) {
    ShadowReceivers found;
    found.seen = tracer.trace(question.camera, question.light, question.width, question.height);
    const Faces faces = faces_of(question.snapshot);
    const PixelRays rays(question.camera, question.width, question.height);
    for (std::size_t i = 0; i < found.seen.depth.size(); ++i) {
        const std::uint32_t face = found.seen.primitive[i];
        if (face == ReferenceImage::no_primitive) continue;
        if (!question.receivers[std::size_t(faces.nodes[face])]) continue;
        const glm::dvec3 direction = rays.direction(i);
        const glm::dvec3 point = question.camera.eye + direction * double(found.seen.depth[i]);
        glm::dvec3 normal = faces.normals[face];
        if (glm::dot(normal, direction) > 0.0) normal = -normal;
        if (!(glm::dot(normal, optics::direction_to(question.light, point)) > 0.0)) continue;
        found.pixels.push_back(i);
        found.points.push_back(point);
        found.normals.push_back(normal);
    }
    return found;
}

std::vector<float> shares_of(const ShadowReceivers& receivers, std::span<const float> values) {
    std::vector<float> shares(receivers.seen.depth.size(), -1.0F);
    for (std::size_t k = 0; k < values.size(); ++k)
        shares[receivers.pixels[k]] = values[k];
    return shares;
}

std::vector<float> hard_shares(const ShadowReceivers& receivers) {
    std::vector<float> values;
    values.reserve(receivers.pixels.size());
    for (const std::size_t pixel : receivers.pixels)
        values.push_back(float(receivers.seen.lit[pixel]));
    return shares_of(receivers, values);
}

SoftShares soft_shares(const ImageTracer& tracer, const ShadowQuestion& question,
                       const ShadowReceivers& receivers, const AreaLightOptions& options,
                       const std::optional<std::filesystem::path>& cache) {
    std::optional<LightCache> kept;
    std::optional<std::vector<LightVisibility>> found;
    if (cache) {
        kept.emplace(*cache, hash_of({question.scene, question.snapshot, receivers.points, receivers.normals,
                                      question.light, options}));
        found = kept->load(receivers.points.size());
    }
    SoftShares result;
    result.cached = found.has_value();
    if (!found) {
        const auto start = std::chrono::steady_clock::now();
        found = area_light_visibility(tracer, receivers.points, receivers.normals, question.light, options);
        result.milliseconds = milliseconds_since(start);
        if (kept) kept->save(*found);
    }
    std::vector<float> values;
    values.reserve(found->size());
    for (const LightVisibility& point : *found) {
        values.push_back(float(point.visible));
        result.greatest_standard_error = std::max(result.greatest_standard_error, point.standard_error);
    }
    result.shares = shares_of(receivers, values);
    return result;
}

double ShadowError::disagreement() const {
    return ratio(double(too_light + too_dark), pixels);
}
double ShadowError::mean_absolute() const {
    return ratio(absolute_sum, pixels);
}
double ShadowError::rmse() const {
    return std::sqrt(ratio(square_sum, pixels));
}
double ShadowError::mean_in_shadow() const {
    return ratio(absolute_sum, in_shadow);
}

ShadowError shadow_error(std::span<const float> shares, std::span<const float> truth) {
    ShadowError error;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        if (truth[i] < 0.0F || shares[i] < 0.0F) continue;
        const double difference = double(shares[i]) - double(truth[i]);
        ++error.pixels;
        error.shadowed += truth[i] < 0.5F ? 1 : 0;
        error.too_light += truth[i] < 0.5F && shares[i] >= 0.5F ? 1 : 0;
        error.too_dark += truth[i] >= 0.5F && shares[i] < 0.5F ? 1 : 0;
        error.in_shadow += truth[i] < 1.0F ? 1 : 0;
        error.absolute_sum += std::abs(difference);
        error.square_sum += difference * difference;
        error.greatest = std::max(error.greatest, std::abs(difference));
    }
    return error;
}

}  // namespace cairn::reference
