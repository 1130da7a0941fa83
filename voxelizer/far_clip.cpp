#include "voxelizer/far_clip.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "shaders/interop/config.h"

namespace cairn::voxelizer {
namespace {

constexpr double lattice_side = 1 << LATTICE_BITS;

struct Corner {
    glm::dvec3 position;
    glm::dvec2 texcoord;
    glm::dvec4 color;
};

Corner between(const Corner& a, const Corner& b, double t) {
    return {glm::mix(a.position, b.position, t), glm::mix(a.texcoord, b.texcoord, t),
            glm::mix(a.color, b.color, t)};
}

/// What lies at or below `limit` along an axis; at or above it where `sign` is -1.
std::vector<Corner> clip(const std::vector<Corner>& polygon, int axis, double sign, double limit) {
    std::vector<Corner> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Corner& from = polygon[i];
        const Corner& to = polygon[(i + 1) % polygon.size()];
        const double outside_from = sign * (from.position[axis] - limit);
        const double outside_to = sign * (to.position[axis] - limit);
        if (outside_from <= 0.0) kept.push_back(from);
        if ((outside_from < 0.0 && outside_to > 0.0) || (outside_from > 0.0 && outside_to < 0.0)) {
            kept.push_back(between(from, to, outside_from / (outside_from - outside_to)));
            kept.back().position[axis] = limit;
        }
    }
    return kept;
}

std::vector<Corner> clipped(const FarTriangle& triangle) {
    std::vector<Corner> polygon;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto bytes = std::bit_cast<glm::u8vec4>(triangle.colors[i]);
        polygon.push_back({glm::dvec3(triangle.positions[i]), glm::dvec2(triangle.texcoords[i]), bytes});
    }
    for (int axis = 0; axis < 3; ++axis) {
        polygon = clip(polygon, axis, 1.0, 2 * lattice_side);
        polygon = clip(polygon, axis, -1.0, -lattice_side);
    }
    return polygon;
}

void append(SurfaceChunk& chunk, const std::vector<Corner>& fan, std::uint32_t material) {
    const auto first = std::uint32_t(chunk.positions.size());
    for (const Corner& corner : fan) {
        const glm::ivec3 position(glm::round(corner.position));
        chunk.positions.push_back({position.x, position.y, position.z});
        const auto color = std::bit_cast<std::uint32_t>(glm::u8vec4(glm::round(corner.color)));
        chunk.attributes.push_back({0, color, glm::vec2(corner.texcoord)});
    }
    for (std::uint32_t i = 2; i < fan.size(); ++i)
        chunk.triangles.push_back({{first, first + i - 1, first + i, material}});
}

}  // namespace

SurfaceChunk clip_far_triangles(std::span<const FarTriangle> triangles) {
    SurfaceChunk chunk;
    for (const FarTriangle& triangle : triangles)
        append(chunk, clipped(triangle), triangle.material);
    return chunk;
}

}  // namespace cairn::voxelizer
