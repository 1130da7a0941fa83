#include "tests/support/volume_twin.h"

#include <algorithm>
#include <cmath>

namespace cairn::test {

Densities densities_of(const renderer::Field& field, int root_side) {
    const renderer::FieldFrame& frame = field.frame();
    Densities densities{frame.origin, frame.voxel_size, root_side, glm::ivec3(frame.size), {}};
    std::vector<float> values(std::size_t(frame.size.x * frame.size.y * frame.size.z));
    field.fill(0, glm::i64vec3(0), densities.size, values.data());
    for (const float value : values)
        densities.voxels.push_back(std::uint8_t(std::lround(value * 255.0F)));
    return densities;
}

double Densities::at(const glm::dvec3& p) const {
    const glm::dvec3 place = p - 0.5;
    const glm::ivec3 low(glm::floor(place));
    const glm::dvec3 f = place - glm::dvec3(low);
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 offset(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::ivec3 v = low + offset;
        if (glm::any(glm::lessThan(v, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(v, size))) continue;
        const glm::dvec3 w = glm::mix(1.0 - f, f, glm::dvec3(offset));
        const std::size_t index =
            std::size_t(v.x) +
            std::size_t(size.x) * (std::size_t(v.y) + std::size_t(size.y) * std::size_t(v.z));
        sum += w.x * w.y * w.z * voxels[index] / 255.0;
    }
    return sum;
}

Gathered march_densities(const Densities& densities, const renderer::TransferFunction& transfer,
                         const glm::dvec3& eye, const glm::dvec3& direction, double steps_a_voxel) {
    Gathered gathered;
    const glm::dvec3 start = (eye - densities.origin) / densities.voxel_size;
    double near = 0.0;
    double far = 1e30;
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0.0) {
            if (start[axis] < 0.0 || start[axis] > densities.root_side) return gathered;
            continue;
        }
        const double a = -start[axis] / direction[axis];
        const double b = (densities.root_side - start[axis]) / direction[axis];
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    if (near >= far) return gathered;
    const auto steps = std::int64_t(std::ceil((far - near) * steps_a_voxel));
    const double step = (far - near) / double(steps);
    for (std::int64_t i = 0; i < steps; ++i) {
        const double density = densities.at(start + direction * (near + (double(i) + 0.5) * step));
        const glm::dvec4 optics = transfer.optics(density);
        if (optics.a <= 0.0) continue;
        const double weight =
            gathered.transmittance * (1.0 - std::exp(-optics.a * step * densities.voxel_size));
        gathered.color += weight * glm::dvec3(optics) / optics.a;
        gathered.transmittance -= weight;
    }
    return gathered;
}

glm::dvec3 pixel_direction(const renderer::View& view, int x, int y) {
    const glm::dvec3 forward = glm::normalize(view.camera.target - view.camera.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, view.camera.up));
    const glm::dvec3 up = glm::cross(right, forward);
    const double half_height = std::tan(0.5 * view.camera.yfov);
    const double half_width = half_height * view.size.width / view.size.height;
    const double px = (x + 0.5) / view.size.width * 2.0 - 1.0;
    const double py = (y + 0.5) / view.size.height * 2.0 - 1.0;
    return glm::normalize(forward + px * half_width * right - py * half_height * up);
}

optics::Image march_densities(const Densities& densities, const renderer::TransferFunction& transfer,
                              const renderer::View& view, double steps_a_voxel) {
    optics::Image image{view.size.width, view.size.height, {}};
    const auto encoded = [](double linear) {
        const double c = std::clamp(linear, 0.0, 1.0);
        const double srgb = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
        return std::uint8_t(std::lround(srgb * 255.0));
    };
    for (int y = 0; y < view.size.height; ++y) {
        for (int x = 0; x < view.size.width; ++x) {
            Gathered seen = march_densities(densities, transfer, view.camera.eye, pixel_direction(view, x, y),
                                            steps_a_voxel);
            if (seen.transmittance <= 1.0 / 512.0) {
                seen.color /= 1.0 - seen.transmittance;
                seen.transmittance = 0.0;
            }
            const glm::dvec3 color =
                glm::dvec3(view.light.color) * seen.color + seen.transmittance * glm::dvec3(view.background);
            for (int channel = 0; channel < 3; ++channel)
                image.rgba.push_back(encoded(color[channel]));
            image.rgba.push_back(std::uint8_t(std::lround((1.0 - seen.transmittance) * 255.0)));
        }
    }
    return image;
}

}  // namespace cairn::test
