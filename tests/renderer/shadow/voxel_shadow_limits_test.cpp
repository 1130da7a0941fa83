// Cases in which shadow rays through voxels fail, or might. Each test asserts what renderer.h says about its
// case at View::shadow. Lengths are in voxels unless stated otherwise.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "reference/image.h"
#include "reference/shadow_truth.h"
#include "renderer/mesh/mesh_raster.h"
#include "renderer/mesh/mix.h"
#include "renderer/renderer.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/mesh_rays.h"
#include "tests/support/test_scenes.h"
#include "tests/support/voxel_renderer.h"
#include "voxelizer/grid.h"

namespace cairn::test {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::vec3;
using optics::LightShape;
using optics::LightShares;
using renderer::Renderer;
using renderer::View;
using Corners = std::vector<vec3>;

constexpr int picture_size = 112;  // pixels per side

/// A view straight down on the floor y = 0, so that a pixel is a point of the floor.
View from_above() {
    View view;
    view.size.width = view.size.height = picture_size;
    view.camera = {.eye = {0.0, 6.0, 0.0}, .target = {0.0, 0.0, 0.0}, .up = {0.0, 0.0, -1.0}, .yfov = 0.5};
    view.detail.pixel_error = 1e-6;
    return view;
}

View lit_along(const dvec3& towards) {
    View view = from_above();
    view.light.towards = towards;
    return view;
}

View lit_from(const dvec3& place) {
    View view = from_above();
    view.light.positional = true;
    view.light.position = place;
    return view;
}

View lit_by_square(const dvec3& middle, double half_x, double half_z, int rays) {
    View view = lit_from(middle);
    view.light.shape = optics::LightShape::rectangle;
    view.light.half_u = {half_x, 0.0, 0.0};
    view.light.half_v = {0.0, 0.0, half_z};
    view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = rays};
    return view;
}

