#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "base/error.h"
#include "reference/shadow_truth.h"

namespace cairn::reference {
namespace {

constexpr int strata = 8;  // an axis
constexpr int round_samples = strata * strata;
constexpr int least_rounds = 4;  // a spread of fewer says little
constexpr int most_exact_strata = 256;
constexpr double far_away = 1e5;  // diagonals of the scene

/// SplitMix64 (Steele, Lea, Flood 2014): a stream for each point, whatever thread it runs on.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    double unit() { return double(next() >> 11U) * 0x1p-53; }
    std::uint64_t next() {
        std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
        z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
        z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
        return z ^ (z >> 31U);
    }

private:
    std::uint64_t state_;
};

/// The unit square to the unit disk, strata staying compact (Shirley and Chiu 1997).
glm::dvec2 on_disk(double x, double y) {
    const double a = 2.0 * x - 1.0;
    const double b = 2.0 * y - 1.0;
    if (a == 0.0 && b == 0.0) return {0.0, 0.0};
    constexpr double quarter = std::numbers::pi / 4.0;
    const bool wide = std::abs(a) > std::abs(b);
    const double r = wide ? a : b;
    const double angle = wide ? quarter * b / a : 2.0 * quarter - quarter * a / b;
    return {r * std::cos(angle), r * std::sin(angle)};
}

/// A light with a place, which a directional one has far away.
optics::Light placed(const optics::Light& light, const ImageTracer& tracer) {
    if (light.positional) return light;
    const double distance = far_away * tracer.diagonal();
    optics::Light sphere = light;
    sphere.positional = true;
    sphere.shape = optics::LightShape::sphere;
    sphere.position = tracer.centre() + distance * glm::normalize(light.towards);
    sphere.radius = distance * std::sin(light.angle);
    return sphere;
}

/// The point of a positional light that the sample (x, y) of the unit square stands for, as seen from
/// `point`.
glm::dvec3 sample_of(const optics::Light& light, const glm::dvec3& point, double x, double y) {
    if (light.shape == optics::LightShape::rectangle)
        return light.position + (2.0 * x - 1.0) * light.half_u + (2.0 * y - 1.0) * light.half_v;
    const glm::dvec2 disk = on_disk(x, y);
    if (light.shape == optics::LightShape::disk)
        return light.position + disk.x * light.half_u + disk.y * light.half_v;
    // The cone around the sphere: 1 - cosine grows with the square of the disk's radius.
    const glm::dvec3 way = light.position - point;
    const double distance = glm::length(way);
    const glm::dvec3 axis = way / distance;
    const double sine = light.radius / distance;
    const double widest = sine * sine / (1.0 + std::sqrt(1.0 - sine * sine));  // 1 - cosine, without loss
    const double lost = widest * glm::dot(disk, disk);
    const double across = disk == glm::dvec2(0.0) ? 0.0 : std::sqrt(lost * (2.0 - lost)) / glm::length(disk);
    const glm::dvec3 side =
        glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 direction =
        (1.0 - lost) * axis + across * (disk.x * side + disk.y * glm::cross(axis, side));
    const double along = glm::dot(direction, way);
    const double under = light.radius * light.radius - (distance * distance - along * along);
    return point + direction * (along - std::sqrt(std::max(under, 0.0)));
}

void check_question(std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals,
                    const optics::Light& light, const AreaLightOptions& options) {
    const auto refuse = [](const char* what) { throw Error(Fault::usage, "area light", what); };
    if (!normals.empty() && normals.size() != points.size()) refuse("there must be one normal a point");
    if (!(options.standard_error > 0.0) || options.least_samples < 1 || options.most_samples < 1)
        refuse("the standard error and the counts of samples must be positive");
    if (options.exact_strata < 0 || options.exact_strata > most_exact_strata)
        refuse("there are at most 256 x 256 strata");
    if (light.shape != optics::LightShape::sphere) {
        if (!(glm::length(glm::cross(light.half_u, light.half_v)) > 0.0))
            refuse("its half axes span no area");
        return;
    }
    if (!(light.radius > 0.0)) refuse("its radius or its angle is not positive");
    for (const glm::dvec3& point : points)
        if (!(glm::distance(point, light.position) > light.radius)) refuse("a point lies inside the sphere");
}

/// One sample in each of across x across strata. The rays go together, as many at once as Embree takes.
/// @return how many see the light
int visible_in_strata(const ImageTracer& tracer, const glm::dvec3& point, const glm::dvec3& normal,
                      const optics::Light& light, int across, ImageTracer::Rays rays, Random& random) {
    std::array<glm::dvec3, 8> samples;
    std::size_t waiting = 0;
    int visible = 0;
    const auto send = [&] {
        visible += tracer.count_reached(point, std::span(samples).first(waiting), rays);
        waiting = 0;
    };
    for (int stratum = 0; stratum < across * across; ++stratum) {
        const int column = stratum % across;
        const int row = stratum / across;
        const double x = (column + random.unit()) / across;
        const double y = (row + random.unit()) / across;
        const glm::dvec3 sample = sample_of(light, point, x, y);
        if (normal != glm::dvec3(0.0) && glm::dot(sample - point, normal) <= 0.0) continue;
        samples[waiting++] = sample;
        if (waiting == samples.size()) send();
    }
    send();
    return visible;
}

LightVisibility visibility_of(const ImageTracer& tracer, const glm::dvec3& point, const glm::dvec3& normal,
                              const optics::Light& light, const AreaLightOptions& options,
                              std::uint64_t stream) {
    Random random(Random(options.seed + stream).next());
    const auto visible_share = [&](int across) {
        return double(visible_in_strata(tracer, point, normal, light, across, options.rays, random)) /
               (across * across);
    };
    if (options.exact_strata > 0) {
        return {visible_share(options.exact_strata), 0.5 / options.exact_strata,
                options.exact_strata * options.exact_strata};
    }
    const int enough = std::max(least_rounds, (options.least_samples + round_samples - 1) / round_samples);
    const int most = std::max(enough, options.most_samples / round_samples);
    double mean = 0.0;
    double squares = 0.0;  // of deviations from the mean, as rounds come in (Welford 1962)
    LightVisibility result;
    for (int round = 1; round <= most; ++round) {
        const double value = visible_share(strata);
        const double before = value - mean;
        mean += before / round;
        squares += before * (value - mean);
        result = {mean, round > 1 ? std::sqrt(squares / (double(round) * (round - 1))) : 1.0,
                  round * round_samples};
        if (round >= enough && result.standard_error < options.standard_error) break;
    }
    return result;
}

}  // namespace

std::vector<LightVisibility> area_light_visibility(const ImageTracer& tracer,
                                                   std::span<const glm::dvec3> points,
                                                   std::span<const glm::dvec3> normals,
                                                   const optics::Light& light,
                                                   const AreaLightOptions& options) {
    const optics::Light sampled = placed(light, tracer);
    check_question(points, normals, sampled, options);
    std::vector<LightVisibility> visibilities(points.size());
    tbb::task_arena arena(options.threads > 0 ? options.threads : int(tbb::task_arena::automatic));
    arena.execute([&] {
        tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
            const glm::dvec3 normal = normals.empty() ? glm::dvec3(0.0) : normals[i];
            visibilities[i] = visibility_of(tracer, points[i], normal, sampled, options, i);
        });
    });
    return visibilities;
}

}  // namespace cairn::reference
