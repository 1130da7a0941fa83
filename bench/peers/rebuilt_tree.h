#pragma once

#include <vector>

#include "reference/embree.h"
#include "scenes/snapshot.h"

namespace cairn::bench {

/// An Embree scene whose triangles stay the same and whose vertices are written for each frame. Lines, points
/// and triangles without indices are left out.
class RebuiltTree {
public:
    /// @throws Error (Fault::memory) if Embree cannot hold the triangles.
    RebuiltTree(const scenes::Snapshot& snapshot, RTCBuildQuality quality);

    /// Writes the vertices. @param snapshot  the same scene at another moment
    void write(const scenes::Snapshot& snapshot);
    /// Builds the tree of the vertices that were written last.
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
