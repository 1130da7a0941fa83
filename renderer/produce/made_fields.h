#pragma once

#include <cstdint>
#include <memory>

#include "renderer/produce/volume.h"

namespace cairn::renderer {

/// A ball, or a shell: density 1 between two radii and 0 elsewhere, computed by formula at any resolution. It
/// is the test object of Crassin 2007, section 3.7.
///
/// The mean of a voxel is that of a slab: the share of the diameter of the voxel's inscribed ball, laid along
/// the radius, that lies between the two radii.
class HollowSphere final : public Field {
public:
    /// The cube that bounds the field has its centre at the world's origin.
    /// @param n             n of the tree
    /// @param resolution    voxels along the cube's side
    /// @param inner, outer  radii in [0, 1/2] of the side, inner < outer; inner 0: a ball
    /// @param side          side of the cube, world units, above 0
    /// @throws Error (Fault::usage) if a radius, the resolution or the side is out of range.
    HollowSphere(int n, std::int64_t resolution, double inner, double outer, double side = 2.0);

    [[nodiscard]] const FieldFrame& frame() const override { return frame_; }
    void fill(int coarseness, const glm::i64vec3& low, const glm::ivec3& count, float* values) const override;
    [[nodiscard]] FieldRange range(const glm::i64vec3& low, const glm::i64vec3& high) const override;

private:
    FieldFrame frame_;
    double inner_;  // in finest voxels
    double outer_;
    glm::dvec3 centre_;
};

/// Copies of a field side by side, `copies` along each axis, without taking more memory: how Crassin et al.
/// 2008, section 7, make 8192^3 voxels of a scan of 1024^3.
///
/// A copy takes a cube whose side is the least power of n voxels that holds the field, so that voxels of
/// every level lie in it as they lie in the field alone.
class RepeatedField final : public Field {
public:
    /// @param copies  copies along each axis, in [1, 2^20].
    /// @throws Error (Fault::usage) if `copies` is out of range.
    RepeatedField(std::shared_ptr<const Field> field, int copies);

    [[nodiscard]] const FieldFrame& frame() const override { return frame_; }
    void fill(int coarseness, const glm::i64vec3& low, const glm::ivec3& count, float* values) const override;
    [[nodiscard]] FieldRange range(const glm::i64vec3& low, const glm::i64vec3& high) const override;

private:
    void fill_across(int coarseness, const glm::i64vec3& low, const glm::ivec3& count, float* values) const;

    std::shared_ptr<const Field> field_;
    int copies_;
    int period_power_ = 0;  // a copy has n to this power finest voxels per side
    std::int64_t period_ = 1;
    FieldFrame frame_;
    float mean_ = 0.0F;  // mean density of a copy
};

}  // namespace cairn::renderer
