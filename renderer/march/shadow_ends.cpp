#include "renderer/march/shadow_ends.h"

#include <algorithm>
#include <cmath>

#include "renderer/march/front_cells.h"
#include "shaders/interop/shadow_rays.h"

namespace cairn::renderer {
namespace {

using glm::dvec3;

/// Margin for the rounding of positions and of what is computed from them, as a share of the largest
/// coordinate.
constexpr double end_margin = 0x1p-20;

/// Side of the largest voxels that shadow rays of the view can meet: those at the far end of the root cube.
/// @param width  width of a shadow ray that starts on what is seen at distance 1.
double largest_voxel(const TreeShape& shape, const ConeOfSight& cone, double width) {
    const double root_side = double(shape.resolution());
    const double farthest = glm::length(glm::max(glm::abs(cone.eye), glm::abs(cone.eye - root_side)));
    double side = root_side / shape.m;
    for (int level = 0; level < shape.max_level && side > width * farthest; ++level)
        side /= shape.n;
    return cone.is_blended ? side * shape.n : side;  // of the coarsest mip
}

}  // namespace

ShadowEnds shadow_ends(const interop::MarchView& view, const Tree& tree, bool is_blended) {
    const TreeShape& shape = tree.shape();
    const double root_side = double(shape.resolution());
    const dvec3 to_light(view.light);
    const dvec3 axis = std::abs(to_light.y) < 0.9 ? dvec3(0.0, 1.0, 0.0) : dvec3(1.0, 0.0, 0.0);
    // The whole root cube, seen along the light, fits in a square of its diagonal.
    const double scale = SHADOW_ENDS_SIDE / (std::sqrt(3.0) * 1.01 * root_side);
    const dvec3 across = glm::normalize(glm::cross(to_light, axis)) * scale;
    const dvec3 down = glm::normalize(glm::cross(to_light, across)) * scale;
    const dvec3 centre(0.5 * root_side);
    ShadowEnds result;
    result.across = glm::vec3(across);
    result.across_offset = float(0.5 * SHADOW_ENDS_SIDE - glm::dot(across, centre));
    result.down = glm::vec3(down);
    result.down_offset = float(0.5 * SHADOW_ENDS_SIDE - glm::dot(down, centre));
    result.ends.assign(std::size_t(SHADOW_ENDS_SIDE) * SHADOW_ENDS_SIDE, -1e30F);

    const dvec3 forward(view.forward);
    const ConeOfSight cone{dvec3(view.eye) - double(view.skipped) * forward, double(view.pixel_cone),
                           is_blended};
    const double voxel =
        largest_voxel(shape, cone, cone.width * std::max(double(view.shadow_cone_scale), 1.0));
    const double slack = end_margin * root_side;
    const auto add = [&](const Box& box) {
        // A ray may meet the voxels of a coarser level there.
        const dvec3 low = glm::floor(box.low / voxel) * voxel - slack;
        const dvec3 high = glm::ceil(box.high / voxel) * voxel + slack;
        const dvec3 middle = 0.5 * (low + high);
        const dvec3 half = 0.5 * (high - low);
        const glm::dvec2 place(glm::dot(across, middle) + double(result.across_offset),
                               glm::dot(down, middle) + double(result.down_offset));
        const glm::dvec2 reach(glm::dot(glm::abs(across), half), glm::dot(glm::abs(down), half));
        // Clamped while they are doubles: an int cannot hold every one.
        constexpr double side = SHADOW_ENDS_SIDE;
        const glm::ivec2 first(glm::clamp(glm::floor(place - reach - 0.01), 0.0, side));
        const glm::ivec2 last(glm::clamp(glm::floor(place + reach + 0.01), -1.0, side - 1.0));
        const auto end =
            float((glm::dot(to_light, middle) + glm::dot(glm::abs(to_light), half)) + 2.0 * slack);
        for (int y = first.y; y <= last.y; ++y) {
            for (int x = first.x; x <= last.x; ++x) {
                float& texel = result.ends[std::size_t(y) * SHADOW_ENDS_SIDE + std::size_t(x)];
                texel = std::max(texel, end);
            }
        }
    };
    FrontCells(
        tree, cone, [](const Box&) { return true; }, add)
        .walk();
    return result;
}

}  // namespace cairn::renderer
