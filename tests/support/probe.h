#pragma once

#include <string>
#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/shader_source.h"
#include "renderer/march/query_buffer.h"
#include "renderer/march/windows.h"
#include "renderer/pool/round.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/produce/tile_cache.h"

/// Rays of any origin and direction through the marching loop, for tests that ask where each meets the set of
/// FractalContent first.
namespace cairn::test {

struct Probe {
    glm::vec4 origin_t{0.0F};    ///< xyz: in voxels of the finest level, or of the first window
    glm::vec4 direction{0.0F};   ///< any length
    glm::ivec4 voxel_window{0};  ///< xyz: first occupied voxel, from the low corner of w: its window
    glm::ivec4 state{0};         ///< x: PROBE_*; y: log2 of the voxel's side
};

constexpr int PROBE_NEW = 0;
constexpr int PROBE_WAITS = 1;
constexpr int PROBE_HIT = 2;
constexpr int PROBE_MISSED = 3;

/// A compute program of shaders/march/march.glsl and what a test adds to it: visit() and main().
/// @throws Error (Fault::internal) with the compiler's log.
[[nodiscard]] gl::Program build_on_march(const gl::Defines& defines, const std::string& added);

class Prober {
public:
    Prober(const renderer::TreeShape& shape, std::size_t brick_pool_bytes, std::size_t node_pool_bytes);

    /// Marches the probes to their ends. All start at the eye of the windows, where the tree has any.
    void run(std::vector<Probe>& probes, const std::vector<renderer::Window>& windows = {},
             const renderer::Place& eye = {});

private:
    renderer::TileCache cache_;
    gl::Program program_;
    gl::Buffer windows_;
    renderer::QueryBuffer queries_;
    renderer::Round round_{1};
};

}  // namespace cairn::test