Corners joined(std::initializer_list<Corners> parts) {
    Corners all;
    for (const Corners& part : parts)
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

Corners level(float half, float height) {
    return quad({-half, height, -half}, {-half, height, half}, {half, height, half}, {half, height, -half});
}

dvec3 floor_point(const View& view, int x, int y) {
    const PictureRays rays(view);
    const dvec3 direction = rays.direction({x + 0.5, y + 0.5});
    return rays.eye - direction * (rays.eye.y / direction.y);
}

/// Calls for every pixel with its point of the floor and its share of the light.
void each(const optics::LightShares& found, const View& view,
          const std::function<void(const dvec3&, double)>& judge) {
    for (int y = 0; y < view.size.height; ++y)
        for (int x = 0; x < view.size.width; ++x)
            judge(floor_point(view, x, y),
                  found.shares[std::size_t(y) * std::size_t(view.size.width) + std::size_t(x)]);
}

constexpr int resolution = 64;  // four bricks per axis

/// Voxels that shadow a floor that is a mesh of its own.
class VoxelsOverFloor {
public:
    explicit VoxelsOverFloor(const Corners& occluder)
        : occluder_(colored(occluder, glm::vec4(1.0F))),
          snapshot_(scenes::take_snapshot(occluder_)),
          tracer_(occluder_, snapshot_),
          renderer_(voxel_renderer(occluder_, snapshot_, {.tree = {.max_resolution = resolution}})),
          voxel_(voxelizer::grid_around(snapshot_.bounds, resolution).voxel_size) {
        renderer_.set_mix(
            {.meshes = std::make_shared<renderer::MeshRaster>(floor_, scenes::take_snapshot(floor_)),
             .mesh_shadows = true,
             .voxels_hidden = true});
    }

    [[nodiscard]] double voxel() const { return voxel_; }
    [[nodiscard]] optics::LightShares shares(const View& view) { return renderer_.light(view).light; }
    void each_pixel(const View& view, const std::function<void(const dvec3&, double)>& judge) {
        each(shares(view), view, judge);
    }
    /// The share of the view's light that the floor sees past the triangles, per pixel.
    [[nodiscard]] std::vector<double> truth(const View& view) const {
        std::vector<dvec3> points;
        for (int y = 0; y < view.size.height; ++y)
            for (int x = 0; x < view.size.width; ++x)
                points.push_back(floor_point(view, x, y));
        std::vector<double> seen;
        for (const reference::LightVisibility& there : reference::area_light_visibility(
                 tracer_, points, {}, view.light, {.standard_error = 0.01, .most_samples = 1024}))
            seen.push_back(there.visible);
        return seen;
    }

private:
    scenes::Scene occluder_;
    scenes::Snapshot snapshot_;
    reference::ImageTracer tracer_;
    scenes::Scene floor_ = colored(level(8.0F, 0.0F), glm::vec4(1.0F));
    Renderer renderer_;
    double voxel_;
};

class VoxelShadowLimits : public GlTest {};

// A sheet without thickness lets nothing through, at any angle, up to half a voxel before its edge; and one
// voxel past its edge its voxels end.
TEST_F(VoxelShadowLimits, ThinSheetsLetNoLightThrough) {
    for (const double degrees : {0.0, 10.0, 30.0, 45.0, 60.0, 80.0}) {
        const double tilt = degrees * 0.017453292519943295;
        const dvec3 across(std::cos(0.4), 0.0, std::sin(0.4));
        const dvec3 along(-std::sin(0.4), 0.0, std::cos(0.4));
        const vec3 u(0.5 * (std::cos(tilt) * across + dvec3(0.0, std::sin(tilt), 0.0)));
        const vec3 v(0.5 * along);
        const vec3 middle(0, 1, 0);
        VoxelsOverFloor scene(quad(middle - u - v, middle - u + v, middle + u + v, middle + u - v));
        int dark = 0;
        int lit = 0;
        scene.each_pixel(lit_along({0.0, 1.0, 0.0}), [&](const dvec3& p, double share) {
            const double inside = std::min(0.5 * std::cos(tilt) - std::abs(glm::dot(p, across)),
                                           0.5 - std::abs(glm::dot(p, along))) /
                                  scene.voxel();
            if (inside > 0.5) {
                EXPECT_EQ(share, 0.0) << degrees << " degrees, " << inside << " voxels inside";
                ++dark;
            } else if (inside < -1.5) {
                EXPECT_EQ(share, 1.0) << degrees << " degrees, " << -inside << " voxels outside";
                ++lit;
            }
        });
        EXPECT_GT(dark, 150) << degrees;
        EXPECT_GT(lit, 5000) << degrees;
    }
}

/// A point light over a level square: the shadow's edge is right to the voxels' size, as it is enlarged on
/// the floor.
void expect_shadow_of_square(VoxelsOverFloor& scene, const View& view, double height, double half) {
    const dvec3 light = view.light.position;
    const double enlarged = light.y / (light.y - height);
    const double doubt = 1.5 * scene.voxel() * enlarged;
    int dark = 0;
    scene.each_pixel(view, [&](const dvec3& p, double share) {
        const dvec2 crossing =
            dvec2(p.x, p.z) + (dvec2(light.x, light.z) - dvec2(p.x, p.z)) * (height / light.y);
        const double inside = half - std::max(std::abs(crossing.x), std::abs(crossing.y));
        if (std::abs(inside) * enlarged < doubt) return;
        EXPECT_EQ(share, inside > 0.0 ? 0.0 : 1.0) << "(" << p.x << ", " << p.z << "), light at " << light.y;
        dark += inside > 0.0 ? 1 : 0;
    });
    EXPECT_GT(dark, 500);
}

TEST_F(VoxelShadowLimits, PointLightCastsTheHardShadow) {
    VoxelsOverFloor scene(level(0.3F, 1.0F));
    View view = lit_from({0.1, 3.0, -0.05});
    view.light.radius = 0.0;
    view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = 64};
    expect_shadow_of_square(scene, view, 1.0, 0.3);
}

// Between two sheets, inside the grid: the one behind it shadows nothing.
TEST_F(VoxelShadowLimits, LightInsideTheGrid) {
    VoxelsOverFloor scene(joined({level(0.2F, 1.0F), level(0.5F, 2.0F)}));
    for (const double height : {1.5, 1.95})
        expect_shadow_of_square(scene, lit_from({0.02, height, 0.01}), 1.0, 0.2);
}

