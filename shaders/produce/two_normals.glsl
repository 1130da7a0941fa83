// Two unit normals that stand for all normals in a voxel. They have the same mean, and lie on the line
// through it along which the normals spread most (the first principal component). So a voxel keeps the two
// faces at an edge, or the two sides of something thin, apart, though their mean faces neither way.
#include "pool/brick_normals.glsl"

// Normals that spread less than this are taken for one, and the voxel has a slab (sine of half the angle between the
// two). With less, curved surfaces have fewer slabs, and pictures are further from the truth.
#define LEAST_SPREAD 0.5
#define SPREAD_TURNS 8  // of the power iteration

// The unit eigenvector of the largest eigenvalue, by power iteration.
vec3 main_direction(mat3 covariance) {
    const vec3 diagonal = vec3(covariance[0].x, covariance[1].y, covariance[2].z);
    const float most = max(diagonal.x, max(diagonal.y, diagonal.z));
    vec3 u = diagonal.x == most ? covariance[0] : diagonal.y == most ? covariance[1] : covariance[2];
    for (int i = 0; i < SPREAD_TURNS; ++i) u = covariance * (u / max(length(u), 1e-12));
    return u / max(length(u), 1e-12);
}

// `moments`: mean of n n^T, whose trace is 1.
Normals two_normals(vec3 mean, mat3 moments) {
    const vec3 u = main_direction(moments - outerProduct(mean, mean));
    // |mean + a u| = |mean - b u| = 1
    const float along = dot(mean, u);
    const float half_way = sqrt(max(along * along + 1.0 - dot(mean, mean), 0.0));
    const float a = half_way - along;
    const float b = half_way + along;
    const float share = min(a, b) / max(a + b, 1e-6);
    if (half_way < LEAST_SPREAD || 6.0 * share < 0.5) return Normals(mean, mean, 0.0);
    return a <= b ? Normals(mean + a * u, mean - b * u, share) : Normals(mean - b * u, mean + a * u, share);
}
