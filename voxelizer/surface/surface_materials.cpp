#include "voxelizer/surface/surface_materials.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <tuple>

#include "base/error.h"
#include "voxelizer/surface/texture_mips.h"

namespace cairn::voxelizer {
namespace {

constexpr std::uint32_t no_alpha_passes = 1U << 25;  // more than 255 * 255 * 256

std::uint32_t alpha_threshold(const scenes::Material& material) {
    const double cutoff = material.alpha_cutoff;
    if (!(cutoff > 0.0)) return 0;
    const double alpha = material.base_color.a;
    if (!(alpha > 0.0)) return no_alpha_passes;
    return std::uint32_t(
        std::min(std::round(cutoff / alpha * (255.0 * 255.0 * 256.0)), double(no_alpha_passes)));
}

/// The lowest texel alpha, 0 to 255, that passes for the highest vertex alpha.
std::uint32_t lowest_passing_alpha(std::uint32_t alpha_threshold) {
    return (alpha_threshold + 255 * 256 - 1) / (255 * 256);
}

/// Whether a triangle spans more texels than its mask could be read over; then the mask is finer than
/// anything.
bool spans_too_much(const std::array<glm::vec2, 3>& texcoords, const interop::SurfaceMaterial& material) {
    const glm::dvec2 low = glm::min(glm::min(texcoords[0], texcoords[1]), texcoords[2]);
    const glm::dvec2 high = glm::max(glm::max(texcoords[0], texcoords[1]), texcoords[2]);
    const glm::dvec2 texels = (high - low) * glm::dvec2(material.width, material.height);
    return std::max(texels.x, texels.y) > TEXEL_COORDINATE_LIMIT / 4;
}

}  // namespace

SurfaceMaterials::SurfaceMaterials(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                                   bool all_textures)
    : budget_(scene.placing.bytes), image_offsets_(scene.images.size(), -1), masks_(scene.materials.size()) {
    std::vector<bool> used(scene.materials.size());
    std::optional<glm::vec3> color;
    for (const scenes::Item& item : snapshot.items) {
        const int index = item.primitive->material;
        if (index >= 0) used[std::size_t(index)] = true;
        const glm::vec3 factor =
            index >= 0 ? glm::vec3(scene.materials[std::size_t(index)].base_color) : glm::vec3(1.0F);
        has_color = has_color || (color && *color != factor);
        color = factor;
    }
    uniform_color = color.value_or(glm::vec3(1.0F));
    interop::SurfaceMaterial white{};
    white.base_color = glm::vec4(1.0F);
    materials.push_back(white);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const scenes::Material& material = scene.materials[i];
        const bool masked = used[i] && material.alpha_mode == scenes::AlphaMode::mask;
        any_masked = any_masked || masked;
        has_color = has_color || (used[i] && material.texture >= 0);
        add_material(scene, material, used[i] && (masked || all_textures));
        if (masked) materials.back().flags |= 1U << MATERIAL_MASK_BIT;
    }
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        if ((materials[i + 1].flags >> MATERIAL_MASK_BIT & 1U) != 0) add_twin(i);
    }
    if (all_textures) add_mips();
}

void SurfaceMaterials::add_twin(std::size_t scene_material) {
    interop::SurfaceMaterial twin = materials[scene_material + 1];
    twin.flags &= ~(1U << MATERIAL_MASK_BIT);
    Mask& mask = masks_[scene_material];
    mask.twin = std::uint32_t(materials.size());
    materials.push_back(twin);
    if (twin.width == 0) return;
    std::tie(mask.lowest_alpha, mask.highest_alpha) = alpha_range(twin);
    // Thresholds between the same two steps of 8 bits let the same texels pass.
    const auto [counts, is_new] =
        passing_offsets_.try_emplace({twin.texel_offset, lowest_passing_alpha(twin.alpha_threshold)});
    if (is_new) counts->second = add_passing_counts(twin);
    materials[scene_material + 1].passing_offset = counts->second;
}

std::pair<std::uint32_t, std::uint32_t> SurfaceMaterials::alpha_range(
    const interop::SurfaceMaterial& material) {
    const auto [range, is_new] = alpha_ranges_.try_emplace(material.texel_offset);
    if (!is_new) return range->second;
    const auto first = texels.begin() + material.texel_offset;
    const auto [low, high] =
        std::minmax_element(first, first + std::ptrdiff_t(material.width) * material.height,
                            [](std::uint32_t a, std::uint32_t b) { return a >> 24 < b >> 24; });
    range->second = {*low >> 24, *high >> 24};
    return range->second;
}

