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
    before[0] = q.x;
    before[1] = q.y;
    before[2] = q.z;
    before[3] = q.w;
}

/// @param next  room for the values of the later key
void evaluate_into(const Channel& channel, double seconds, std::vector<double>& value,
                   std::vector<double>& next) {
    const auto width = static_cast<std::size_t>(channel.width);
    const bool is_cubic = channel.interpolation == Interpolation::cubic_spline;
    const std::size_t key_numbers = is_cubic ? 3 * width : width;
    const Span span = find_span(channel.times, seconds);
    const float* before = &channel.values[span.before * key_numbers];
    const float* after = &channel.values[span.after * key_numbers];
    const bool on_key = span.before == span.after || channel.interpolation == Interpolation::step;
    const std::size_t value_at = is_cubic ? width : 0;
    value.resize(width);
    for (std::size_t i = 0; i < width; ++i)
        value[i] = is_cubic && !on_key ? cubic(before, after, width, i, span)
                                       : static_cast<double>(before[value_at + i]);
    if (on_key || is_cubic) return;
    next.assign(after, after + width);
    if (channel.path == Path::rotation) {
        slerp(value, next, span.fraction);
        return;
    }
    for (std::size_t i = 0; i < width; ++i)
        value[i] += (next[i] - value[i]) * span.fraction;
}

}  // namespace

std::vector<double> evaluate(const Channel& channel, double seconds) {
    std::vector<double> value;
    std::vector<double> next;
    evaluate_into(channel, seconds, value, next);
    return value;
}

glm::dmat4 matrix_of(const Trs& trs) {
    const glm::dmat3 rotation = glm::mat3_cast(trs.rotation);
    return {glm::dvec4(rotation[0] * trs.scale.x, 0.0), glm::dvec4(rotation[1] * trs.scale.y, 0.0),
            glm::dvec4(rotation[2] * trs.scale.z, 0.0), glm::dvec4(trs.translation, 1.0)};
}

Poser::Poser(const Scene& scene, const Animation* animation)
    : scene_(scene), animation_(animation), parents_(scene.nodes.size(), -1) {
    const std::size_t count = scene.nodes.size();
    pose_.world_from_node.resize(count);
    pose_.morph_weights.resize(count);
    moved_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        moved_.push_back(scene.nodes[i].trs);
        for (const int child : scene.nodes[i].children)
            parents_[static_cast<std::size_t>(child)] = static_cast<int>(i);
    }
    // Breadth first, without recursion: hierarchies may be a million nodes deep.
    order_.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        if (parents_[i] < 0) order_.push_back(i);
    for (std::size_t done = 0; done < order_.size(); ++done)
        for (const int child : scene.nodes[order_[done]].children)
            order_.push_back(static_cast<std::size_t>(child));
}

void Poser::apply(const Channel& channel, double seconds) {
    const auto node = static_cast<std::size_t>(channel.node);
    Trs& trs = moved_[node];
    evaluate_into(channel, seconds, value_, next_);
    switch (channel.path) {
        case Path::translation:
            trs.translation = {value_[0], value_[1], value_[2]};
            break;
        case Path::rotation:
            trs.rotation = normalized(quaternion(value_.data()));
            break;
        case Path::scale:
            trs.scale = {value_[0], value_[1], value_[2]};
            break;
        case Path::weights:
            pose_.morph_weights[node].assign(value_.begin(), value_.end());
            break;
    }
}

const Pose& Poser::at(double seconds) {
    // Every channel writes what it moves at every moment, so nothing of the last one stays.
    if (animation_ != nullptr)
        for (const Channel& channel : animation_->channels)
            apply(channel, seconds);
    for (const std::size_t i : order_) {
        const Node& node = scene_.nodes[i];
        const glm::dmat4 parent =
            parents_[i] < 0 ? glm::dmat4(1.0) : pose_.world_from_node[static_cast<std::size_t>(parents_[i])];
        pose_.world_from_node[i] = parent * (node.matrix != nullptr ? *node.matrix : matrix_of(moved_[i]));
    }
    return pose_;
}

glm::dmat4 world_from_instance(const Node& node, const glm::dmat4& world_from_node, int instance) {
    if (instance < 0) return world_from_node;
    return world_from_node * matrix_of(node.instances[static_cast<std::size_t>(instance)]);
}

glm::dmat4 world_by_joint(const Skin& skin, const Pose& pose, std::size_t joint) {
    return pose.world_from_node[static_cast<std::size_t>(skin.joints[joint])] * skin.joint_from_mesh[joint];
}

std::span<const float> morph_weights_of(const Scene& scene, const Pose& pose, std::size_t node) {
    if (!pose.morph_weights[node].empty()) return pose.morph_weights[node];
    const Node& its = scene.nodes[node];
    if (!its.morph_weights.empty()) return its.morph_weights;
    return scene.meshes[static_cast<std::size_t>(its.mesh)].morph_weights;
}

Pose take_pose(const Scene& scene, const Animation* animation, double seconds) {
    return Poser(scene, animation).at(seconds);
}

}  // namespace cairn::scenes
