#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "gl/shader_source.h"
#include "optics/camera.h"
#include "optics/image.h"
#include "optics/light.h"
#include "renderer/march/tile_queries.h"
#include "renderer/march/transfer_function.h"
#include "renderer/march/traversal.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/produce/content.h"
#include "renderer/produce/volume_field.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"
#include "scenes/volume/volume.h"

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

/// The shape of the N^3-tree and the bounds of its caches (Crassin et al. 2008, section 4).
struct TreeOptions {
    int n = 4;   ///< children an axis: 2, 3, 4 or 8
    int m = 16;  ///< voxels of a brick an axis, without the border: 8, 16, 32 or 64; 27 or 81 with n = 3
    int max_resolution = 8192;  ///< voxels across the root cube that rays may ask for
    bool mips = false;  ///< bricks hold mip levels, for LevelOfDetail::blended; a fifth more memory. Of
                        ///< surfaces, not with n = 3
    /// Levels under the root, instead of max_resolution: for contents without a finest level. The finest
    /// voxels are at least 2^-60 of the root cube.
    std::optional<int> max_level = std::nullopt;
    std::size_t node_pool_bytes = 8U << 20U;
    std::size_t brick_pool_bytes = 256U << 20U;
    Traversal traversal = Traversal::mini_stack;
    /// Rays start where the tree says that there may be something, and none is made where there is nothing.
    /// The picture is the same without it, only slower.
    bool block_starts = true;
    /// Main memory for bricks that had to leave the pool, so that they need not be produced again; 0: none.
    std::size_t brick_cache_bytes = 0;
    /// Tiles that one pass of rays can ask for, [1, 65536]; the rest is asked for again by the next pass.
    int query_capacity = 65536;
    /// How rays ask for them. With blocks there are neither frames within a budget nor prefetching, which
    /// must know all that a frame has used.
    TileQueries tile_queries = TileQueries::list;
};

/// @throws Error (Fault::usage) for a shape that cannot work.
[[nodiscard]] TreeShape tree_shape_of(const TreeOptions& options);

/// Counters of one `render()`.
struct FrameStatistics {
    double milliseconds = 0.0;
    std::uint64_t rays_launched =
        0;           ///< of the pixel blocks that may see anything; with a proxy, of the pixels it covers
    int passes = 0;  ///< ray-marching passes; 0 where the picture was known without any
    std::uint64_t tile_queries = 0;  ///< misses that rays reported
    std::uint64_t query_bytes = 0;   ///< read back from the GPU to know them, and what rays used
    std::uint64_t nodes_subdivided = 0;
    std::uint64_t bricks_produced = 0;
    std::uint64_t constant_tiles = 0;  ///< of those: turned out to hold one value, and keep no brick
    std::uint64_t bricks_evicted = 0;
    std::uint64_t nodes_evicted = 0;
    std::uint64_t bricks_relinked = 0;    ///< still in the pool when their node came back
    std::uint64_t bricks_cached = 0;      ///< read back into main memory when they had to leave the pool
    std::uint64_t bricks_restored = 0;    ///< taken from main memory instead of produced
    std::uint64_t bricks_prefetched = 0;  ///< produced by prefetch() since the frame before
    double march_ms = 0.0;                ///< of `milliseconds`: rays
    double produce_ms = 0.0;              ///< of `milliseconds`: subdividing, producing, uploading
    double tree_ms = 0.0;                 ///< of `produce_ms`, by render(): neither bricks nor uploading
    /// Of `produce_ms`: sending to the GPU what is made or kept in main memory: nodes, volumes' bricks, and
    /// bricks that come back from there. What the GPU makes itself is not sent.
    double upload_ms = 0.0;
    bool converged = true;              ///< nothing was missing: the picture is that of render()
    std::uint64_t bricks_resident = 0;  ///< after the frame
    /// Of those, the ones that rays read, or that were produced, since render() or the first of the
    /// render_within() for this view began.
    std::uint64_t bricks_used = 0;
    std::uint64_t brick_slots = 0;    ///< the most that can be resident
    std::size_t node_pool_bytes = 0;  ///< what the two stores take, all of it, used or not
    std::size_t brick_pool_bytes = 0;
    std::size_t brick_cache_bytes = 0;  ///< what is kept in main memory now
};

/// What a call of Renderer::prefetch_finer() came to.
struct Prefetched {
    std::uint64_t bricks = 0;  ///< produced
    bool more = false;         ///< there may be more to produce; not once the pools are full
};

class MeshRaster;

