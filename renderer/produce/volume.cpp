// Pre-integrated transfer functions: Engel, Kraus and Ertl 2001, "High-quality pre-integrated volume
// rendering using hardware-accelerated pixel shading", sections 3 and 3.2.
#include "renderer/produce/volume.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "shaders/interop/volume.h"

namespace cairn::renderer {
namespace {

static_assert(density_steps == DENSITY_STEPS && volume_most_steps == VOLUME_MOST_STEPS,
              "the shaders distinguish other densities");

constexpr double step = 1.0 / (DENSITY_STEPS - 1);

[[noreturn]] void fail(const std::string& what, const std::string& way_out) {
    throw Error(Fault::usage, "transfer function", what, way_out);
}

void check_points(const std::vector<ControlPoint>& points) {
    if (points.empty()) fail("it has no control points", "give it at least one");
    double last = 0.0;
    for (const ControlPoint& point : points) {
        if (!(point.value >= 0.0 && point.value <= 1.0))
            fail(fmt::format("density {} is not in [0, 1]", point.value),
                 "0 and 1 are the least and the greatest");
        if (point.value < last)
            fail(fmt::format("density {} comes after {}", point.value, last),
                 "list the points in ascending order");
        if (!(point.extinction >= 0.0) || !std::isfinite(point.extinction))
            fail(fmt::format("extinction {} is not a number from 0 on", point.extinction), "0 is invisible");
        for (int channel = 0; channel < 3; ++channel) {
            if (!(point.color[channel] >= 0.0 && point.color[channel] <= 1.0))
                fail(fmt::format("colour {} is not in [0, 1]", point.color[channel]),
                     "colours are linear, 1 is full");
        }
        last = point.value;
    }
}

glm::dvec4 optics_of(const glm::dvec3& color, double extinction) {
    return {color * extinction, extinction};
}

glm::dvec4 between(const std::vector<ControlPoint>& points, double value) {
    const auto after =
        std::find_if(points.begin(), points.end(), [value](const auto& p) { return p.value >= value; });
    if (after == points.end()) return optics_of(points.back().color, points.back().extinction);
    if (after == points.begin() || after->value == value) return optics_of(after->color, after->extinction);
    const ControlPoint& before = *std::prev(after);
    const double f = (value - before.value) / (after->value - before.value);
    return optics_of(glm::mix(before.color, after->color, f),
                     std::lerp(before.extinction, after->extinction, f));
}

}  // namespace

TransferFunction::TransferFunction(const std::vector<ControlPoint>& points) {
    check_points(points);
    for (std::size_t i = 0; i < optics_.size(); ++i)
        optics_[i] = between(points, double(i) * step);
    for (std::size_t i = 1; i < optics_.size(); ++i)
        integral_[i] = integral_[i - 1] + 0.5 * step * (optics_[i - 1] + optics_[i]);
}

glm::dvec4 TransferFunction::optics(double density) const {
    const double place = std::clamp(density, 0.0, 1.0) / step;
    const auto low = std::min<std::size_t>(std::size_t(place), DENSITY_STEPS - 2);
    return glm::mix(optics_[low], optics_[low + 1], place - double(low));
}

glm::dvec4 TransferFunction::mean_optics(int from, int to) const {
    if (from == to) return optics_[std::size_t(from)];
    return (integral_[std::size_t(to)] - integral_[std::size_t(from)]) / (step * (to - from));
}

std::array<bool, DENSITY_STEPS> TransferFunction::visible() const {
    std::array<bool, DENSITY_STEPS> shown{};
    for (std::size_t i = 0; i < shown.size(); ++i)
        shown[i] = optics_[i].a > 0.0;
    return shown;
}

}  // namespace cairn::renderer
