#include "renderer/view/view.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/error.h"
#include "shaders/interop/march.h"
#include "shaders/interop/shadow_rays.h"

namespace cairn::renderer {

static_assert(int(Show::surface) == SHOW_SURFACE && int(Show::levels) == SHOW_LEVELS &&
              int(Show::bricks) == SHOW_BRICKS);

glm::vec3 shown_level_color(double level) {
    const auto channel = [level](double phase) {
        return float(0.5 + 0.5 * std::cos(LEVEL_HUE * level + phase));
    };
    return {channel(LEVEL_PHASE_R), channel(LEVEL_PHASE_G), channel(LEVEL_PHASE_B)};
}

bool is_soft(const View& view) {
    return view.shadow == Shadow::hard && (view.shadow_rays > 1 || view.shadow_cones) &&
           optics::has_extent(view.light);
}

namespace {

void check_camera(const View& view) {
    const optics::Camera& camera = view.camera;
    auto fail = [](const std::string& what, const std::string& way_out) {
        throw Error(Fault::usage, "view", what, way_out);
    };
    if (view.width < 1 || view.height < 1 || view.width > 16384 || view.height > 16384) {
        fail(fmt::format("a picture of {} x {} pixels", view.width, view.height),
             "each side is between 1 and 16384");
    }
    if (!(camera.yfov > 0.0 && camera.yfov < 3.14159)) {
        fail("the field of view is not between 0 and 180 degrees", "45 degrees suit most scenes");
    }
    if (!(view.pixel_error > 0.0)) fail("the pixel error is not positive", "1 is the default");
    if (!(view.shadow_pixel_error >= 1.0 / 64.0 && view.shadow_pixel_error <= 64.0))
        fail("the pixel error of shadows is not between 1/64 and 64", "1 is the default");
    const glm::dvec3 forward = camera.target - camera.eye;
    const double length = glm::length(forward);
    if (!std::isfinite(length)) fail("the camera or its target is not finite", "use finite coordinates");
    if (length == 0.0) fail("the camera looks at where it stands", "move its target away from it");
    const double side = glm::length(glm::cross(forward / length, camera.up));
    if (!std::isfinite(side) || side < 1e-9) {
        fail("the camera's up direction is the one it looks along", "choose another up direction");
    }
    if (view.shadow_rays < 1 || view.shadow_rays > MAX_SHADOW_RAYS) {
        fail(fmt::format("{} shadow rays a pixel", view.shadow_rays),
             fmt::format("choose 1 to {}", MAX_SHADOW_RAYS));
    }
    if (!(view.light.radius >= 0.0) || !std::isfinite(view.light.radius))
        fail("the light's radius is negative or not finite", "0 is a point");
    if (!(view.light.angle >= 0.0 && view.light.angle < 1.5707))
        fail("the light's angle is not between 0 and 90 degrees", "the sun's is 0.27 degrees");
    if (!std::isfinite(glm::length(view.light.half_u)) || !std::isfinite(glm::length(view.light.half_v)))
        fail("the light's half axes are not finite", "use finite ones");
    const glm::dvec3 light = view.light.positional ? view.light.position : view.light.towards;
    if (!std::isfinite(glm::length(light)) || (!view.light.positional && glm::length(light) == 0.0)) {
        fail("the light has no direction", "give it a finite one that is not zero");
    }
}

void check_anchor(const std::optional<Tile>& anchor, const TreeShape& shape) {
    if (!anchor) return;
    const bool has_level = anchor->level >= 0 && anchor->level <= shape.max_level;
    const std::int64_t across = std::int64_t(1) << (has_level ? shape.n_shift() * anchor->level : 0);
    if (!has_level || glm::any(glm::lessThan(anchor->position, glm::i64vec3(0))) ||
        glm::any(glm::greaterThanEqual(anchor->position, glm::i64vec3(across)))) {
        throw Error(Fault::usage, "view", "the tree has no tile where the camera is anchored",
                    fmt::format("its levels are 0 to {}", shape.max_level));
    }
}

}  // namespace

void check_view(const View& view) {
    check_camera(view);
    if (view.anchor)
        throw Error(Fault::usage, "view", "the camera is anchored in a tree, and there is none",
                    "give it a place in the world");
}

void check_view(const View& view, const TreeShape& shape) {
    check_camera(view);
    check_anchor(view.anchor, shape);
}

std::uint32_t background_pixel(const glm::vec3& linear) {
    std::uint32_t pixel = 0;
    for (int channel = 0; channel < 3; ++channel) {
        const double c = std::clamp(double(linear[channel]), 0.0, 1.0);
        const double encoded = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
        pixel |= std::uint32_t(std::lround(255.0 * encoded)) << (8 * channel);
    }
    return pixel;
}

optics::Image background_image(const View& view, Rows rows) {
    optics::Image image{view.width, rows.count, {}};
    const std::uint32_t pixel = background_pixel(view.background);
    image.rgba.resize(std::size_t(view.width) * std::size_t(rows.count) * 4);
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        image.rgba[i] = std::uint8_t(pixel >> (8 * (i % 4)) & 0xFFU);
    return image;
}

}  // namespace cairn::renderer
