#pragma once

#include <optional>
#include <vector>

#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "voxelizer/methods/conservative_voxelizer.h"

namespace cairn::test {

/// A test with a context and the exact method.
class ConservativeTest : public GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        voxelizer_.emplace();
    }
    void TearDown() override {
        voxelizer_.reset();
        GlTest::TearDown();
    }
    [[nodiscard]] voxelizer::Voxelizer& voxelizer() { return *voxelizer_; }
    [[nodiscard]] voxelizer::BitGrid voxelize(const std::vector<LatticeTriangle>& triangles,
                                              const voxelizer::Region& region) {
        return voxelizer_->voxelize(upload(lattice_surface(triangles, 16)), region);
    }

private:
    std::optional<voxelizer::ConservativeVoxelizer> voxelizer_;
};

}  // namespace cairn::test
