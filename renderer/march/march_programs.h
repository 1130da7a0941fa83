#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "gl/program_family.h"
#include "gl/shader_source.h"
#include "renderer/march/march_options.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/produce/content.h"

/// The programs of the ray-marcher, and the keys that select them.
namespace cairn::renderer {

/// What all programs of a marcher have in common.
struct MarchSetting {
    TreeShape shape;
    Channels channels = {};
    Traversal traversal = Traversal::mini_stack;
    TileQueries tile_queries = TileQueries::list;
    ContentProgram content = {};
};

enum class RayKind : std::uint8_t { primary, shadow };

/// What distinguishes the programs of a marcher: it depends on the frame and on the pass.
struct MarchVariant {
    RayKind rays = RayKind::primary;
    /// Rays ask for bricks on their way, and may take an ancestor's brick instead (PassKind).
    bool progressive = false;
    bool blended = false;    ///< rays see two mips of a brick
    bool meshes = false;     ///< there are meshes beside the voxels
    bool proxy = false;      ///< primary rays run only inside a proxy
    bool show_tree = false;  ///< primary rays show the tree instead of colours
    bool soft = false;       ///< shadow rays go to samples of the light
    bool cones = false;      ///< soft shadow rays are cones
    [[nodiscard]] auto operator<=>(const MarchVariant&) const = default;
};

/// The macros of a program. Each is always defined, whatever its value.
[[nodiscard]] gl::Defines defines(const MarchSetting& setting);
[[nodiscard]] gl::Defines defines(const MarchVariant& variant);

/// Every variant that a marcher of this setting may use.
[[nodiscard]] std::vector<MarchVariant> valid_variants(RayKind rays, const MarchSetting& setting);

[[nodiscard]] gl::ProgramFamily<MarchVariant> march_programs(const MarchSetting& setting,
                                                             const gl::ShaderSource& shaders);

}  // namespace cairn::renderer
