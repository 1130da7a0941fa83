// The share of the light that reaches voxels that primary rays found, against hard shadows by Embree.

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "reference/image.h"
#include "renderer/renderer.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/test_scenes.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {
namespace {

using renderer::Renderer;
using renderer::View;

/// Normals of the triangles of a snapshot, in the order of ReferenceImage::primitive.
std::vector<glm::dvec3> plane_normals(const scenes::Snapshot& snapshot) {
    std::vector<glm::dvec3> normals;
    for (const scenes::Item& item : snapshot.items) {
        if (item.primitive->topology != scenes::Topology::triangles) continue;
        const auto& indices = item.primitive->indices;
        const auto corner = [&](std::size_t i) { return item.world(indices[i]); };
        for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
            const glm::dvec3 across = glm::cross(corner(i + 1) - corner(i), corner(i + 2) - corner(i));
            const double length = glm::length(across);
            normals.push_back(length > 0.0 ? across / length : glm::dvec3(0.0));
        }
    }
    return normals;
}

/// Figures of the pixels where both see something and the triangle faces the light by more than the
/// interpolated normals of these scenes differ from the triangle's.
struct Disagreement {
    int receivers = 0;
    int too_light = 0;
    int too_dark = 0;
    [[nodiscard]] double share() const { return double(too_light + too_dark) / std::max(receivers, 1); }
};

Disagreement disagreement_of(const scenes::Scene& scene, int size, int max_resolution) {
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    View view;
    view.size.width = view.size.height = size;
    view.camera = optics::framing_camera(snapshot.bounds, 1.0);
    const reference::ImageTracer tracer(scene, snapshot);
    const reference::ReferenceImage truth =
        tracer.trace({view.camera.eye, view.camera.target, view.camera.up, view.camera.yfov},
                     {view.light.positional, view.light.position, view.light.towards}, size, size);
    const std::vector<glm::dvec3> planes = plane_normals(snapshot);
    Renderer renderer = voxel_renderer(scene, snapshot, {.tree = {.max_resolution = max_resolution}});
    const std::vector<float> shares = renderer.light(view).light.shares;
    const glm::dvec3 to_light = glm::normalize(view.light.towards);
    Disagreement found;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const std::uint32_t face = truth.primitive[i];
        if (face == reference::ReferenceImage::no_primitive || shares[i] < 0.0F) continue;
        const glm::dvec3 forward = view.camera.target - view.camera.eye;  // near enough to the pixel's ray
        const glm::dvec3 normal = planes[face] * (glm::dot(planes[face], forward) > 0.0 ? -1.0 : 1.0);
        if (glm::dot(normal, to_light) < 0.1) continue;
        ++found.receivers;
        found.too_light += truth.lit[i] == 0 && shares[i] >= 0.5F ? 1 : 0;
        found.too_dark += truth.lit[i] != 0 && shares[i] < 0.5F ? 1 : 0;
    }
    return found;
}

class MarchedReceivers : public GlTest {};

TEST_F(MarchedReceivers, HardShadowsAgreeWithEmbreeAsFarAsVoxelsOfAPixelCanTell) {
    struct Case {
        const char* scene;
        double limit;  // share of wrong receivers
    };
    // Smooth and closed; flat, open and seen from behind; leaves of about a pixel, whose light changes within
    // a pixel: two rays of the same pixel disagree on a ninth of them.
    for (const Case& c : {Case{"knot", 0.03}, Case{"cornell", 0.015}, Case{"tree", 0.36}}) {
        const Disagreement found = disagreement_of(scenes::make_builtin(c.scene), 320, 512);
        const std::string text =
            fmt::format("{}: of {} receivers {:.2f}% wrong, {} too light, {} too dark", c.scene,
                        found.receivers, 100.0 * found.share(), found.too_light, found.too_dark);
        fmt::print("{}\n", text);
        EXPECT_GT(found.receivers, 5000) << text;
        EXPECT_LT(found.share(), c.limit) << text;
    }
}

TEST_F(MarchedReceivers, AFlatWallSeenFromBehindHasItsBackLit) {
    const scenes::Scene wall = sheet(glm::vec4(1.0F));
    Renderer renderer = voxel_renderer(wall, scenes::take_snapshot(wall), {.tree = {.max_resolution = 256}});
    for (const double degrees : {8.0, 12.0, 20.0, 45.0, 80.0}) {
        for (const double side : {1.0, -1.0}) {
            const double angle = degrees * 3.14159265358979 / 180.0;
            View view;
            view.size.width = view.size.height = 64;
            view.camera = {.eye = {4.0 * std::cos(angle), side * 4.0 * std::sin(angle), 0.3},
                           .target = {0.0, 0.0, 0.0},
                           .up = {0.0, 1.0, 0.0},
                           .yfov = 0.1};
            view.light.towards = {0.1, side, 0.2};
            const std::vector<float> shares = renderer.light(view).light.shares;
            int lit = 0;
            int dark = 0;
            for (const float share : shares) {
                lit += share >= 0.5F ? 1 : 0;
                dark += share >= 0.0F && share < 0.5F ? 1 : 0;
            }
            EXPECT_GT(lit, 200) << degrees << " degrees, side " << side;
            EXPECT_LE(dark, lit / 50) << degrees << " degrees, side " << side;
        }
    }
}

}  // namespace
}  // namespace cairn::test
