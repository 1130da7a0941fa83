#include "bench/openvdb_mesh.h"

#include <chrono>
#include <cmath>

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>

namespace cairn::bench {
namespace {

/// The mesh as the library asks for it; voxel i has its centre at i.
class Adapter {
public:
    Adapter(const std::vector<glm::vec3>& points, const std::vector<glm::uvec3>& triangles)
        : points_(points), triangles_(triangles) {}
    [[nodiscard]] std::size_t polygonCount() const { return triangles_.size(); }
    [[nodiscard]] std::size_t pointCount() const { return points_.size(); }
    [[nodiscard]] static std::size_t vertexCount(std::size_t /*polygon*/) { return 3; }
    void getIndexSpacePoint(std::size_t polygon, std::size_t corner, openvdb::Vec3d& out) const {
        const glm::vec3& p = points_[triangles_[polygon][int(corner)]];
        out = openvdb::Vec3d(p.x, p.y, p.z);
    }

private:
    const std::vector<glm::vec3>& points_;
    const std::vector<glm::uvec3>& triangles_;
};

}  // namespace

OpenVdbMesh::OpenVdbMesh(const voxelizer::Surface& surface, const voxelizer::Region& region)
    : region_(region) {
    openvdb::initialize();
    const double unit = 1.0 / region.voxel_side();
    for (const voxelizer::SurfaceChunk& chunk : surface.chunks) {
        const auto first = unsigned(points_.size());
        for (const auto& p : chunk.positions)
            points_.emplace_back(glm::dvec3(p[0], p[1], p[2]) * unit - 0.5);
        for (const interop::SurfaceTriangle& triangle : chunk.triangles)
            triangles_.push_back(first + glm::uvec3(triangle.vertices_material));
    }
}

double OpenVdbMesh::convert(voxelizer::BitGrid* voxels) const {
    const Adapter mesh(points_, triangles_);
    const openvdb::math::Transform::Ptr one_voxel = openvdb::math::Transform::createLinearTransform(1.0);
    const auto start = std::chrono::steady_clock::now();
    const openvdb::FloatGrid::Ptr grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        mesh, *one_voxel, 1.0F, 1.0F, openvdb::tools::UNSIGNED_DISTANCE_FIELD);
    const double milliseconds =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    if (voxels == nullptr) return milliseconds;
    *voxels = voxelizer::BitGrid(region_.size);
    const float half_diagonal = float(std::sqrt(0.75));
    for (auto value = grid->cbeginValueOn(); value; ++value) {
        if (!value.isVoxelValue() || std::abs(*value) > half_diagonal) continue;
        const openvdb::Coord& at = value.getCoord();
        const glm::ivec3 voxel = glm::ivec3(at.x(), at.y(), at.z()) - region_.origin;
        if (glm::all(glm::greaterThanEqual(voxel, glm::ivec3(0))) &&
            glm::all(glm::lessThan(voxel, region_.size))) {
            voxels->set(voxel);
        }
    }
    return milliseconds;
}

}  // namespace cairn::bench
