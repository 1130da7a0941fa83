#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "gl/shader_source.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::renderer {

/// A pinhole camera. Pixel (0, 0) is at the top left.
struct Camera {
    glm::dvec3 eye{0.0, 0.0, 1.0};
    glm::dvec3 target{0.0};
    glm::dvec3 up{0.0, 1.0, 0.0};
    double yfov = 0.785398163397448;  ///< radians, the whole angle, in (0, pi)
    bool operator==(const Camera&) const = default;
};

/// Looks at the whole of the bounds from the front, above and to the right.
[[nodiscard]] Camera framing_camera(const scenes::Bounds& bounds, double aspect);

/// One light, white by default.
struct Light {
    bool positional = false;
    glm::dvec3 position{0.0};            ///< world, when positional
    glm::dvec3 towards{0.4, 0.8, 0.45};  ///< direction to the light, when not
    glm::vec3 color{1.0F};
    float ambient = 0.25F;  ///< light from everywhere, as a share of the light's own
    bool operator==(const Light&) const = default;
};

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
    Camera camera;
    Light light;
    Shadow shadow = Shadow::hard;
    glm::vec3 background{0.80F, 0.84F, 0.90F};  ///< linear
    /// Size of a voxel on the screen, in pixels, that level_of_detail follows.
    double pixel_error = 1.0;
    LevelOfDetail level_of_detail = LevelOfDetail::nearest;
    Show show = Show::surface;
    bool operator==(const View&) const = default;
};

/// Some rows of a picture, from its top.
struct Rows {
    int first = 0;
    int count = 0;
};

/// The shape of the N^3-tree and the bounds of its caches (Crassin et al. 2008, section 4).
struct TreeOptions {
    int n = 4;                  ///< children an axis: 2 or 4
    int m = 16;                 ///< voxels of a brick an axis, without the border: 8, 16, 32 or 64
    int max_resolution = 8192;  ///< voxels across the root cube that rays may ask for
    bool mips = false;          ///< bricks hold mip levels, for LevelOfDetail::blended; a fifth more memory
    std::size_t node_pool_bytes = 8U << 20U;
    std::size_t brick_pool_bytes = 256U << 20U;
};

/// sRGB-encoded RGBA, row 0 at the top; alpha is the coverage by the scene (the background is already blended
/// in).
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;
};

/// Counters of one `render()`.
struct FrameStatistics {
    double milliseconds = 0.0;
    int passes = 0;                  ///< ray-marching passes until nothing was missing
    std::uint64_t tile_queries = 0;  ///< misses that rays reported
    std::uint64_t nodes_subdivided = 0;
    std::uint64_t bricks_produced = 0;
    std::uint64_t bricks_evicted = 0;
    std::uint64_t nodes_evicted = 0;
    double march_ms = 0.0;              ///< of `milliseconds`: rays
    double produce_ms = 0.0;            ///< of `milliseconds`: subdividing, producing, uploading
    bool converged = true;              ///< nothing was missing: the picture is that of render()
    std::uint64_t bricks_resident = 0;  ///< after the frame
    std::uint64_t brick_slots = 0;      ///< the most that can be resident
    std::size_t node_pool_bytes = 0;    ///< what the two stores take, all of it, used or not
    std::size_t brick_pool_bytes = 0;
};

/// Renders a scene through its voxel cache. Only what rays prove visible is voxelized, no finer than a pixel
/// shows. Bricks stay in the pools from one frame to the next. Needs the context that was current at its
/// construction.
///
/// The picture depends on the view alone: not on the pools' sizes, nor on what earlier frames left in them.
class Renderer {
public:
    /// The scene and the snapshot are not needed afterwards.
    /// @throws Error  Fault::usage for a tree shape or a pool that cannot work; Fault::memory when it does
    /// not fit.
    Renderer(const scenes::Scene& scene, const scenes::Snapshot& snapshot, const TreeOptions& options = {},
             const gl::ShaderSource& shaders = {});
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;
    ~Renderer();

    /// @param progress  called after each pass with the share of pixels that are done, in [0, 1].
    [[nodiscard]] Image render(const View& view, const std::function<void(double)>& progress = {});

    /// Renders what is there, and produces no longer than until `budget_ms` have passed since the call: first
    /// what most rays ask for. What is missing then is shown by the nearest ancestor that has a brick, or not
    /// at all. Rays are never cut short: a frame takes at least as long as marching it once.
    ///
    /// Called again for the same view, it goes on where it stopped, until the picture is that of render():
    /// statistics().converged. Pools too small for the view leave some of it at a lower level of detail.
    [[nodiscard]] Image render_within(const View& view, double budget_ms);

    /// The same for some rows of the picture, which are those of the whole one, bit for bit: for a caller
    /// that has other things to do between them. The image is as high as there are rows.
    /// @throws Error (Fault::usage) when the picture does not have such rows.
    [[nodiscard]] Image render_rows(const View& view, Rows rows);
    [[nodiscard]] Image render_rows_within(const View& view, Rows rows, double budget_ms);

    /// Of the last `render()` or `render_within()`.
    [[nodiscard]] const FrameStatistics& statistics() const;

private:
    struct Parts;
    /// Marches rows of a picture band by band; `march_band(row)` brings one to its end.
    Image march(const View& view, Rows rows, const std::function<void(int)>& march_band);
    std::unique_ptr<Parts> parts_;
};

}  // namespace cairn::renderer
