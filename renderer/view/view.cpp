#include "renderer/view/view.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
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

namespace {

/// Point of a (0, 2)-sequence (Sobol 1967), in [0, 1).
glm::dvec2 sobol_point(int number) {
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    std::uint32_t x_bit = 0x80000000U;
    std::uint32_t y_bits = 0x80000000U;
    for (auto rest = std::uint32_t(number); rest != 0; rest >>= 1U, x_bit >>= 1U, y_bits ^= y_bits >> 1U) {
        if ((rest & 1U) == 0) continue;
        x ^= x_bit;
        y ^= y_bits;
    }
    return glm::dvec2(x, y) * 0x1p-32;
}

}  // namespace

glm::dvec2 sample_place(int sample, int count) {
    glm::dvec2 sum(0.0);
    for (int i = 0; i < count; ++i)
        sum += sobol_point(i);
    const glm::dvec2 middle = sum / double(count);
    // Of other numbers than powers of two, some points may have to come nearer to the middle to stay in the
    // pixel.
    glm::dvec2 farthest(0.0);
    for (int i = 0; i < count; ++i)
        farthest = glm::max(farthest, glm::abs(sobol_point(i) - middle));
    constexpr double most = 0.4999;
    const glm::dvec2 scale = most / glm::max(farthest, glm::dvec2(most));
    return 0.5 + scale * (sobol_point(sample) - middle);
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
    if (view.samples < 1 || view.samples > MAX_SAMPLES)
        fail(fmt::format("{} samples per pixel", view.samples), fmt::format("choose 1 to {}", MAX_SAMPLES));
    if (!glm::all(glm::greaterThanEqual(view.pixel_place, glm::dvec2(0.0))) ||
        !glm::all(glm::lessThan(view.pixel_place, glm::dvec2(1.0))))
        fail("rays that stand outside their pixels", "choose a place in [0, 1); 0.5 is the middle");
    optics::check_camera(view.camera);
    optics::check_light(view.light);
    check_shadow(view.shadow);
}

void check_one_ray(const View& view) {
    if (view.samples != 1 || view.pixel_place != glm::dvec2(0.5))
        fail("rays beside the middle of their pixels", "choose one sample, in the middle");
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
