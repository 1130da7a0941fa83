#include "tests/support/march_twin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "reference/exact_voxels.h"
#include "scenes/snapshot.h"
#include "shaders/interop/grid.h"
#include "shaders/interop/march.h"
#include "shaders/interop/surface.h"
#include "voxelizer/surface/surface.h"

namespace cairn::test {
namespace {

using glm::dvec3;
using glm::ivec3;

/// Sums over the 4^3 finer voxels of one voxel.
struct Gathered {
    bool fine[4][4][4] = {};
    dvec3 normal{0.0};
    glm::dmat3 moments{0.0};
    double weight = 0.0;
};

double coverage_of(const Gathered& g) {
    int most = 0;
    for (int axis = 0; axis < 3; ++axis) {
        int columns = 0;
        for (int i = 0; i < 4; ++i) {
            for (int j = 0; j < 4; ++j) {
                bool any = false;
                for (int k = 0; k < 4; ++k) {
                    any |= axis == 0 ? g.fine[k][i][j] : axis == 1 ? g.fine[i][k][j] : g.fine[i][j][k];
                }
                columns += any ? 1 : 0;
            }
        }
        most = std::max(most, columns);
    }
    return std::round(most / 16.0 * 255.0) / 255.0;  // R8
}

/// A normal rounded to whole steps of the octahedral map.
dvec3 rounded_normal(const dvec3& n, double steps) {
    const glm::dvec2 flat = glm::dvec2(n) / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
    const auto folded = [](const glm::dvec2& e) {
        return (1.0 - glm::abs(glm::dvec2(e.y, e.x))) *
               glm::dvec2(e.x < 0.0 ? -1.0 : 1.0, e.y < 0.0 ? -1.0 : 1.0);
    };
    const glm::dvec2 e = glm::round((n.z < 0.0 ? folded(flat) : flat) * steps) / steps;
    const double z = 1.0 - std::abs(e.x) - std::abs(e.y);
    return glm::normalize(dvec3(z < 0.0 ? folded(e) : e, z));
}

/// The direction in which normals spread most, by the same power iteration as in the shader: if several
/// directions are equally good, its choice is the definition.
dvec3 main_direction(const glm::dmat3& covariance) {
    int most = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (covariance[axis][axis] > covariance[most][most]) most = axis;
    dvec3 u = covariance[most];
    for (int i = 0; i < 8; ++i)
        u = covariance * (u / std::max(glm::length(u), 1e-12));
    return u / std::max(glm::length(u), 1e-12);
}

/// Two normals that have the mean of all and lie in the direction in which they spread most.
TwoNormals two_normals(const Gathered& g) {
    if (glm::length(g.normal) + glm::length(g.moments[0]) + glm::length(g.moments[1]) == 0.0) return {};
    const dvec3 mean = g.normal / g.weight;
    const dvec3 u = main_direction(g.moments / g.weight - glm::outerProduct(mean, mean));
    const double along = glm::dot(mean, u);
    const double half = std::sqrt(std::max(along * along + 1.0 - glm::dot(mean, mean), 0.0));
    TwoNormals two{true, mean, mean, 0.0};
    const double share = std::min(half - along, half + along) / std::max(2.0 * half, 1e-6);
    const bool is_two = half >= 0.5 && 6.0 * share >= 0.5;
    if (is_two) {
        two.first = mean + (half - along) * u;
        two.second = mean - (half + along) * u;
        if (along < 0.0) std::swap(two.first, two.second);
        two.share = std::round(6.0 * share) / 6.0;
    }
    two.first = rounded_normal(two.first, 255.0);
    two.second = is_two ? rounded_normal(two.second, 31.0) : two.first;
    return two;
}

/// Bounds, along a direction, of a triangle's part in a voxel, from the voxel's centre in sides of the voxel:
/// those of its vertices, of its plane, and of what its bounding box and the voxel have in common.
std::array<double, 2> range_along(const dvec3& direction, const std::array<dvec3, 3>& corners) {
    const dvec3 cross = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const dvec3 normal = glm::length(cross) > 0.0 ? glm::normalize(cross) : dvec3(0.0);
    const dvec3 low = glm::clamp(glm::min(corners[0], glm::min(corners[1], corners[2])), -0.5, 0.5);
    const dvec3 high = glm::clamp(glm::max(corners[0], glm::max(corners[1], corners[2])), -0.5, 0.5);
    const auto widest = [&](const dvec3& along) { return 0.5 * glm::dot(glm::abs(along), high - low); };
    const auto middle = [&](const dvec3& along) { return 0.5 * glm::dot(along, low + high); };
    const double tilt = glm::dot(direction, normal);
    const dvec3 rest = direction - tilt * normal;
    const double plane = tilt * glm::dot(normal, corners[0]) + middle(rest);
    const std::array at = {glm::dot(direction, corners[0]), glm::dot(direction, corners[1]),
                           glm::dot(direction, corners[2])};
    const auto [least, most] = std::minmax_element(at.begin(), at.end());
    return {std::max({*least, middle(direction) - widest(direction), plane - widest(rest)}),
            std::min({*most, middle(direction) + widest(direction), plane + widest(rest)})};
}

/// The slabs of voxels with one normal: 64 steps from the first corner along the normal to the last.
class SlabTwin {
public:
    explicit SlabTwin(const std::vector<TwoNormals>& normals) : normals_(normals), reach_(normals.size()) {}

