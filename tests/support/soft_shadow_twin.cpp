#include "tests/support/soft_shadow_twin.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cairn::test {

using glm::dvec2;
using glm::dvec3;

LightTriangles in_light_space(const scenes::Snapshot& snapshot, const optics::Light& light) {
    const glm::dmat4 from_world = optics::light_from_world(light);
    LightTriangles triangles;
    for (const scenes::Item& item : snapshot.items) {
        const std::vector<std::uint32_t>& indices = item.primitive->indices;
        for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
            std::array<dvec3, 3>& triangle = triangles.emplace_back();
            for (std::size_t k = 0; k < 3; ++k)
                triangle[k] = dvec3(from_world * glm::dvec4(item.world(indices[i + k]), 1.0));
        }
    }
    return triangles;
}

DepthRange cast(const LightTriangles& triangles, const dvec2& tangents, double near_distance) {
    const dvec3 ray(tangents, 1.0);
    DepthRange range;
    for (const auto& [a, b, c] : triangles) {
        const double ab = glm::dot(ray, glm::cross(a, b));
        const double bc = glm::dot(ray, glm::cross(b, c));
        const double ca = glm::dot(ray, glm::cross(c, a));
        const bool inside = (ab >= 0.0 && bc >= 0.0 && ca >= 0.0) || (ab <= 0.0 && bc <= 0.0 && ca <= 0.0);
        const dvec3 normal = glm::cross(b - a, c - a);
        const double w = glm::dot(normal, ray) / glm::dot(normal, a);
        if (!inside || !(w > 0.0) || !(w * near_distance <= 1.0)) continue;
        range.closest = std::max(range.closest, w);
        range.furthest = range.furthest > 0.0 ? std::min(range.furthest, w) : w;
    }
    return range;
}

double hidden_by(const renderer::SoftShadowMap& map, const interop::MicroPatch& patch, int x, int y,
                 double receiver_inverse_depth) {
    if (!(receiver_inverse_depth > 0.0) || double(patch.inverse_depth) <= receiver_inverse_depth) return 0.0;
    const dvec2 half = optics::half_size(map.light());
    const renderer::ShadowWindow& from = map.frustum().occluders;
    const renderer::ShadowWindow& onto = map.frustum().receivers;
    const double patch_depth = 1.0 / double(patch.inverse_depth);
    const double depth = 1.0 / receiver_inverse_depth;
    const dvec2 texel(patch.texel & 0xFFFFU, patch.texel >> 16U);
    const dvec2 low =
        patch_depth * glm::mix(from.low, from.high, texel / double(map.options().occluder_size));
    const dvec2 high =
        patch_depth * glm::mix(from.low, from.high, (texel + 1.0) / double(map.options().occluder_size));
    const dvec2 receiver =
        depth * glm::mix(onto.low, onto.high, (dvec2(x, y) + 0.5) / double(map.options().receiver_size));
    // Projects from the receiver through the patch's plane onto the light's plane.
    const double scale = depth / (depth - patch_depth);
    const dvec2 covered = glm::min(receiver + (high - receiver) * scale, half) -
                          glm::max(receiver + (low - receiver) * scale, -half);
    if (covered.x <= 0.0 || covered.y <= 0.0) return 0.0;
    return covered.x * covered.y / (4.0 * half.x * half.y);
}

std::vector<double> twin_of(const renderer::SoftShadowMap& map) {
    const renderer::ShadowMapValues receivers = map.receiver_inverse_depths();
    const int pass_count = map.options().passes == renderer::ShadowPasses::two ? 2 : 1;
    std::vector<double> visible(receivers.values.size(), 1.0);
    for (int pass = 0; pass < pass_count; ++pass) {
        const renderer::ShadowMapValues occluders = map.occluder_inverse_depths(pass);
        std::vector<interop::MicroPatch> patches;
        for (int y = 0; y < occluders.size; ++y) {
            for (int x = 0; x < occluders.size; ++x) {
                const float w = occluders.at(x, y);
                if (w > 0.0F && w < float(SHADOW_NONE))
                    patches.push_back({unsigned(x) | unsigned(y) << 16U, w, 0, 0});
            }
        }
        for (int y = 0; y < receivers.size; ++y) {
            for (int x = 0; x < receivers.size; ++x) {
                double hidden = 0.0;
                for (const interop::MicroPatch& patch : patches)
                    hidden += hidden_by(map, patch, x, y, receivers.at(x, y));
                double& texel = visible[std::size_t(y * receivers.size + x)];
                texel = std::min(texel, std::clamp(1.0 - hidden, 0.0, 1.0));
            }
        }
    }
    return visible;
}

}  // namespace cairn::test
