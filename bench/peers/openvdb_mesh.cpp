#include "bench/peers/openvdb_mesh.h"

#include <chrono>
#include <cmath>

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>

#include "base/clock.h"

namespace cairn::bench {

struct OpenVdbMesh::Mesh {
    std::vector<openvdb::Vec3s> points;  ///< voxel i of the library has its centre at i
    std::vector<openvdb::Vec3I> triangles;
};

OpenVdbMesh::OpenVdbMesh(const std::vector<glm::vec3>& points, const std::vector<glm::uvec3>& triangles) {
    openvdb::initialize();
    const auto mesh = std::make_shared<Mesh>();
    for (const glm::vec3& p : points)
        mesh->points.emplace_back(p.x - 0.5F, p.y - 0.5F, p.z - 0.5F);
    for (const glm::uvec3& t : triangles)
        mesh->triangles.emplace_back(t.x, t.y, t.z);
    mesh_ = mesh;
}

double OpenVdbMesh::convert(voxelizer::BitGrid* voxels) const {
    // The library is built for these types.
    const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> mesh(mesh_->points,
                                                                                          mesh_->triangles);
    const openvdb::math::Transform::Ptr one_voxel = openvdb::math::Transform::createLinearTransform(1.0);
    openvdb::util::NullInterrupter never;
    const auto start = std::chrono::steady_clock::now();
    const openvdb::FloatGrid::Ptr grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        never, mesh, *one_voxel, 1.0F, 1.0F, openvdb::tools::UNSIGNED_DISTANCE_FIELD);
    const double milliseconds = milliseconds_since(start);
    if (voxels == nullptr) return milliseconds;
    const float half_diagonal = float(std::sqrt(0.75));
    for (auto value = grid->cbeginValueOn(); value; ++value) {
        if (!value.isVoxelValue() || std::abs(*value) > half_diagonal) continue;
        const openvdb::Coord& at = value.getCoord();
        const glm::ivec3 voxel(at.x(), at.y(), at.z());
        if (glm::all(glm::greaterThanEqual(voxel, glm::ivec3(0))) &&
            glm::all(glm::lessThan(voxel, voxels->size))) {
            voxels->set(voxel);
        }
    }
    return milliseconds;
}

}  // namespace cairn::bench
