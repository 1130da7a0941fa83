#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "gl/program.h"
#include "renderer/march/march_options.h"
#include "renderer/march/march_programs.h"
#include "renderer/march/query_buffer.h"
#include "renderer/march/tile_blocks.h"
#include "renderer/pool/brick_pool.h"
#include "renderer/pool/round.h"
#include "renderer/pool/tree.h"
#include "renderer/produce/content.h"
#include "renderer/produce/tile_query.h"
#include "shaders/interop/march.h"
#include "shaders/interop/windows.h"

namespace cairn::renderer {

/// What rays do if a tile is missing.
enum class PassKind : std::uint8_t {
    /// A ray waits for the tile that it asks for.
    patient,
    /// A ray waits for the tile that it asks for. It also asks for the bricks of the nodes that it passes.
    progressive,
    /// No ray waits: the brick of the nearest ancestor stands in for the tile.
    stand_in,
};

/// What one pass of rays reported.
struct PassResult {
    /// Primary rays that missed a tile or paused.
    std::uint32_t waiting_primary = 0;
    /// Shadow rays that missed a tile, paused, or have not started.
    std::uint32_t waiting_shadow = 0;
    /// Missing tiles that an ancestor stood in for.
    std::uint32_t stood_in = 0;
    /// Primary rays that began. The first pass of a part begins them all, unless there is a proxy.
    std::uint32_t launched = 0;
    /// Tile queries, each once. Patient passes do not count the rays that ask.
    std::vector<TileQuery> queries;
    /// The last round whose rays used the brick, one per slot.
    std::vector<std::uint32_t> brick_stamps;
    /// Bytes read back from the GPU for this result.
    std::size_t bytes_read = 0;
    [[nodiscard]] bool done() const { return waiting_primary == 0 && waiting_shadow == 0; }
};

/// What the rays of a band meet beside voxels: textures whose rows include those of the band
/// (renderer/mesh/mesh_raster.h).
struct MixTextures {
    GLuint mesh_nearest = 0;  ///< MeshSurface::nearest; 0: no meshes
    GLuint mesh_surface = 0;  ///< MeshSurface::surface
    int mesh_first_row = 0;   ///< the picture's row that is row 0 of the mesh textures
    bool voxels_hidden = false;
    bool mesh_shadows = false;  ///< voxels cast shadows on meshes
    /// Voxels whose centres are at most this far above a mesh, in voxel sides, cast no shadow on it.
    float mesh_self_shadow_height = 0.0F;
    GLuint proxy_span = 0;    ///< MeshSpan::span; 0: no proxy
    GLuint proxy_faces = 0;   ///< MeshSpan::faces
    int proxy_first_row = 0;  ///< the picture's row that is row 0 of the proxy textures
};

/// The ray-marching passes of one frame: the ray states, the lists of rays that must go on, and the tile
/// query buffer (Crassin et al. 2008, sections 5.1 to 5.3).
class Marcher {
public:
    /// @throws Error (Fault::usage) if the query capacity is out of range.
    Marcher(const TreeShape& shape, Channels channels, const MarchOptions& options,
            const gl::ShaderSource& shaders, ContentProgram content = {});

    /// Rows of a picture that are marched at once: as many as have room for their ray states in the largest
    /// buffer of the driver.
    [[nodiscard]] static int band_rows(int width, int height);

    /// Sets the frame, or a band of it (`view.first_row` and `row_count`); buffers grow when the bands do.
    /// @param is_blended  rays see two mips at once (LevelOfDetail::blended); the pool's bricks have mips.
    void begin_frame(const interop::MarchView& view, const Tree& tree, const BrickPool& pool, bool is_blended,
                     const MixTextures& mix = {});

    /// Blocks of PIXEL_BLOCK_SIDE^2 pixels of the frame whose rays may see anything.
    [[nodiscard]] std::size_t block_count() const { return block_starts_.size(); }
    /// Chooses the blocks whose rays begin in the next pass; the rays of other blocks are forgotten, if any
    /// wait. begin_frame() chooses all blocks. Blocks that are near to each other in the picture have numbers
    /// that are near to each other.
    void begin_part(std::size_t first, std::size_t count);

    /// Sets the windows of a tree that has some. Call it before each pass, since tiles come and go.
    void set_windows(const std::vector<interop::MarchWindow>& windows);

    /// Runs every waiting ray until it ends, misses a tile, or has crossed so many cells that it pauses.
    /// @param round  grows with each pass.
    /// @throws Error (Fault::internal) if rays wait though nothing is missing and no ray has paused, or if
    ///                                 rays pause without end.
    [[nodiscard]] PassResult run_pass(Round round, const Tree& tree, const BrickPool& pool,
                                      PassKind kind = PassKind::patient);

    [[nodiscard]] bool shows_surface() const { return content_.is_surface(); }

    [[nodiscard]] int band_pixels() const { return size_.x * size_.y; }
    /// Pixels of the blocks behind those of the part that began last.
    [[nodiscard]] std::uint32_t pixels_behind_part() const;

    /// The band's picture, RGBA8, row after row.
    [[nodiscard]] std::vector<std::uint8_t> read_image() const;

private:
    /// The program of the frame's rays.
    [[nodiscard]] const gl::Program& program(RayKind rays, PassKind kind);
    struct Dispatch {
        const gl::Program& program;
        bool is_shadow = false;
        std::uint32_t rays = 0;
    };
    void dispatch(const Dispatch& work, Round round, const BrickPool& pool, PassKind kind) const;

    MarchOptions options_;
    ContentProgram content_;
    void bind_mix() const;
    void set_mix(const gl::Program& program) const;

    gl::ProgramFamily<MarchVariant> programs_;
    gl::Buffer view_;
    gl::Buffer windows_;  ///< empty if the tree has no windows
    gl::Buffer shadow_ends_;
    gl::TextureHandle shadow_ends_texture_;
    gl::Buffer rays_;
    gl::Buffer lists_;
    QueryBuffer queries_;
    gl::Buffer shadow_sums_;  ///< empty until a frame has soft shadows
    gl::Buffer image_;
    gl::Buffer starts_;
    std::vector<interop::BlockStart> block_starts_;
    bool are_in_order_ = false;   // starts of blocks that are near to each other stand together
    std::size_t part_first_ = 0;  // blocks of the part
    std::size_t part_count_ = 0;
    std::uint32_t first_rays_ = 0;  // primary rays of the part's first pass
    MixTextures mix_;
    glm::ivec2 size_{0};
    std::size_t capacity_ = 0;  // pixels that the buffers have room for
    std::uint32_t waiting_primary_ = 0;
    std::uint32_t waiting_shadow_ = 0;
    bool first_pass_ = true;
    bool show_tree_ = false;
    int shadow_rays_ = 1;  // shadow rays per pixel
    bool soft_shadows_ = false;
    bool shadow_cones_ = false;
    bool blended_ = false;
    int pauses_ = 0;     // passes in a row in which rays only paused
    int list_side_ = 0;  // the half of the lists that is read
};

}  // namespace cairn::renderer
