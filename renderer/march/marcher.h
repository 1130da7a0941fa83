#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "gl/program.h"
#include "renderer/march/march_programs.h"
#include "renderer/march/tile_blocks.h"
#include "renderer/march/tile_queries.h"
#include "renderer/march/traversal.h"
#include "renderer/pool/brick_pool.h"
#include "renderer/pool/tree.h"
#include "shaders/interop/march.h"
#include "shaders/interop/tile_query.h"
#include "shaders/interop/windows.h"

namespace cairn::renderer {

/// How rays take what is missing.
enum class PassKind : std::uint8_t {
    patient,      ///< a ray waits for the tile that it asks for
    progressive,  ///< the same; rays also ask for the bricks of the nodes that they pass
    stand_in,     ///< no ray waits: the nearest ancestor's brick is shown
};

struct MarchOptions {
    Traversal traversal = Traversal::mini_stack;
    bool block_starts = true;  ///< rays start at block_starts(), where there are any
    /// Tiles that a pass can ask for, [1, QUERY_CAPACITY]. Where more are asked for, the most urgent is known
    /// all the same: a brick, or else the children of a node as deep as any.
    int query_capacity = QUERY_CAPACITY;
    TileQueries tile_queries = TileQueries::list;  ///< patient passes alone know blocks
};

/// What one pass of rays came back with.
struct PassResult {
    std::uint32_t waiting_primary = 0;  ///< rays that missed a tile or paused
    std::uint32_t waiting_shadow = 0;   ///< the same, and shadow rays not yet started
    std::uint32_t stood_in = 0;         ///< missing tiles that rays did not wait for
    std::uint32_t launched = 0;  ///< rays that began; all of the band's in its first pass, but for a proxy
    /// 2 * node entry + QUERY_*, or 2 * Tree::entry_count() + entry for a brick that could stand in; each
    /// once.
    std::vector<std::uint32_t> queries;
    std::vector<std::uint32_t>
        query_counts;  ///< rays that ask, by query % QUERY_COUNTS; not of patient passes
    std::vector<std::uint32_t> brick_stamps;  ///< one a slot: the last round whose rays used it
    std::size_t bytes_read = 0;               ///< from the GPU, to know all this
    [[nodiscard]] bool done() const { return waiting_primary == 0 && waiting_shadow == 0; }
};

/// What the rays of a band meet beside voxels: textures of rows that hold the band's
/// (renderer/mesh/mesh_raster.h).
struct MarchMix {
    GLuint mesh_nearest = 0;  ///< 0: no meshes
    GLuint mesh_surface = 0;
    int mesh_first_row = 0;  ///< of the picture, in those
    bool voxels_hidden = false;
    bool mesh_shadows = false;  ///< voxels cast shadows on meshes
    float mesh_own_height =
        0.0F;               ///< voxels whose centres are no further over a mesh are its own; in their sides
    GLuint proxy_span = 0;  ///< 0: no proxy
    GLuint proxy_faces = 0;
    int proxy_first_row = 0;
};

/// The ray-marching passes of one frame: the ray states, the lists of rays that must go on, and the tile
/// query buffer (Crassin et al. 2008, sections 5.1 to 5.3).
class Marcher {
public:
    /// @throws Error (Fault::usage) for a query capacity that is none.
    Marcher(const TreeShape& shape, bool has_color, const MarchOptions& options,
            const gl::ShaderSource& shaders, MarchKind kind = {});

    /// Rows of a picture that are marched at once: as many as the driver's largest buffer holds ray states
    /// for.
    [[nodiscard]] static int band_rows(int width, int height);

    /// Sets the frame, or a band of it (`view.first_row` and `row_count`); buffers grow when the bands do.
    /// @param is_blended  rays see two mips at once (LevelOfDetail::blended); the pool's bricks have mips.
    void begin_frame(const interop::MarchView& view, const Tree& tree, const BrickPool& pool, bool is_blended,
                     const MarchMix& mix = {});

    /// For trees with windows: before each pass, since tiles come and go.
    void set_windows(const std::vector<interop::MarchWindow>& windows);

    /// Runs every waiting ray until it ends, misses a tile, or has crossed so many cells that it pauses.
    /// `round` is a number that grows with each pass.
    /// @throws Error (Fault::internal) when rays wait though nothing is missing and none has paused, or pause
    /// without end.
    [[nodiscard]] PassResult run_pass(std::uint32_t round, const Tree& tree, const BrickPool& pool,
                                      PassKind kind = PassKind::patient);

    [[nodiscard]] bool marches_surfaces() const { return kind_.of_surfaces(); }

    [[nodiscard]] int band_pixels() const { return size_.x * size_.y; }

    /// RGBA8, the band's first row first.
    [[nodiscard]] std::vector<std::uint8_t> read_image() const;

private:
    /// The program of the frame's rays.
    [[nodiscard]] const gl::Program& program(RayKind rays, PassKind kind);
    struct Dispatch {
        const gl::Program& program;
        bool is_shadow = false;
        std::uint32_t rays = 0;
    };
    void run(const Dispatch& dispatch, std::uint32_t round, const BrickPool& pool, PassKind kind) const;
    [[nodiscard]] interop::MarchCounters read_counters() const;
    void forget_queries(PassKind kind, std::size_t entries);
    void read_list(PassResult& result, std::uint32_t asked, PassKind kind, int slots);
    void read_blocks(PassResult& result, std::uint32_t round);
    [[nodiscard]] std::vector<std::uint32_t> read_urgent(PassResult& result);

    MarchOptions options_;
    MarchKind kind_;
    void bind_mix() const;
    void set_mix(const gl::Program& program) const;

    gl::ProgramFamily<MarchVariant> programs_;
    gl::Buffer view_;
    gl::Buffer windows_;  ///< empty where the tree has none
    gl::Buffer shadow_ends_;
    gl::TextureHandle shadow_ends_texture_;
    gl::Buffer rays_;
    gl::Buffer lists_;
    gl::Buffer queries_;
    gl::Buffer usage_;        ///< none with tile_blocks_
    gl::Buffer shadow_sums_;  ///< empty until a frame has soft shadows
    std::optional<TileBlocks> tile_blocks_;
    std::vector<std::uint32_t> block_stamps_;  ///< of slots, with tile_blocks_
    gl::Buffer image_;
    gl::Buffer starts_;
    std::size_t start_count_ = 0;
    std::uint32_t first_rays_ = 0;  // pixels of the first pass
    MarchMix mix_;
    glm::ivec2 size_{0};
    std::size_t capacity_ = 0;  // pixels that the buffers hold
    std::uint32_t query_bits_offset_ = 0;
    std::uint32_t entry_count_ = 0;
    std::uint32_t query_capacity_ = 0;
    std::uint32_t waiting_primary_ = 0;
    std::uint32_t waiting_shadow_ = 0;
    bool first_pass_ = true;
    bool urgent_told_ = true;  // the last pass left queries by rank
    bool show_tree_ = false;
    int shadow_rays_ = 1;  // of a pixel
    bool soft_shadows_ = false;
    bool shadow_cones_ = false;
    bool blended_ = false;
    int pauses_ = 0;     // passes in a row in which rays only paused
    int list_side_ = 0;  // which half of the lists is read
};

}  // namespace cairn::renderer