    /// @param corners  of a triangle that meets the voxel, from the voxel's centre in sides of the voxel.
    void add(std::size_t voxel, const std::array<dvec3, 3>& corners) {
        const std::array<double, 2> range = range_along(on_octahedron(voxel), corners);
        Reach& reach = reach_[voxel];
        reach.low = std::min(reach.low, range[0] - margin);
        reach.high = std::max(reach.high, range[1] + margin);
    }

    [[nodiscard]] TwinSlab slab(std::size_t voxel, const Gathered& g) const {
        const TwoNormals& n = normals_[voxel];
        if (!n.there || n.share > 0.0) return {};
        const double first = std::clamp(std::floor((reach_[voxel].low + 0.5) * 64.0), 0.0, 63.0);
        const double end = std::clamp(std::ceil((reach_[voxel].high + 0.5) * 64.0), first + 1.0, 64.0);
        TwinSlab slab{true, true, on_octahedron(voxel), first / 64.0 - 0.5, end / 64.0 - 0.5};
        for (int i = 0; i < 64; ++i) {
            const ivec3 cell(i % 4, i / 4 % 4, i / 16);
            const double middle = glm::dot(slab.normal, (dvec3(cell) - 1.5) * 0.25);
            constexpr double height = 0.125 - 0.05;
            if (middle + height > slab.low && middle - height < slab.high)
                slab.is_enough = slab.is_enough && g.fine[cell.x][cell.y][cell.z];
        }
        return slab;
    }

private:
    static constexpr double margin = 2.5e-4;  // for rounding errors
    struct Reach {
        double low = 1.0;
        double high = -1.0;
    };
    [[nodiscard]] dvec3 on_octahedron(std::size_t voxel) const {
        const dvec3& n = normals_[voxel].first;
        return n / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
    }