// Within some voxels of a surface, in the brick that holds it: above it all is dark, under it all is lit.
TEST_F(VoxelShadowLimits, LightInsideABrickThatIsNotEmpty) {
    VoxelsOverFloor scene(level(0.5F, 1.0F));
    for (const double voxels_off : {1.5, 2.0, 3.5, 7.0}) {
        for (const bool above : {true, false}) {
            const double height = 1.0 + (above ? voxels_off : -voxels_off) * scene.voxel();
            scene.each_pixel(lit_from({0.03, height, 0.02}), [&](const dvec3& p, double share) {
                ASSERT_EQ(share, above ? 0.0 : 1.0)
                    << "(" << p.x << ", " << p.z << "), light " << voxels_off << " voxels off";
            });
        }
    }
}

// The documented limit: a light within a voxel and a half of a surface may be hidden by that surface's own
// voxels, although it hangs under it. In the surface's plane it is hidden whole.
TEST_F(VoxelShadowLimits, LightThatTouchesItsCeilingIsHidden) {
    VoxelsOverFloor scene(level(0.5F, 2.0F));
    const auto sum_at = [&](double voxels_under) {
        double sum = 0.0;
        scene.each_pixel(lit_by_square({0.02, 2.0 - voxels_under * scene.voxel(), 0.01}, 0.2, 0.2, 16),
                         [&](const dvec3&, double share) { sum += share; });
        return sum / (picture_size * picture_size);
    };
    EXPECT_EQ(sum_at(0.0), 0.0);
    EXPECT_EQ(sum_at(1.5), 1.0);
    EXPECT_EQ(sum_at(-1.5), 0.0) << "on the other side";
}

// A ball of light that touches a sheet from below is seen, except for the part within that voxel and a half;
// and a square light's corner under the edge of a sheet that reaches past it is hidden where it is.
TEST_F(VoxelShadowLimits, LightThatTouchesItsOccluder) {
    VoxelsOverFloor scene(level(0.5F, 2.0F));
    View view = lit_from({0.0, 2.0 - 0.15, 0.0});
    view.light.radius = 0.15;
    view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = 64};
    const std::vector<double> truth = scene.truth(view);
    const optics::LightShares found = scene.shares(view);
    double sum = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        ASSERT_NEAR(found.shares[i], truth[i], 0.05) << "pixel " << i;
        sum += truth[i];
    }
    EXPECT_GT(sum, 0.9 * double(truth.size()));
    view.light.position.y = 2.0 + 0.15;
    for (const float share : scene.shares(view).shares)
        ASSERT_EQ(share, 0.0F) << "it lies on the sheet";
}

// An occluder that lies on the receiver, or in its plane, shadows it: contact shadows on a mesh that is not
// voxelized begin at the triangle.
TEST_F(VoxelShadowLimits, OccluderThatTouchesTheReceiver) {
    for (const float lift : {0.0F, 0.002F, 0.01F, 0.03F}) {
        VoxelsOverFloor scene(level(0.5F, lift));
        int dark = 0;
        scene.each_pixel(lit_along({0.0, 1.0, 0.0}), [&](const dvec3& p, double share) {
            const double inside = 0.5 - std::max(std::abs(p.x), std::abs(p.z));
            if (std::abs(inside) < 1.5 * scene.voxel()) return;
            EXPECT_EQ(share, inside > 0.0 ? 0.0 : 1.0) << "(" << p.x << ", " << p.z << "), lift " << lift;
            dark += inside > 0.0 ? 1 : 0;
        });
        EXPECT_GT(dark, 1000);
    }
}

/// A floor and an object on it, both voxelized. The floor is seen as voxels or as triangles.
class Standing {
public:
    Standing(const Corners& thing, bool as_mesh)
        : scene_(colored(joined({level(1.5F, 0.0F), thing}), glm::vec4(1.0F))),
          snapshot_(scenes::take_snapshot(scene_)),
          tracer_(scene_, snapshot_),
          renderer_(voxel_renderer(scene_, snapshot_, {.tree = {.max_resolution = 2 * resolution}})),
          voxel_(voxelizer::grid_around(snapshot_.bounds, 2 * resolution).voxel_size) {
        if (as_mesh) {
            renderer_.set_mix({.meshes = std::make_shared<renderer::MeshRaster>(scene_, snapshot_),
                               .mesh_shadows = true,
                               .meshes_are_voxelized = true,
                               .voxels_hidden = true});
        }
    }