/// What is drawn as triangles beside the voxels (renderer/mesh/mesh_raster.h), in the same world.
struct Mix {
    /// Shown where it is nearer than the voxels, and through what they leave uncovered; lit like them. A
    /// voxel counts as nearer when the middle of the ray's way through it is. Meshes cast no shadows.
    std::shared_ptr<MeshRaster> meshes = nullptr;
    bool mesh_shadows = false;  ///< voxels cast shadows on the meshes, when the view has shadows
    /// The meshes are (also) the voxelized scene: then voxels that touch the triangle at a pixel are its own,
    /// and cast no shadow on it. Else contact shadows begin at the triangle.
    bool meshes_are_voxelized = false;
    /// Only the meshes are shown; voxels do no more than cast shadows (Forest et al. 2009, section 3.1).
    bool voxels_hidden = false;
    /// Rays run only from its first to its last face, or from the eye where more of its faces turn their back
    /// to the eye than their front (which is so inside a closed mesh). Pixels that it does not cover launch
    /// no ray. A voxel shows when the ray's way through it reaches into the proxy. Shadow rays do not know
    /// it: what it hides still casts shadows (Crassin et al. 2008, section 5.4).
    std::shared_ptr<MeshRaster> proxy = nullptr;
};

/// Renders a scene, or a volume, through its voxel cache. Only what rays prove visible is voxelized, no finer
/// than a pixel shows. Bricks stay in the pools from one frame to the next. Needs the context that was
/// current at its construction.
///
/// The picture depends on the view (and the mix) alone: not on the pools' sizes, nor on what earlier frames
/// left in them. So the finished rows of the last view are kept (up to 64 MiB) and given again, without
/// marching, for as long as the view does not change.
class Renderer {
public:
    /// The scene and the snapshot are not needed afterwards.
    /// @throws Error  Fault::usage for a tree shape or a pool that cannot work; Fault::memory when it does
    /// not fit.
    Renderer(const scenes::Scene& scene, const scenes::Snapshot& snapshot, const TreeOptions& options = {},
             const gl::ShaderSource& shaders = {});
    /// A volume: its densities as the transfer function shows them, marched at the volume's own resolution,
    /// or `options.max_resolution` if that is coarser. The volume is not needed afterwards.
    /// @throws Error  as above; Fault::usage for VolumeOptions out of range.
    Renderer(const scenes::Volume& volume, const TransferFunction& transfer, const TreeOptions& options = {},
             const VolumeOptions& volume_options = {}, const gl::ShaderSource& shaders = {});
    /// A field of densities, made for the tree's n.
    Renderer(std::shared_ptr<const Field> field, const TransferFunction& transfer,
             const TreeOptions& options = {}, const VolumeOptions& volume_options = {},
             const gl::ShaderSource& shaders = {});

    /// Content made for tree_shape_of(options), which must be the options here.
    Renderer(std::unique_ptr<Content> content, const TreeOptions& options,
             const gl::ShaderSource& shaders = {});
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;
    ~Renderer();

    /// For all pictures from now on; an empty one for voxels alone.
    void set_mix(const Mix& mix);

    /// @param progress  called after each pass with the share of pixels that are done, in [0, 1].
    [[nodiscard]] optics::Image render(const View& view, const std::function<void(double)>& progress = {});

    /// Of the same rays what arrives of the light, instead of colours.
    /// @throws Error (Fault::usage) for volumes, whose light is not that of one place.
    [[nodiscard]] optics::LightShares light_shares(const View& view,
                                                   const std::function<void(double)>& progress = {});

    /// Renders what is there, and produces no longer than until `budget_ms` have passed since the call: first
    /// what most rays ask for. What is missing then is shown by the nearest ancestor that has a brick, or not
    /// at all. Rays are never cut short: a frame takes at least as long as marching it once.
    ///
    /// Called again for the same view, it goes on where it stopped, until the picture is that of render():
    /// statistics().converged. What it used for this view since the first of these calls it does not give up,
    /// so pools too small for the view leave some of it at a lower level of detail and come to rest.
    [[nodiscard]] optics::Image render_within(const View& view, double budget_ms);

    /// The same for some rows of the picture, which are those of the whole one, bit for bit: for a caller
    /// that has other things to do between them. The image is as high as there are rows.
    /// @throws Error (Fault::usage) when the picture does not have such rows.
    [[nodiscard]] optics::Image render_rows(const View& view, Rows rows);
    [[nodiscard]] optics::Image render_rows_within(const View& view, Rows rows, double budget_ms);

    /// Produces bricks for a view that may be asked for next, where it finds room that the last frame does
    /// not need, until `budget_ms` have passed. Changes no picture.
    /// @throws Error (Fault::usage) with TileQueries::blocks, as render_within() does.
    /// @return  bricks produced.
    std::uint64_t prefetch(const View& next, double budget_ms);

    /// The same for the last view one level finer, as it is needed by who comes nearer: some bands of its
    /// rows in each call, and only what finds room beside all that this view has used since it was first
    /// rendered. A call takes some milliseconds longer than `budget_ms`.
    Prefetched prefetch_finer(double budget_ms);

    /// The next frame is marched, whatever its view: for measurements.
    void forget_picture();

    /// Of the last `render()` or `render_within()`, whole or in rows.
    [[nodiscard]] const FrameStatistics& statistics() const;

private:
    struct Parts;
    /// Marches rows of a picture band by band; `march_band(row)` brings one to its end.
    /// @param shown  SHOW_* of shaders/interop/config.h.
    optics::Image march(const View& view, Rows rows, int shown, const std::function<void(int)>& march_band);
    std::unique_ptr<Parts> parts_;
};

}  // namespace cairn::renderer
