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
#include "renderer/march/tile_queries.h"
#include "renderer/march/traversal.h"
#include "renderer/pool/brick_pool.h"
#include "renderer/pool/round.h"
#include "renderer/pool/tree.h"
#include "renderer/produce/content_program.h"
#include "renderer/produce/tile_query.h"
#include "shaders/interop/march.h"
#include "shaders/interop/windows.h"

namespace cairn::renderer {

/// How rays take what is missing.
enum class PassKind : std::uint8_t {
    patient,      ///< a ray waits for the tile that it asks for
    progressive,  ///< the same; rays also ask for the bricks of the nodes that they pass
    stand_in,     ///< no ray waits: the nearest ancestor's brick is shown
};

/// What one pass of rays came back with.
struct PassResult {
    std::uint32_t waiting_primary = 0;  ///< rays that missed a tile or paused
    std::uint32_t waiting_shadow = 0;   ///< the same, and shadow rays not yet started
    std::uint32_t stood_in = 0;         ///< missing tiles that rays did not wait for
    std::uint32_t launched = 0;  ///< rays that began; all of the band's in its first pass, but for a proxy
    std::vector<TileQuery> queries;           ///< each once; patient passes do not count the rays that ask
    std::vector<std::uint32_t> brick_stamps;  ///< of each slot, the last round whose rays used it
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
    /// In sides of a voxel: voxels whose centres lie lower over a mesh are part of its surface and cast no
    /// shadow on it.
    float mesh_self_shadow_height = 0.0F;
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
            const gl::ShaderSource& shaders, ContentProgram content = {});

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
    /// @param round  grows with each pass.
    /// @throws Error (Fault::internal) when rays wait though nothing is missing and none has paused, or pause
    /// without end.
    [[nodiscard]] PassResult run_pass(Round round, const Tree& tree, const BrickPool& pool,
                                      PassKind kind = PassKind::patient);

    [[nodiscard]] bool marches_surfaces() const { return content_.of_surfaces(); }

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
    void run(const Dispatch& dispatch, Round round, const BrickPool& pool, PassKind kind) const;

    MarchOptions options_;
    ContentProgram content_;
    void bind_mix() const;
    void set_mix(const gl::Program& program) const;

    gl::ProgramFamily<MarchVariant> programs_;
    gl::Buffer view_;
    gl::Buffer windows_;  ///< empty where the tree has none
    gl::Buffer shadow_ends_;
    gl::TextureHandle shadow_ends_texture_;
    gl::Buffer rays_;
    gl::Buffer lists_;
    QueryBuffer queries_;
    gl::Buffer shadow_sums_;  ///< empty until a frame has soft shadows
    gl::Buffer image_;
    gl::Buffer starts_;
    std::size_t start_count_ = 0;
    std::uint32_t first_rays_ = 0;  // pixels of the first pass
    MarchMix mix_;
    glm::ivec2 size_{0};
    std::size_t capacity_ = 0;  // pixels that the buffers hold
    std::uint32_t waiting_primary_ = 0;
    std::uint32_t waiting_shadow_ = 0;
    bool first_pass_ = true;
    bool show_tree_ = false;
    int shadow_rays_ = 1;  // of a pixel
    bool soft_shadows_ = false;
    bool shadow_cones_ = false;
    bool blended_ = false;
    int pauses_ = 0;     // passes in a row in which rays only paused
    int list_side_ = 0;  // which half of the lists is read
};

}  // namespace cairn::renderer