    const std::vector<TwoNormals>& normals_;
    std::vector<Reach> reach_;
};

/// Adds one triangle's exact finer voxels to the voxels that hold them.
void gather(const voxelizer::Surface& one, int fine_level, int side, std::vector<Gathered>& all) {
    const voxelizer::SurfaceChunk& chunk = one.chunks[0];
    auto corner = [&](std::uint32_t v) {
        const auto& p = chunk.positions[v];
        return ivec3(p[0], p[1], p[2]);
    };
    const glm::uvec3 t = chunk.triangles[0].vertices;
    const ivec3 a = corner(t.x);
    const ivec3 b = corner(t.y);
    const ivec3 c = corner(t.z);
    const dvec3 cross = glm::cross(dvec3(b - a), dvec3(c - a));
    const dvec3 normal = glm::length(cross) > 0.0 ? glm::normalize(cross) : dvec3(0.0);
    const int fine_side = 1 << (LATTICE_BITS - fine_level);
    const ivec3 low = glm::max(glm::min(a, glm::min(b, c)) / fine_side - 1, ivec3(0));
    const ivec3 high = glm::min(glm::max(a, glm::max(b, c)) / fine_side + 1, ivec3(4 * side - 1));
    const voxelizer::BitGrid bits = reference::exact_voxels(one, {fine_level, low, high - low + 1});
    for (int z = 0; z < bits.size.z; ++z) {
        for (int y = 0; y < bits.size.y; ++y) {
            for (int x = 0; x < bits.size.x; ++x) {
                if (!bits.at({x, y, z})) continue;
                const ivec3 f = low + ivec3(x, y, z);
                const ivec3 v = f / 4;
                const int voxel = (v.z * side + v.y) * side + v.x;
                Gathered& g = all[std::size_t(voxel)];
                g.fine[f.x % 4][f.y % 4][f.z % 4] = true;
                g.normal += normal;
                g.moments += glm::outerProduct(normal, normal);
                g.weight += 1.0;
            }
        }
    }
}

/// Adds every triangle to the slabs of the voxels that it meets.
void add_triangles(const voxelizer::Surface& surface, int fine_level, int side,
                   const std::vector<TwoNormals>& normals, SlabTwin& slabs) {
    const double voxel = 1 << (LATTICE_BITS - fine_level + 2);
    voxelizer::Surface one = surface;
    for (const voxelizer::SurfaceChunk& chunk : surface.chunks) {
        one.chunks = {chunk};
        one.triangle_count = 1;
        for (const interop::SurfaceTriangle& triangle : chunk.triangles) {
            one.chunks[0].triangles = {triangle};
            std::array<dvec3, 3> corners;
            for (int k = 0; k < 3; ++k) {
                const auto& p = chunk.positions[triangle.vertices[k]];
                corners[std::size_t(k)] = dvec3(p[0], p[1], p[2]) / voxel;
            }
            const voxelizer::BitGrid bits =
                reference::exact_voxels(one, {fine_level - 2, ivec3(0), ivec3(side)});
            for (std::size_t i = 0; i < normals.size(); ++i) {
                const int n = int(i);
                const ivec3 v(n % side, n / side % side, n / (side * side));
                if (!normals[i].there || normals[i].share > 0.0 || !bits.at(v)) continue;
                std::array<dvec3, 3> from_centre = corners;
                for (dvec3& corner : from_centre)
                    corner -= dvec3(v) + 0.5;
                slabs.add(i, from_centre);
            }
        }
    }
}

struct Hit {
    double transmittance = 1.0;
    dvec3 normal{0.0};
    double best_weight = 0.0;
    double depth = 0.0;
};

/// Calls visit(voxel, t_in, t_out) for each voxel that the ray crosses, nearest first, until it returns
/// false. Positions are in voxels.
void cross_voxels(int side, const dvec3& origin, const dvec3& direction, double t_end,
                  const std::function<bool(const ivec3&, double, double)>& visit) {
    double t_near = 0.0;
    double t_far = t_end;
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0.0) {
            if (origin[axis] < 0.0 || origin[axis] > side) return;
            continue;
        }
        const double t0 = -origin[axis] / direction[axis];
        const double t1 = (side - origin[axis]) / direction[axis];
        t_near = std::max(t_near, std::min(t0, t1));
        t_far = std::min(t_far, std::max(t0, t1));
    }
    if (t_near >= t_far) return;
    ivec3 v = glm::clamp(ivec3(glm::floor(origin + direction * t_near)), ivec3(0), ivec3(side - 1));
    for (double t = t_near; t < t_end;) {
        int axis = 0;
        double t_out = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 3; ++k) {
            if (direction[k] == 0.0) continue;
            const double plane = (v[k] + (direction[k] > 0.0 ? 1 : 0) - origin[k]) / direction[k];
            if (plane < t_out) {
                t_out = plane;
                axis = k;
            }
        }
        t_out = std::max(t_out, t);
        if (!visit(v, t, t_out)) return;
        v[axis] += direction[axis] > 0.0 ? 1 : -1;
        if (v[axis] < 0 || v[axis] >= side) return;
        t = t_out;
    }
}