    [[nodiscard]] double voxel() const { return voxel_; }
    /// Visits each pixel that shows the floor, except for the floor's last voxels: its point, share, and
    /// whether it is in shadow.
    void each_of_floor(const View& view, const std::function<void(const dvec3&, double, bool)>& judge) {
        each(renderer_.light(view).light, view, [&](const dvec3& p, double share) {
            if (std::max(std::abs(p.x), std::abs(p.z)) > 1.4 || blocked(p, view.camera.eye - p)) return;
            judge(p, share, blocked(p, view.light.towards));
        });
    }
    [[nodiscard]] bool blocked(const dvec3& point, const dvec3& way) const {
        const dvec3 from = point + dvec3(0.0, 1e-4, 0.0);
        return tracer_.blocked(from, from + 8.0 * glm::normalize(way));
    }
    /// Whether all points a voxel away are in shadow.
    [[nodiscard]] bool deep(const dvec3& point, const dvec3& way) const {
        for (int k = 0; k < 8; ++k) {
            const double angle = k * 0.7853981633974483;
            if (!blocked(point + voxel_ * dvec3(std::cos(angle), 0.0, std::sin(angle)), way)) return false;
        }
        return true;
    }

private:
    scenes::Scene scene_;
    scenes::Snapshot snapshot_;
    reference::ImageTracer tracer_;
    Renderer renderer_;
    double voxel_;
};

constexpr double contact_of_voxels = 3.0;  // the header's figures
constexpr double contact_of_meshes = 2.0;

// Contact: so far from the foot of the box that casts it, a shadow has begun.
TEST_F(VoxelShadowLimits, ContactOfABoxLeaksThreeVoxelsAtMost) {
    const dvec2 low(-0.3, -0.25);
    const dvec2 high(0.35, 0.3);
    const Corners box = box_corners({low.x, 0.0, low.y}, {high.x, 0.6, high.y});
    for (const bool as_mesh : {false, true}) {
        Standing scene(box, as_mesh);
        for (const dvec3 towards : {dvec3(0.1, 1.0, -1.0), dvec3(0.3, 0.6, -1.0), dvec3(1.0, 1.5, 0.2)}) {
            int dark = 0;
            double widest = 0.0;
            scene.each_of_floor(lit_along(towards), [&](const dvec3& p, double share, bool shadowed) {
                if (!shadowed || !scene.deep(p, towards)) return;
                ++dark;
                if (share < 0.5) return;
                const dvec2 at(p.x, p.z);
                const double off = glm::distance(at, glm::clamp(at, low, high)) / scene.voxel();
                widest = std::max(widest, off);
            });
            EXPECT_LE(widest, as_mesh ? contact_of_meshes : contact_of_voxels)
                << (as_mesh ? "mesh" : "voxels") << " towards (" << towards.x << ", " << towards.y << ", "
                << towards.z << ")";
            EXPECT_GT(dark, 200);
        }
    }
}

constexpr double foot_of_voxels = 4.0;  // the header's figures
constexpr double foot_of_meshes = 2.5;

/// The fence is a sheet that stands on the floor. Where the light meets it less than `foot` voxels over the
/// floor, the shadow may be missing; higher up it may not.
struct Fence {
    dvec3 left{-0.7, 0.0, 0.03};
    dvec3 right{0.7, 0.0, 0.11};
    double height = 0.5;
    [[nodiscard]] Corners corners() const {
        const dvec3 up(0.0, height, 0.0);
        return quad(vec3(left), vec3(right), vec3(right + up), vec3(left + up));
    }
    /// The height at which the ray from a point of the floor meets the fence's plane.
    [[nodiscard]] double crossing(const dvec3& point, const dvec3& way) const {
        const dvec3 normal = glm::cross(right - left, dvec3(0.0, 1.0, 0.0));
        return way.y * glm::dot(normal, left - point) / glm::dot(normal, way);
    }
};

