#include "scenes/deform.h"

#include <cmath>

#include "scenes/snapshot.h"

namespace cairn::scenes {
namespace {

/// To length 1, or zero when it has none.
glm::vec3 unit(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0.0 && std::isfinite(length) ? glm::vec3(v / length) : glm::vec3(0.0F);
}

/// Carries normals where `m` carries points: the cofactors, which unlike the inverse exist for every matrix.
glm::dmat3 normal_matrix(const glm::dmat3& m) {
    const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    return glm::dot(cofactors[0], m[0]) < 0.0 ? -cofactors : cofactors;
}

void add_displacements(std::vector<glm::vec3>& vectors, const std::vector<glm::vec3>& displacements,
                       float weight) {
    if (displacements.size() != vectors.size()) return;  // the target leaves this attribute alone
    for (std::size_t i = 0; i < vectors.size(); ++i)
        vectors[i] += weight * displacements[i];
}

/// Adds four influences. @return whether any of them counts.
bool blend(glm::dmat4& sum, const SkinWeights& vertex, std::span<const glm::dmat4> matrices) {
    bool any = false;
    for (int c = 0; c < 4; ++c) {
        if (vertex.weights[c] == 0.0F) continue;
        sum += static_cast<double>(vertex.weights[c]) * matrices[vertex.joints[c]];
        any = true;
    }
    return any;
}

}  // namespace

DeformedVertices morph(const Primitive& primitive, std::span<const float> weights) {
    DeformedVertices result{primitive.positions, primitive.normals};
    const std::size_t count = std::min(weights.size(), primitive.morph_targets.size());
    for (std::size_t t = 0; t < count; ++t) {
        if (weights[t] == 0.0F || !std::isfinite(weights[t])) continue;
        add_displacements(result.positions, primitive.morph_targets[t].positions, weights[t]);
        add_displacements(result.normals, primitive.morph_targets[t].normals, weights[t]);
    }
    for (glm::vec3& normal : result.normals)
        normal = unit(normal);
    return result;
}

std::vector<glm::dvec3> skin(const Primitive& primitive, std::span<const glm::dmat4> world_from_mesh,
                             DeformedVertices& vertices) {
    std::vector<glm::dvec3> world;
    world.reserve(vertices.positions.size());
    for (std::size_t i = 0; i < vertices.positions.size(); ++i) {
        glm::dmat4 matrix(0.0);
        bool any = !primitive.skin.empty() && blend(matrix, primitive.skin[i], world_from_mesh);
        for (const auto& set : primitive.more_skin)
            any = blend(matrix, set[i], world_from_mesh) || any;
        if (!any) matrix = world_from_mesh[0];
        world.push_back(transform_point(matrix, vertices.positions[i]));
        if (!vertices.normals.empty())
            vertices.normals[i] = unit(normal_matrix(glm::dmat3(matrix)) * glm::dvec3(vertices.normals[i]));
    }
    return world;
}

}  // namespace cairn::scenes