double behind(double transmittance, double coverage) {
    return std::max(transmittance - std::min(2.0 * coverage, 1.0), 0.0);
}

/// The surface that a ray sees at a point, interpolated between the four voxel centres of the tetrahedron
/// around it. Outside the root cube there is nothing.
dvec3 visible_normal(const DenseVoxels& voxels, const ivec3& own, const dvec3& point,
                     const dvec3& direction) {
    const dvec3 p = point - 0.5;
    const ivec3 low = ivec3(glm::floor(p));
    const dvec3 f = p - dvec3(low);
    std::array<int, 3> axes = {0, 1, 2};
    std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return f[a] > f[b]; });
    ivec3 corner = low;
    dvec3 seen(0.0);
    dvec3 all(0.0);
    double spread = 0.0;
    for (int i = 0; i <= 3; ++i) {
        double weight =
            (i == 0 ? 1.0 : f[axes[std::size_t(i - 1)]]) - (i == 3 ? 0.0 : f[axes[std::size_t(i)]]);
        if (glm::all(glm::equal(corner, own))) weight += 0.125;
        const bool inside = glm::all(glm::greaterThanEqual(corner, ivec3(0))) &&
                            glm::all(glm::lessThan(corner, ivec3(voxels.side)));
        const TwoNormals n = inside ? voxels.normals[voxels.index(corner)] : TwoNormals{};
        if (n.there) {
            const dvec3 first = weight * (1.0 - n.share) * n.first;
            const dvec3 second = weight * n.share * n.second;
            seen += std::max(-glm::dot(n.first, direction), 0.0) * first +
                    std::max(-glm::dot(n.second, direction), 0.0) * second;
            all += first + second;
            spread += weight * (1.0 - glm::dot(n.first, n.second));
        }
        if (i < 3) ++corner[axes[std::size_t(i)]];
    }
    if (glm::length(seen) > 0.01) return glm::normalize(seen);
    if (glm::length(all) < 1e-3) return -direction;
    const dvec3 normal = glm::normalize(all);
    const double away = glm::dot(normal, direction);
    const double bend =
        std::clamp(std::sqrt(2.0 * spread / glm::length(all)), VOXEL_SILHOUETTE_BEND, SILHOUETTE_BEND);
    return away > bend ? -normal : glm::normalize(normal - std::max(away, 0.0) * direction);
}

/// Where a ray is both in a finer voxel that it crosses and in its voxel's slab: in finer voxels.
struct Met {
    bool is_met = false;
    double middle = 0.0;
};

Met meet(const DenseVoxels& voxels, const ivec3& v, const dvec3& origin, const dvec3& direction, double t_in,
         double t_out) {
    if (!voxels.is_marked(v)) return {};
    const TwinSlab& slab = voxels.slabs[voxels.index(v / voxels.marks)];
    if (slab.there) {
        const double finer = voxels.marks;
        const dvec3 centre = (dvec3(v / voxels.marks) + 0.5) * finer;
        const double height = glm::dot(slab.normal, origin - centre);
        const double rise = glm::dot(slab.normal, direction);
        const double a = (slab.low * finer - height) / rise;
        const double b = (slab.high * finer - height) / rise;
        t_in = std::max(t_in, std::min(a, b));
        t_out = std::min(t_out, std::max(a, b));
    }
    return {t_in <= t_out, 0.5 * (t_in + t_out)};
}