/// The highest crossing, in voxels, that light went through, and the number of dark crossings.
std::pair<double, int> leak_of_fence(bool as_mesh, const dvec3& towards) {
    const Fence fence;
    Standing scene(fence.corners(), as_mesh);
    double highest = 0.0;
    int dark = 0;
    scene.each_of_floor(lit_along(towards), [&](const dvec3& p, double share, bool shadowed) {
        if (!shadowed || !scene.deep(p, towards)) return;
        if (share < 0.5)
            ++dark;
        else
            highest = std::max(highest, fence.crossing(p, towards) / scene.voxel());
    });
    return {highest, dark};
}

TEST_F(VoxelShadowLimits, ContactOfAThinFenceLeaksUnderItsLowestVoxels) {
    for (const dvec3 towards : {dvec3(0.1, 1.0, -1.0), dvec3(0.3, 0.5, -1.0)}) {
        for (const bool as_mesh : {false, true}) {
            const auto [highest, dark] = leak_of_fence(as_mesh, towards);
            RecordProperty(fmt::format("{}_{}", as_mesh ? "mesh" : "voxels", towards.y),
                           fmt::format("{:.2f} voxels, {} dark", highest, dark));
            EXPECT_LT(highest, as_mesh ? foot_of_meshes : foot_of_voxels) << "towards y = " << towards.y;
            EXPECT_GT(dark, 400);
        }
    }
}

// The lower the light, the wider that leak: the same lowest voxels, over the tangent of its elevation. The
// lit floor stays lit.
TEST_F(VoxelShadowLimits, GrazingLightLeaksUnderTheSameVoxels) {
    for (const double rise : {0.1, 0.05}) {
        const dvec3 towards(0.0, rise, -1.0);
        for (const bool as_mesh : {false, true}) {
            const auto [highest, dark] = leak_of_fence(as_mesh, towards);
            RecordProperty(fmt::format("{}_{}", as_mesh ? "mesh" : "voxels", rise),
                           fmt::format("{:.2f} voxels, {} dark", highest, dark));
            EXPECT_LT(highest, as_mesh ? foot_of_meshes : foot_of_voxels) << "rise " << rise;
            EXPECT_GT(dark, 20) << "rise " << rise;
            Standing scene(Fence().corners(), as_mesh);
            int lit = 0;
            scene.each_of_floor(lit_along(towards), [&](const dvec3& p, double share, bool shadowed) {
                if (shadowed || p.z > -0.1) return;  // the side of the light
                EXPECT_EQ(share, 1.0) << "(" << p.x << ", " << p.z << ")";
                ++lit;
            });
            EXPECT_GT(lit, 2000);
        }
    }
}

// One view has one light; the shares of several are those of as many views, added up. Two halves of a light
// are the whole; and two lights are what rays find of both.
TEST_F(VoxelShadowLimits, MoreThanOneLight) {
    VoxelsOverFloor scene(level(0.3F, 1.0F));
    const View whole = lit_by_square({0.0, 3.0, 0.0}, 0.4, 0.4, 128);
    const View left = lit_by_square({-0.2, 3.0, 0.0}, 0.2, 0.4, 128);
    const View right = lit_by_square({0.2, 3.0, 0.0}, 0.2, 0.4, 128);
    const optics::LightShares of_whole = scene.shares(whole);
    const optics::LightShares of_left = scene.shares(left);
    const optics::LightShares of_right = scene.shares(right);
    const std::vector<double> truth_left = scene.truth(left);
    const std::vector<double> truth_right = scene.truth(right);
    double squares = 0.0;
    int partly = 0;
    for (std::size_t i = 0; i < truth_left.size(); ++i) {
        const double sum = of_left.shares[i] + of_right.shares[i];
        const double truth = truth_left[i] + truth_right[i];
        ASSERT_NEAR(0.5 * sum, of_whole.shares[i], 0.06) << "pixel " << i;
        if (truth <= 0.0 || truth >= 2.0) continue;
        ++partly;
        squares += (sum - truth) * (sum - truth);
    }
    EXPECT_GT(partly, 1000);
    EXPECT_LT(std::sqrt(squares / partly), 0.04);
}

}  // namespace
}  // namespace cairn::test