std::uint32_t SurfaceMaterials::add_passing_counts(const interop::SurfaceMaterial& material) {
    const std::size_t stride = std::size_t(material.width) + 1;
    const std::uint32_t offset = grow_texels(stride * (std::size_t(material.height) + 1));
    for (std::size_t y = 0; y < material.height; ++y) {
        const std::uint32_t* const row = &texels[material.texel_offset + y * material.width];
        const std::uint32_t* const above = &texels[offset + y * stride];
        std::uint32_t* const below = &texels[offset + (y + 1) * stride];
        std::uint32_t passing = 0;
        for (std::size_t x = 0; x < material.width; ++x) {
            passing += (row[x] >> 24) * 255 * 256 >= material.alpha_threshold ? 1 : 0;
            below[x + 1] = above[x + 1] + passing;
        }
    }
    return offset;
}

void SurfaceMaterials::add_mips() {
    for (interop::SurfaceMaterial& material : materials) {
        const glm::ivec2 size(material.width, material.height);
        if (size.x == 0 || size == glm::ivec2(1)) continue;
        const bool masked = (material.flags >> MATERIAL_MASK_BIT & 1U) != 0;
        const std::uint32_t lowest = masked ? lowest_passing_alpha(material.alpha_threshold) : 0;
        const auto [mips, is_new] = mip_offsets_.try_emplace({material.texel_offset, lowest});
        if (is_new) {
            mips->second = grow_texels(mip_texels(size));
            const std::span<const std::uint32_t> image(
                &texels[material.texel_offset], std::size_t(material.width) * std::size_t(material.height));
            std::ranges::copy(mips_of(image, size, lowest), texels.begin() + mips->second);
        }
        material.mip_offset = mips->second;
    }
}

std::uint32_t SurfaceMaterials::grow_texels(std::size_t count) {
    const std::size_t offset = texels.size();
    budget_.charge("images", "the texels and mip levels of its pictures and the counts of its masks", count,
                   sizeof(texels[0]));
    if (offset + count > std::numeric_limits<std::uint32_t>::max()) {
        throw Error(Fault::memory, "images", "the images of the scene hold too many texels",
                    "use smaller images");
    }
    texels.resize(offset + count);
    return std::uint32_t(offset);
}

void SurfaceMaterials::add_material(const scenes::Scene& scene, const scenes::Material& material,
                                    bool textured) {
    interop::SurfaceMaterial out{};
    out.base_color = material.base_color;
    out.alpha_cutoff = material.alpha_cutoff;
    out.alpha_threshold = alpha_threshold(material);
    if (textured && material.texture >= 0) {
        const scenes::Texture& texture = scene.textures[std::size_t(material.texture)];
        const scenes::Image* const image =
            texture.image >= 0 ? &scene.images[std::size_t(texture.image)] : nullptr;
        if (image != nullptr && image->width > 0 && image->height > 0) {
            out.texel_offset = place_image(*image, texture.image);
            out.width = std::uint32_t(image->width);
            out.height = std::uint32_t(image->height);
            out.flags = std::uint32_t(texture.wrap_s) << MATERIAL_WRAP_S_SHIFT | std::uint32_t(texture.wrap_t)
                                                                                     << MATERIAL_WRAP_T_SHIFT;
        }
    }
    materials.push_back(out);
}

std::uint32_t SurfaceMaterials::place_image(const scenes::Image& image, int index) {
    std::int64_t& offset = image_offsets_[std::size_t(index)];
    if (offset < 0) {
        const std::size_t count = std::size_t(image.width) * std::size_t(image.height);
        offset = grow_texels(count);
        std::memcpy(&texels[std::size_t(offset)], image.rgba.data(), count * 4);
    }
    return std::uint32_t(offset);
}

bool SurfaceMaterials::is_masked(int scene_material) const {
    return scene_material >= 0 && masks_[std::size_t(scene_material)].twin != 0;
}

Shown SurfaceMaterials::shown(int scene_material, const std::array<glm::vec2, 3>& texcoords,
                              const std::array<std::uint16_t, 3>& alphas) const {
    if (!is_masked(scene_material)) return Shown::whole;
    const Mask& mask = masks_[std::size_t(scene_material)];
    const interop::SurfaceMaterial& material = materials[std::size_t(scene_material) + 1];
    const auto [lowest, highest] = std::ranges::minmax(alphas);
    const std::uint64_t threshold = std::uint64_t(material.alpha_threshold) * 257;
    if (std::uint64_t(mask.highest_alpha) * highest * 256 < threshold) return Shown::nothing;
    if (std::uint64_t(mask.lowest_alpha) * lowest * 256 >= threshold) return Shown::whole;
    return spans_too_much(texcoords, material) ? Shown::whole : Shown::cut;
}

std::uint32_t SurfaceMaterials::number(int scene_material, Shown shown) const {
    if (is_masked(scene_material) && shown == Shown::whole) return masks_[std::size_t(scene_material)].twin;
    return std::uint32_t(scene_material + 1);
}

}  // namespace cairn::voxelizer