/// The first finer voxel that a ray meets: it is opaque. Its attributes are those of its voxel.
Hit primary_ray_to_marks(const DenseVoxels& voxels, const dvec3& eye, const dvec3& direction) {
    Hit hit;
    const int across = voxels.side * voxels.marks;
    const double finer = voxels.marks;
    cross_voxels(across, eye * finer, direction, 1e30, [&](const ivec3& v, double t_in, double t_out) {
        const Met met = meet(voxels, v, eye * finer, direction, t_in, t_out);
        if (!met.is_met) return true;
        hit.depth = met.middle / finer;
        hit.normal = visible_normal(voxels, v / voxels.marks, eye + direction * hit.depth, direction);
        hit.transmittance = 0.0;
        return false;
    });
    return hit;
}

Hit primary_ray(const DenseVoxels& voxels, const dvec3& eye, const dvec3& direction) {
    if (voxels.marks > 1) return primary_ray_to_marks(voxels, eye, direction);
    Hit hit;
    cross_voxels(voxels.side, eye, direction, 1e30, [&](const ivec3& v, double t_in, double t_out) {
        const double coverage = voxels.coverage[voxels.index(v)];
        if (coverage == 0.0) return true;
        const double left = behind(hit.transmittance, coverage);
        const double weight = hit.transmittance - left;
        const double middle = 0.5 * (t_in + t_out);
        hit.normal += weight * visible_normal(voxels, v, eye + direction * middle, direction);
        if (weight > hit.best_weight) {
            hit.best_weight = weight;
            hit.depth = middle;
        }
        hit.transmittance = left;
        return hit.transmittance > OPAQUE_TRANSMITTANCE;
    });
    if (hit.transmittance <= OPAQUE_TRANSMITTANCE) hit.transmittance = 0.0;
    return hit;
}

double shadow_ray(const DenseVoxels& voxels, const dvec3& receiver, const dvec3& normal,
                  const dvec3& direction, double reach) {
    double visibility = 1.0;
    // Lengths are in sides of what rays meet.
    const double finer = voxels.marks;
    const double self_shadow_reach = std::clamp(2.5 / std::max(glm::dot(normal, direction), 1e-3), 8.0, 64.0);
    cross_voxels(voxels.side * voxels.marks, receiver * finer, direction, reach * finer,
                 [&](const ivec3& v, double t_in, double t_out) {
                     const Met met = voxels.marks == 1
                                         ? Met{true, 0.5 * (t_in + t_out)}
                                         : meet(voxels, v, receiver * finer, direction, t_in, t_out);
                     const double coverage = voxels.marks == 1 ? voxels.coverage[voxels.index(v)]
                                             : met.is_met      ? 1.0
                                                               : 0.0;
                     const bool own = met.middle < self_shadow_reach &&
                                      glm::dot(dvec3(v) + 0.5 - receiver * finer, normal) < 1.75;
                     if (coverage == 0.0 || own) return true;
                     visibility = behind(visibility, coverage);
                     return visibility > OPAQUE_TRANSMITTANCE;
                 });
    return visibility > OPAQUE_TRANSMITTANCE ? visibility : 0.0;
}

double srgb(double c) {
    c = std::clamp(c, 0.0, 1.0);
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
}

}  // namespace

