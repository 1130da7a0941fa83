#pragma once

#include <cstdint>
#include <optional>

#include <glm/glm.hpp>

#include "optics/camera.h"
#include "optics/image.h"
#include "optics/light.h"
#include "renderer/pool/tree_shape.h"

namespace cairn::renderer {

enum class Shadow : std::uint8_t { none, hard };

/// What stands in for the surface's own colour, lit and shadowed like it.
enum class Show : std::uint8_t {
    surface,  ///< nothing: the scene
    levels,   ///< the size of the voxels that a pixel shows, as a tree level: shown_level_color()
    bricks,   ///< the scene, and lines where it passes from one brick into the next, in the level's colour
};

/// Linear. Level 0 is the root's brick; each level has voxels TreeOptions::n times finer, and mips lie
/// between: with n = 4, level 1.5 has voxels twice as fine as level 1.
[[nodiscard]] glm::vec3 shown_level_color(double level);

/// How the size of the voxels follows the width of a pixel's cone (Crassin et al. 2008, section 4.3). Both
/// use the same bricks.
enum class LevelOfDetail : std::uint8_t {
    nearest,  ///< the voxels of the tree level that is nearest to it, by ratio: sharpest, cheapest, and it
              ///< pops
    blended,  ///< between a level and the next the brick's mips lead over: nothing pops. Needs
              ///< TreeOptions::mips
};

struct View {
    int width = 512;  ///< pixels, [1, 16384]
    int height = 512;
    optics::Camera camera;
    optics::Light light;
    Shadow shadow = Shadow::hard;
    glm::vec3 background{0.80F, 0.84F, 0.90F};  ///< linear
    /// Size of a voxel on the screen, in pixels, that level_of_detail follows.
    double pixel_error = 1.0;
    LevelOfDetail level_of_detail = LevelOfDetail::nearest;
    /// Size of the voxels that a shadow ray meets, in those that its pixel shows: above 1 it reads, and asks
    /// for, coarser data of its own. [1/64, 64]
    double shadow_pixel_error = 1.0;
    /// Rays a pixel to the light, [1, 512]: one goes to its middle, more to samples of all of it, which are
    /// stratified and the same in every frame. In a volume they leave from where half of what is seen lies.
    /// Shares of several lights are those of as many views, added up.
    ///
    /// Limits, in voxels as a shadow ray meets them: shadows end up to a voxel and a half beside the true
    /// edge, and no light passes a sheet, however thin. A light nearer than a voxel and a half to a surface
    /// may be hidden by it, on either side. Where something stands on a receiver that is voxelized too, the
    /// shadow that its lowest 4 voxels (2.5 on a mesh) cast by themselves may be missing: under a light that
    /// rises r a unit of way, 4 / r voxels from the foot of a thin sheet. A closed box leaks 3 (2 on a mesh)
    /// at most while the light stands 30 degrees high. A mesh that is not voxelized is shadowed from contact
    /// on.
    int shadow_rays = 1;
    /// The shadow rays are cones, each as wide as its share of the light: they read coarser voxels the
    /// further they go, and one takes what several rays would find on average. One cone sees all of the
    /// light. Not through volumes.
    bool shadow_cones = false;
    Show show = Show::surface;
    /// The camera and the light are told from this tile's low corner, in units of its side, instead of in the
    /// world: so a view is exact however deep it is.
    std::optional<Tile> anchor = std::nullopt;
    bool operator==(const View&) const = default;
};

/// Some rows of a picture, from its top.
struct Rows {
    int first = 0;
    int count = 0;
    bool operator==(const Rows&) const = default;
};

/// A camera that cannot be is a fault of the caller, and NaN in a shader is a picture that nobody can
/// explain.
/// @throws Error (Fault::usage) naming what is wrong, and its range. Without a tree's shape, an anchor is an
/// error too.
void check_view(const View& view, const TreeShape& shape);
void check_view(const View& view);

/// Does the view ask for shadows of more than the light's middle?
[[nodiscard]] bool is_soft(const View& view);

/// A pixel that shows nothing else, as write_pixel() in shade.glsl would encode it.
[[nodiscard]] std::uint32_t background_pixel(const glm::vec3& linear);
[[nodiscard]] optics::Image background_image(const View& view, Rows rows);

}  // namespace cairn::renderer
