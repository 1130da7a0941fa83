#include "renderer/view/view.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/error.h"
#include "optics/srgb.h"
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
    using Kind = ShadowQuality::Kind;
    const ShadowQuality& shadow = view.shadow;
    const bool samples_light =
        shadow.kind == Kind::cones || (shadow.kind == Kind::rays && shadow.samples > 1);
    return samples_light && optics::has_extent(view.light);
}

int shadow_samples(const View& view) {
    return is_soft(view) ? view.shadow.samples : 1;
}

namespace {

[[noreturn]] void fail(const std::string& what, const std::string& way_out) {
    throw Error(Fault::usage, "view", what, way_out);
}

void check_shadow(const ShadowQuality& shadow) {
    if (shadow.samples < 1 || shadow.samples > MAX_SHADOW_RAYS) {
        fail(fmt::format("{} shadow rays per pixel", shadow.samples),
             fmt::format("choose 1 to {}", MAX_SHADOW_RAYS));
    }
    if (!(shadow.pixel_error >= MIN_SHADOW_PIXEL_ERROR && shadow.pixel_error <= MAX_SHADOW_PIXEL_ERROR)) {
        fail(
            fmt::format("a pixel error of shadows of {}", shadow.pixel_error),
            fmt::format("choose {} to {}; 1 is the default", MIN_SHADOW_PIXEL_ERROR, MAX_SHADOW_PIXEL_ERROR));
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
    const auto& [width, height] = view.size;
    if (width < 1 || height < 1 || width > MAX_PICTURE_SIDE || height > MAX_PICTURE_SIDE) {
        fail(fmt::format("a picture of {} x {} pixels", width, height),
             fmt::format("choose 1 to {} pixels per side", MAX_PICTURE_SIDE));
    }
    if (!(view.detail.pixel_error > 0.0)) {
        fail(fmt::format("a pixel error of {}", view.detail.pixel_error),
             "choose more than 0 pixels; 1 is the default");
    }
    optics::check_camera(view.camera);
    optics::check_light(view.light);
    check_shadow(view.shadow);
}

void check_view(const View& view, const TreeShape& shape) {
    check_view(view);
    check_anchor(view.anchor, shape);
}

std::uint32_t background_pixel(const glm::vec3& linear) {
    const glm::u8vec3 encoded = optics::srgb8_from_linear(linear);
    return std::uint32_t(encoded.r) | std::uint32_t(encoded.g) << 8U | std::uint32_t(encoded.b) << 16U;
}

optics::Image background_image(const View& view, Rows rows) {
    optics::Image image{view.size.width, rows.count, {}};
    const std::uint32_t pixel = background_pixel(view.background);
    image.rgba.resize(std::size_t(view.size.width) * std::size_t(rows.count) * 4);
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        image.rgba[i] = std::uint8_t(pixel >> (8 * (i % 4)) & 0xFFU);
    return image;
}

}  // namespace cairn::renderer
