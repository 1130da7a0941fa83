#pragma once

#include <span>
#include <vector>

#include "renderer/pool/brick_pool.h"
#include "renderer/pool/tree_shape.h"

namespace cairn::renderer {

struct BrickRequest {
    Tile tile;
    int slot = 0;
};

/// What a tile turned out to hold once it was produced.
struct Produced {
    bool constant = false;  ///< every voxel, border included, has the same value: no brick is needed
    glm::u8vec4 mean{
        0};  ///< of the voxels, as the brick pool's colour texels are; x alone where it has one channel
};

/// Fills bricks on demand (Crassin et al. 2008, section 6.1).
class Producer {
public:
    Producer() = default;
    Producer(const Producer&) = delete;
    Producer& operator=(const Producer&) = delete;
    Producer(Producer&&) = delete;
    Producer& operator=(Producer&&) = delete;
    virtual ~Producer() = default;

    /// Writes the whole slot of each request: colour or coverage, normal, masks, border included. The same
    /// tile gives the same texels whatever it is produced with.
    /// @return one for each request.
    virtual std::vector<Produced> produce(std::span<const BrickRequest> requests, const BrickPool& pool) = 0;
};

}  // namespace cairn::renderer
