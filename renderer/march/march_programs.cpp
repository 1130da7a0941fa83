#include "renderer/march/march_programs.h"

#include <array>

#include "gl/program.h"
#include "shaders/interop/march.h"

namespace cairn::renderer {
namespace {

static_assert(int(Traversal::restart) == TRAVERSAL_RESTART &&
              int(Traversal::stackless) == TRAVERSAL_STACKLESS &&
              int(Traversal::mini_stack) == TRAVERSAL_MINI_STACK);

std::string flag(bool value) {
    return value ? "1" : "0";
}

void append(gl::Defines& to, const gl::Defines& more) {
    to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

gl::Defines defines(const MarchSetting& setting) {
    gl::Defines out = setting.shape.defines(setting.channels.color);
    append(out, {{"PACKED", flag(setting.channels.packed)},
                 {"TRAVERSAL", std::to_string(int(setting.traversal))},
                 {"TILE_BLOCKS", flag(setting.tile_queries == TileQueries::blocks)},
                 {"HAS_CONSTANT", flag(setting.content.has_constant)},
                 {"HAS_FINAL", flag(setting.content.has_final)},
                 {"VOLUME_STEPS", std::to_string(setting.content.volume_steps)}});
    return out;
}

gl::Defines defines(const MarchVariant& variant) {
    gl::Defines out = {{"PROGRESSIVE", flag(variant.progressive)},
                       {"BLENDED", flag(variant.blended)},
                       {"WITH_MESHES", flag(variant.meshes)}};
    if (variant.rays == RayKind::primary) {
        append(out, {{"WITH_PROXY", flag(variant.proxy)}, {"SHOW_TREE", flag(variant.show_tree)}});
    } else {
        append(out, {{"SOFT_SHADOWS", flag(variant.soft)}, {"SHADOW_CONES", flag(variant.cones)}});
    }
    return out;
}

std::vector<MarchVariant> valid_variants(RayKind rays, const MarchSetting& setting) {
    const bool is_primary = rays == RayKind::primary;
    std::vector<MarchVariant> valid;
    for (unsigned bits = 0; bits < 32; ++bits) {
        const std::array<bool, 5> on = {(bits & 1U) != 0, (bits & 2U) != 0, (bits & 4U) != 0,
                                        (bits & 8U) != 0, (bits & 16U) != 0};
        const MarchVariant variant{.rays = rays,
                                   .progressive = on[0],
                                   .blended = on[1],
                                   .meshes = on[2],
                                   .proxy = is_primary && on[3],
                                   .show_tree = is_primary && on[4],
                                   .soft = !is_primary && on[3],
                                   .cones = !is_primary && on[4]};
        if (variant.progressive && setting.tile_queries == TileQueries::blocks) continue;
        if (variant.blended && setting.shape.mips == 0) continue;
        if (variant.cones && !(variant.soft && setting.content.is_surface())) continue;
        valid.push_back(variant);
    }
    return valid;
}

gl::ProgramFamily<MarchVariant> march_programs(const MarchSetting& setting, const gl::ShaderSource& shaders) {
    return gl::ProgramFamily<MarchVariant>([common = defines(setting), primary = setting.content.primary,
                                            shadow = setting.content.shadow,
                                            shaders](const MarchVariant& variant) {
        gl::Defines all = common;
        append(all, defines(variant));
        return gl::build_compute(shaders, variant.rays == RayKind::primary ? primary : shadow, all);
    });
}

}  // namespace cairn::renderer
