#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "gl/program_family.h"
#include "gl/shader_source.h"
#include "renderer/march/tile_queries.h"
#include "renderer/march/traversal.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/produce/content_program.h"

/// The programs of the ray-marcher, and what tells them apart.
namespace cairn::renderer {

/// What all programs of a marcher have in common.
struct MarchSetting {
    TreeShape shape;
    bool has_color = false;
    Traversal traversal = Traversal::mini_stack;
    TileQueries tile_queries = TileQueries::list;
    ContentProgram content = {};
};

enum class RayKind : std::uint8_t { primary, shadow };

/// What a program can do beside that: it depends on the frame and on the pass.
struct MarchVariant {
    RayKind rays = RayKind::primary;
    bool progressive = false;  ///< rays ask for bricks on their way, and may take what stands in (PassKind)
    bool blended = false;      ///< rays see two mips of a brick
    bool meshes = false;       ///< there are meshes beside the voxels
    bool proxy = false;        ///< primary rays: they run inside a proxy alone
    bool show_tree = false;    ///< primary rays: they show the tree in place of colours
    bool soft = false;         ///< shadow rays: they go to samples of the light
    bool cones = false;        ///< soft shadow rays: they are cones
    [[nodiscard]] auto operator<=>(const MarchVariant&) const = default;
};

/// The macros of a program. All of them are always there, whatever their value.
[[nodiscard]] gl::Defines defines(const MarchSetting& setting);
[[nodiscard]] gl::Defines defines(const MarchVariant& variant);

/// Every variant that a marcher of this setting may ask for.
[[nodiscard]] std::vector<MarchVariant> valid_variants(RayKind rays, const MarchSetting& setting);

[[nodiscard]] gl::ProgramFamily<MarchVariant> march_programs(const MarchSetting& setting,
                                                             const gl::ShaderSource& shaders);

}  // namespace cairn::renderer
