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

/// What a tile turned out to hold once it was produced (Crassin et al. 2008, section 6.1). It depends on the
/// tile alone.
struct Produced {
    /// Every voxel at the tile's own level has the same value (the border too, unless that is 0): no brick is
    /// needed. Its children may hold more. Not with a value other than 0 unless Content::has_constant().
    bool constant = false;
    /// Nothing finer would add to what the tile holds at its own level: it is not subdivided. Only with
    /// Content::has_low_frequency().
    bool low_frequency = false;
    /// Of the voxels, as the brick pool's colour texels are; x alone where it has one channel. 0 is empty.
    glm::u8vec4 mean{0};
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

    /// Of the last produce(): milliseconds for sending bricks to the GPU, where it does not make them itself.
    [[nodiscard]] virtual double upload_ms() const { return 0.0; }
};

}  // namespace cairn::renderer
