#pragma once

#include <cstdint>
#include <optional>

#include <glm/glm.hpp>

#include "optics/camera.h"
#include "optics/image.h"
#include "optics/light.h"
#include "renderer/pool/tree_shape.h"

namespace cairn::renderer {

/// The largest side of a viewport that OpenGL 4.5 promises.
constexpr int MAX_PICTURE_SIDE = 16384;

/// Width and height of a picture, in pixels: each in [1, MAX_PICTURE_SIDE].
struct PictureSize {
    int width = 512;
    int height = 512;
    /// Width over height.
    [[nodiscard]] double aspect() const { return double(width) / height; }
    bool operator==(const PictureSize&) const = default;
};

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
/// kinds use the same bricks.
struct LevelOfDetail {
    enum class Kind : std::uint8_t {
        /// The voxels of the tree level whose size is nearest to the cone's, by ratio: sharpest and cheapest,
        /// but a level pops in when the camera moves.
        nearest,
        /// Between one level and the next the brick's mips lead over, so that no level pops in. Needs
        /// TreeOptions::mips.
        blended,
    };
    Kind kind = Kind::nearest;
    /// Size of a voxel on the screen that rays look for, in pixels: above 0.
    double pixel_error = 1.0;
    bool operator==(const LevelOfDetail&) const = default;
};

constexpr double MIN_SHADOW_PIXEL_ERROR = 1.0 / 64.0;
constexpr double MAX_SHADOW_PIXEL_ERROR = 64.0;

/// Which shadows a view has, and how finely they are sampled.
///
/// Limits of shadow rays, in voxels as a shadow ray meets them: shadows end up to a voxel and a half beside
/// the true edge, and no light passes a sheet, however thin. A light nearer than a voxel and a half to a
/// surface may be hidden by that surface, on either side. Where something stands on a receiver that is
/// voxelized too, the shadow that its lowest 4 voxels (2.5 on a mesh) cast by themselves may be missing:
/// under a light that rises r per unit of way, 4 / r voxels from the foot of a thin sheet. A closed box leaks
/// 3 voxels (2 on a mesh) at most while the light stands 30 degrees high. A mesh that is not voxelized is
/// shadowed from contact on.
struct ShadowQuality {
    enum class Kind : std::uint8_t {
        none,
        hard,  ///< one ray per pixel, to the light's middle
        /// `samples` rays per pixel to samples of the whole light, which are stratified and the same in every
        /// frame; 1 ray goes to the light's middle. In a volume the rays leave from where half of what is
        /// seen lies. The shares of several lights are the sum of as many views.
        rays,
        /// The rays are cones, each as wide as its share of the light: they read coarser voxels the further
        /// they go, and one cone takes what several rays would find on average. 1 cone sees all of the light.
        /// Not through volumes.
        cones,
    };
    Kind kind = Kind::hard;
    /// Rays or cones per pixel, in [1, MAX_SHADOW_RAYS]; hard shadows do not read it.
    int samples = 64;
    /// Size of the voxels that a shadow ray meets, in units of the voxels that its pixel shows: above 1 the
    /// ray reads, and asks for, coarser data of its own. In [MIN_SHADOW_PIXEL_ERROR, MAX_SHADOW_PIXEL_ERROR].
    double pixel_error = 1.0;
    bool operator==(const ShadowQuality&) const = default;
};

struct View {
    PictureSize size;
    optics::Camera camera;
    optics::Light light;
    ShadowQuality shadow;
    LevelOfDetail detail;
    Show show = Show::surface;
    /// Linear.
    glm::vec3 background{0.80F, 0.84F, 0.90F};
    /// The camera and the light are given from this tile's low corner, in units of the tile's side, instead
    /// of in the world: so a view is exact however deep it is.
    std::optional<Tile> anchor = std::nullopt;
    bool operator==(const View&) const = default;
};

/// Some rows of a picture, from its top.
struct Rows {
    int first = 0;
    int count = 0;
    bool operator==(const Rows&) const = default;
};

/// Checks what needs no tree: NaN in a shader is a picture that nobody can explain.
/// @throws Error (Fault::usage) that names the field and its range.
void check_view(const View& view);
/// Checks the anchor too.
/// @throws Error (Fault::usage) that names the field and its range.
void check_view(const View& view, const TreeShape& shape);

/// Does the view ask for shadows of more than the light's middle?
[[nodiscard]] bool is_soft(const View& view);
/// Shadow rays, or cones, that a pixel of the view starts; 1 where is_soft() is false.
[[nodiscard]] int shadow_samples(const View& view);

/// A pixel that shows nothing else, as write_pixel() in shade.glsl would encode it.
[[nodiscard]] std::uint32_t background_pixel(const glm::vec3& linear);
[[nodiscard]] optics::Image background_image(const View& view, Rows rows);

}  // namespace cairn::renderer