DenseVoxels dense_voxels(const scenes::Scene& scene, int resolution, bool has_marks) {
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    DenseVoxels out;
    out.side = resolution;
    out.grid = voxelizer::grid_around(snapshot.bounds, resolution);
    voxelizer::Surface surface = voxelizer::build_surface(scene, snapshot, out.grid, {.attributes = true});
    const int fine_level = surface.grid.level() + 2;
    std::vector<Gathered> all(std::size_t(resolution) * std::size_t(resolution) * std::size_t(resolution));
    voxelizer::Surface one = surface;
    for (const voxelizer::SurfaceChunk& chunk : surface.chunks) {
        one.chunks = {chunk};
        for (const interop::SurfaceTriangle& triangle : chunk.triangles) {
            one.chunks[0].triangles = {triangle};
            one.triangle_count = 1;
            gather(one, fine_level, resolution, all);
        }
    }
    for (const Gathered& g : all) {
        const double coverage = coverage_of(g);
        out.coverage.push_back(coverage);
        out.normals.push_back(two_normals(g));
    }
    out.marks = has_marks ? 4 : 1;
    if (!has_marks) return out;
    SlabTwin slabs(out.normals);
    add_triangles(surface, fine_level, resolution, out.normals, slabs);
    for (std::size_t i = 0; i < all.size(); ++i)
        out.slabs.push_back(slabs.slab(i, all[i]));
    const int across = 4 * resolution;
    out.marked.resize(std::size_t(across) * std::size_t(across) * std::size_t(across));
    for (int z = 0; z < across; ++z) {
        for (int y = 0; y < across; ++y) {
            for (int x = 0; x < across; ++x) {
                const Gathered& g = all[out.index(ivec3(x, y, z) / 4)];
                out.marked[out.mark_index({x, y, z})] = g.fine[x % 4][y % 4][z % 4];
            }
        }
    }
    return out;
}

optics::Image march_dense(const DenseVoxels& voxels, const renderer::View& view) {
    auto place = [&](const dvec3& world) { return (world - voxels.grid.origin) / voxels.grid.voxel_size; };
    const dvec3 eye = place(view.camera.eye);
    const dvec3 forward = glm::normalize(view.camera.target - view.camera.eye);
    const dvec3 right = glm::normalize(glm::cross(forward, view.camera.up));
    const dvec3 up = glm::cross(right, forward);
    const double half_height = std::tan(0.5 * view.camera.yfov);
    const double half_width = half_height * view.size.width / view.size.height;
    optics::Image image{view.size.width, view.size.height, {}};
    for (int y = 0; y < view.size.height; ++y) {
        for (int x = 0; x < view.size.width; ++x) {
            const double px = (x + 0.5) / view.size.width * 2.0 - 1.0;
            const double py = (y + 0.5) / view.size.height * 2.0 - 1.0;
            const dvec3 direction = glm::normalize(forward + px * half_width * right - py * half_height * up);
            const Hit hit = primary_ray(voxels, eye, direction);
            const double alpha = 1.0 - hit.transmittance;
            dvec3 color(view.background);
            if (alpha > 0.0) {
                const dvec3 normal = glm::length(hit.normal) < 1e-6 ? -direction : glm::normalize(hit.normal);
                const dvec3 point = eye + direction * hit.depth;
                auto to_light = [&](const dvec3& from) {
                    return view.light.positional ? glm::normalize(place(view.light.position) - from)
                                                 : glm::normalize(view.light.towards);
                };
                const double facing = std::max(glm::dot(normal, to_light(point)), 0.0);
                double visibility = 1.0;
                if (view.shadow.kind != renderer::ShadowQuality::Kind::none && facing > 0.0 &&
                    alpha >= 1.0 / 512.0) {
                    const double reach =
                        view.light.positional ? glm::length(place(view.light.position) - point) : 1e30;
                    visibility = shadow_ray(voxels, point, normal, to_light(point), reach);
                }
                const double ambient = view.light.ambient;
                const dvec3 light = dvec3(view.light.color) * (ambient * (0.75 + 0.25 * normal.y) +
                                                               (1.0 - ambient) * facing * visibility);
                color = alpha * light + hit.transmittance * dvec3(view.background);
            }
            for (int k = 0; k < 3; ++k)
                image.rgba.push_back(std::uint8_t(std::lround(255.0 * srgb(color[k]))));
            image.rgba.push_back(std::uint8_t(std::lround(255.0 * std::clamp(alpha, 0.0, 1.0))));
        }
    }
    return image;
}

}  // namespace cairn::test
