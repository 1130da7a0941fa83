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

/// Rays of any origin and direction through the marching loop, for tests of where each first meets the set of
/// FractalContent.
namespace cairn::test {

struct Probe {
    /// xyz: origin in voxels of the finest level, or of the first window.
    glm::vec4 origin_t{0.0F};
    /// xyz: direction, of any length.
    glm::vec4 direction{0.0F};
    /// xyz: first occupied voxel, relative to the low corner of its window; w: that window.
    glm::ivec4 voxel_window{0};
    /// x: PROBE_*; y: log2 of the voxel's side.
    glm::ivec4 state{0};
};

constexpr int PROBE_NEW = 0;
constexpr int PROBE_WAITS = 1;
constexpr int PROBE_HIT = 2;
constexpr int PROBE_MISSED = 3;

/// A compute program of shaders/march/march.glsl and of the test's visit() and main().
/// @throws Error (Fault::internal) with the compiler's log.
[[nodiscard]] gl::Program build_on_march(const gl::Defines& defines, const std::string& added);

class Prober {
public:
    Prober(const renderer::TreeShape& shape, std::size_t brick_pool_bytes, std::size_t node_pool_bytes);

    /// Marches the probes to their ends. If the tree has windows, all probes start at the eye of these.
    void run(std::vector<Probe>& probes, const std::vector<renderer::Window>& windows = {},
             const renderer::TilePoint& eye = {});

private:
    renderer::TileCache cache_;
    gl::Program program_;
    gl::Buffer windows_;
    renderer::QueryBuffer queries_;
    renderer::Round round_{1};
};

}  // namespace cairn::test
