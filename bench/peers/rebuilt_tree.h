#pragma once

#include <vector>

#include "reference/embree.h"
#include "scenes/snapshot.h"

namespace cairn::bench {

/// An Embree scene whose triangles stay and whose vertices are written anew for each frame. Lines, points and
/// triangles without indices are left out.
class RebuiltTree {
public:
    /// @throws Error (Fault::memory) if Embree cannot hold the triangles.
    RebuiltTree(const scenes::Snapshot& snapshot, RTCBuildQuality quality);

    /// @param snapshot  of the same scene at another moment
    void write(const scenes::Snapshot& snapshot);
    /// Builds the tree of what was written last.
    void build() const;

private:
    struct Geometry {
        reference::EmbreeGeometry owner;
        float* vertices;
    };
    void add(const scenes::Item& item, RTCBuildQuality quality);

    reference::EmbreeDevice device_;
    reference::EmbreeScene tree_;
    std::vector<Geometry> geometries_;
};

}  // namespace cairn::bench
