#include "scenes/pose.h"

#include <algorithm>
#include <cmath>

namespace cairn::scenes {
namespace {

/// Which keys stand around a moment, and how far it is between them.
struct Span {
    std::size_t before = 0;
    std::size_t after = 0;
    double fraction = 0.0;
    double length = 0.0;  ///< seconds between the keys
};

Span find_span(const std::vector<float>& times, double seconds) {
    const auto next = std::upper_bound(times.begin(), times.end(), seconds, [](double moment, float key) {
        return moment < static_cast<double>(key);
    });
    if (next == times.begin()) return {};
    const auto before = static_cast<std::size_t>(next - times.begin()) - 1;
    if (next == times.end()) return {before, before, 0.0, 0.0};
    const double start = times[before];
    const double length = static_cast<double>(*next) - start;
    return {before, before + 1, (seconds - start) / length, length};
}

/// Cubic Hermite spline between two keys, each (in-tangent, value, out-tangent).
double cubic(const float* before, const float* after, std::size_t width, std::size_t i, const Span& span) {
    const double t = span.fraction;
    const double t2 = t * t;
    const double t3 = t2 * t;
    return (2.0 * t3 - 3.0 * t2 + 1.0) * before[width + i] +
           span.length * (t3 - 2.0 * t2 + t) * before[2 * width + i] +
           (3.0 * t2 - 2.0 * t3) * after[width + i] + span.length * (t3 - t2) * after[i];
}

/// Channels hold quaternions as (x, y, z, w).
glm::dquat quaternion(const double* xyzw) {
    return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]};
}

glm::dquat normalized(const glm::dquat& q) {
    const double length = glm::length(q);
    return length > 0.0 ? q / length : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

void slerp(std::vector<double>& before, const std::vector<double>& after, double fraction) {
    const glm::dquat q =
        glm::slerp(normalized(quaternion(before.data())), normalized(quaternion(after.data())), fraction);
    before = {q.x, q.y, q.z, q.w};
}

void apply(const Channel& channel, double seconds, Trs& trs, std::vector<float>& weights) {
    const auto value = evaluate(channel, seconds);
    switch (channel.path) {
        case Path::translation:
            trs.translation = {value[0], value[1], value[2]};
            break;
        case Path::rotation:
            trs.rotation = normalized(quaternion(value.data()));
            break;
        case Path::scale:
            trs.scale = {value[0], value[1], value[2]};
            break;
        case Path::weights:
            weights.assign(value.begin(), value.end());
            break;
    }
}

}  // namespace

std::vector<double> evaluate(const Channel& channel, double seconds) {
    const auto width = static_cast<std::size_t>(channel.width);
    const bool is_cubic = channel.interpolation == Interpolation::cubic_spline;
    const std::size_t key_numbers = is_cubic ? 3 * width : width;
    const Span span = find_span(channel.times, seconds);
    const float* before = &channel.values[span.before * key_numbers];
    const float* after = &channel.values[span.after * key_numbers];
    std::vector<double> value(width);
    const bool on_key = span.before == span.after || channel.interpolation == Interpolation::step;
    const std::size_t value_at = is_cubic ? width : 0;
    for (std::size_t i = 0; i < width; ++i)
        value[i] = is_cubic && !on_key ? cubic(before, after, width, i, span)
                                       : static_cast<double>(before[value_at + i]);
    if (on_key || is_cubic) return value;
    std::vector<double> next(after, after + width);
    if (channel.path == Path::rotation) {
        slerp(value, next, span.fraction);
        return value;
    }
    for (std::size_t i = 0; i < width; ++i)
        value[i] += (next[i] - value[i]) * span.fraction;
    return value;
}

glm::dmat4 matrix_of(const Trs& trs) {
    const glm::dmat3 rotation = glm::mat3_cast(trs.rotation);
    return {glm::dvec4(rotation[0] * trs.scale.x, 0.0), glm::dvec4(rotation[1] * trs.scale.y, 0.0),
            glm::dvec4(rotation[2] * trs.scale.z, 0.0), glm::dvec4(trs.translation, 1.0)};
}

Pose take_pose(const Scene& scene, const Animation* animation, double seconds) {
    const std::size_t count = scene.nodes.size();
    Pose pose;
    pose.morph_weights.resize(count);
    std::vector<Trs> moved;
    moved.reserve(count);
    for (const Node& node : scene.nodes)
        moved.push_back(node.trs);
    if (animation != nullptr)
        for (const Channel& channel : animation->channels) {
            const auto node = static_cast<std::size_t>(channel.node);
            apply(channel, seconds, moved[node], pose.morph_weights[node]);
        }

    std::vector<bool> is_child(count, false);
    for (const Node& node : scene.nodes)
        for (const int child : node.children)
            is_child[static_cast<std::size_t>(child)] = true;
    // Parents before children, without recursion: hierarchies may be a million nodes deep.
    pose.world_from_node.assign(count, glm::dmat4(1.0));
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < count; ++i)
        if (!is_child[i]) open.push_back(i);
    while (!open.empty()) {
        const std::size_t i = open.back();
        open.pop_back();
        const Node& node = scene.nodes[i];
        // Up to here it holds the parent's matrix.
        glm::dmat4& world = pose.world_from_node[i];
        world = world * (node.matrix != nullptr ? *node.matrix : matrix_of(moved[i]));
        for (const int child : node.children) {
            pose.world_from_node[static_cast<std::size_t>(child)] = world;
            open.push_back(static_cast<std::size_t>(child));
        }
    }
    return pose;
}

}  // namespace cairn::scenes
