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

/// Which colour a pixel shows, lit and shadowed like the surface.
enum class Show : std::uint8_t {
    /// The surface's own colour.
    surface,
    /// The size of the voxels that the pixel shows, as the colour of their level: shown_level_color().
    levels,
    /// The surface's own colour, with lines in the level's colour where one brick meets the next.
    bricks,
};

/// The linear colour that stands for a level. Level 0 is the root's brick. Each level has voxels
/// TreeOptions::n times finer than the one before, and mips lie between two levels: with n = 4, level 1.5 has
/// voxels twice as fine as level 1.
[[nodiscard]] glm::vec3 shown_level_color(double level);

/// How the size of the voxels follows the width of a pixel's cone (Crassin et al. 2008, section 4.3). Both
/// kinds use the same bricks.
struct LevelOfDetail {
    enum class Kind : std::uint8_t {
        /// Rays see the voxels of the level whose size is nearest to the cone's width, by ratio: sharpest and
        /// cheapest, but a level pops in when the camera moves.
        nearest,
        /// Rays blend from one level to the next through the mips of a brick, so that no level pops in. Needs
        /// TreeOptions::mips.
        blended,
    };
    Kind kind = Kind::nearest;
    /// Size of a voxel on the screen that rays look for, in pixels: above 0.
    double pixel_error = 1.0;
    bool operator==(const LevelOfDetail&) const = default;
};

constexpr int MAX_SAMPLES = 256;

/// Place in its pixel of one of `count` samples, as View::pixel_place: the first points of a (0, 2)-sequence
/// (Sobol 1967), moved so that their middle is the pixel's. Of a power of two, each stands for an equal part
/// of the pixel; four are a rotated grid.
[[nodiscard]] glm::dvec2 sample_place(int sample, int count);

constexpr double MIN_SHADOW_PIXEL_ERROR = 1.0 / 64.0;
constexpr double MAX_SHADOW_PIXEL_ERROR = 64.0;

/// Which shadows a view has, and how finely they are sampled.
///
/// Limits of shadow rays, in voxels of the size that a shadow ray meets. (It meets their marks, of a quarter
/// of that size, and mostly stays far within these limits.)
/// - A shadow ends up to a voxel and a half beside its true edge.
/// - No light passes a sheet, however thin.
/// - A light nearer than a voxel and a half to a surface may be hidden by that surface, on either side.
/// - If an object stands on a receiver that is voxelized too, the shadow that the object's lowest 4 voxels
///   (2.5 on a mesh) cast by themselves may be missing: under a light that rises r per unit of way, 4 / r
///   voxels from the foot of a thin sheet.
/// - A closed box leaks light over 3 voxels (2 on a mesh) at most if the light stands 30 degrees high.
/// - A mesh that is not voxelized is shadowed from contact on.
struct ShadowQuality {
    enum class Kind : std::uint8_t {
        none,
        hard,  ///< one ray per pixel, to the middle of the light
        /// `samples` rays per pixel go to samples of the whole light, which are stratified and the same in
        /// every frame; a single ray goes to the middle of the light. In a volume the rays start at the depth
        /// before which half of what is seen lies. For several lights, add the shares of one view per light.
        rays,
        /// `samples` cones per pixel, each as wide as its share of the light. A cone reads coarser voxels the
        /// further it goes, and finds what several rays would find on average. A single cone covers all of
        /// the light. Not supported for volumes.
        cones,
    };
    Kind kind = Kind::hard;
    /// Rays or cones per pixel, in [1, MAX_SHADOW_RAYS]. Hard shadows do not read it.
    int samples = 64;
    /// Size of the voxels that a shadow ray meets, in units of the voxels that its pixel shows: above 1 the
    /// ray reads, and asks for, coarser data of its own. In [MIN_SHADOW_PIXEL_ERROR, MAX_SHADOW_PIXEL_ERROR].
    double pixel_error = 1.0;
    bool operator==(const ShadowQuality&) const = default;
};

/// What a picture shows. The picture depends on the view alone.
struct View {
    PictureSize size;
    optics::Camera camera;
    optics::Light light;
    ShadowQuality shadow;
    LevelOfDetail detail;
    Show show = Show::surface;
    /// Rays per pixel, in [1, MAX_SAMPLES]: a pixel is the mean of their colours, in linear light. They stand
    /// at sample_place(). Pictures of Renderer::render() without a budget alone take more than one.
    int samples = 1;
    /// Where a pixel's ray stands in the pixel, from its top left corner, in pixels: in [0, 1). Not read with
    /// more than one sample.
    glm::dvec2 pixel_place{0.5};
    /// Linear colour of pixels that show nothing else.
    glm::vec3 background{0.80F, 0.84F, 0.90F};
    /// If set, the camera and the light are not in world coordinates, but count from the low corner of this
    /// tile in units of the tile's side. So a view is exact however deep it is.
    std::optional<Tile> anchor = std::nullopt;
    bool operator==(const View&) const = default;
};

/// Some rows of a picture, from its top.
struct Rows {
    int first = 0;
    int count = 0;
    bool operator==(const Rows&) const = default;
};

/// Checks all fields of a view but its anchor, since a shader that meets a NaN draws a picture that nobody
/// can explain.
/// @throws Error (Fault::usage) that names the field and its range.
void check_view(const View& view);
/// Checks all fields of a view, and that the tree has the tile of its anchor.
/// @throws Error (Fault::usage) that names the field and its range.
void check_view(const View& view, const TreeShape& shape);

/// For renderers whose rays stand in the middle of their pixels.
/// @throws Error (Fault::usage) if the view asks for another place, or for several samples.
void check_one_ray(const View& view);

/// Does the view ask for shadows of more than the middle of the light?
[[nodiscard]] bool is_soft(const View& view);
/// Shadow rays or cones per pixel; 1 if is_soft() is false.
[[nodiscard]] int shadow_samples(const View& view);

/// A pixel of this colour alone, encoded as write_pixel() in shade.glsl encodes it.
[[nodiscard]] std::uint32_t background_pixel(const glm::vec3& linear);
/// Rows of a picture that shows nothing but the background.
[[nodiscard]] optics::Image background_image(const View& view, Rows rows);

}  // namespace cairn::renderer
