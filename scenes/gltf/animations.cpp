#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "scenes/gltf/failure.h"
#include "scenes/gltf/reader.h"

namespace cairn::scenes::gltf {
namespace {

std::vector<float> read_finite(Reader& reader, const std::string& where, const Elements& elements) {
    const auto count = elements.count * static_cast<std::size_t>(elements.width);
    reader.budget.charge(where, count, sizeof(float));
    std::vector<float> values(count);
    read_floats(elements, {}, elements.width, 0.0F, values.data());
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!std::isfinite(values[i])) fail(elements.where, fmt::format("number {} is not finite", i));
    return values;
}

std::vector<float> read_times(Reader& reader, const std::string& where, int accessor) {
    const Elements elements = reader.accessors.elements(where, accessor);
    if (elements.width != 1) fail(elements.where, "key times must be SCALAR");
    if (elements.count == 0) fail(elements.where, "there are no keys");
    auto times = read_finite(reader, where, elements);
    for (std::size_t i = 1; i < times.size(); ++i) {
        if (times[i] < times[i - 1])
            fail(elements.where, fmt::format("key times must increase, but {} follows {} at key {}", times[i],
                                             times[i - 1], i));
        if (times[i] == times[i - 1])
            reader.warn(elements.where + ": key times are equal; the last of them counts from there on");
    }
    return times;
}

std::optional<Path> path_of(const std::string& text) {
    if (text == "translation") return Path::translation;
    if (text == "rotation") return Path::rotation;
    if (text == "scale") return Path::scale;
    if (text == "weights") return Path::weights;
    return std::nullopt;
}

Interpolation interpolation_of(const std::string& where, const std::string& text) {
    if (text == "LINEAR" || text.empty()) return Interpolation::linear;
    if (text == "STEP") return Interpolation::step;
    if (text == "CUBICSPLINE") return Interpolation::cubic_spline;
    fail(where, "unknown \"interpolation\" " + in_quotes(text));
}

/// A node may be moved only by translation, rotation and scale; a matrix that an animation touches is taken
/// apart.
void take_matrix_apart(Node& node) {
    if (node.matrix == nullptr) return;
    const glm::dmat4 matrix = *node.matrix;
    node.trs.translation = glm::dvec3(matrix[3]);
    glm::dmat3 axes(matrix);
    for (int i = 0; i < 3; ++i)
        node.trs.scale[i] = glm::length(axes[i]);
    if (glm::determinant(axes) < 0.0) node.trs.scale.x = -node.trs.scale.x;
    for (int i = 0; i < 3; ++i)
        if (node.trs.scale[i] != 0.0) axes[i] /= node.trs.scale[i];
    const glm::dquat rotation = glm::quat_cast(axes);
    const double length = glm::length(rotation);
    node.trs.rotation =
        length > 0.0 && std::isfinite(length) ? rotation / length : glm::dquat(1.0, 0.0, 0.0, 0.0);
    node.matrix.reset();
}

/// Numbers in one key of a path, 0 when the node has nothing that such a channel could move.
int key_width(const Scene& scene, const Node& node, Path path) {
    if (path == Path::rotation) return 4;
    if (path != Path::weights) return 3;
    return node.mesh < 0
               ? 0
               : static_cast<int>(scene.meshes[static_cast<std::size_t>(node.mesh)].morph_weights.size());
}

std::optional<Channel> read_channel(Reader& reader, const std::string& where,
                                    const tinygltf::Animation& animation,
                                    const tinygltf::AnimationChannel& source) {
    if (source.sampler < 0 || static_cast<std::size_t>(source.sampler) >= animation.samplers.size())
        fail(where, fmt::format("\"sampler\" is {}, the animation has {}", source.sampler,
                                animation.samplers.size()));
    const tinygltf::AnimationSampler& sampler = animation.samplers[static_cast<std::size_t>(source.sampler)];
    const auto path = path_of(source.target_path);
    if (!path) {
        reader.warn(fmt::format("{}: it moves {}, which is not supported; ignored", where,
                                in_quotes(source.target_path)));
        return std::nullopt;
    }
    Channel channel;
    channel.node = source.target_node;
    channel.path = *path;
    channel.interpolation = interpolation_of(where, sampler.interpolation);
    Node& node = reader.scene.nodes[static_cast<std::size_t>(channel.node)];
    channel.width = key_width(reader.scene, node, *path);
    if (channel.width == 0) {
        reader.warn(where + ": it moves the weights of a node without morph targets; ignored");
        return std::nullopt;
    }
    if (*path != Path::weights) take_matrix_apart(node);
    channel.times = read_times(reader, where, sampler.input);
    const Elements values = reader.accessors.elements(where, sampler.output);
    if (values.width != (*path == Path::weights ? 1 : channel.width))
        fail(values.where,
             fmt::format("it has {} components, unfit for {}", values.width, source.target_path));
    channel.values = read_finite(reader, where, values);
    const std::size_t copies = channel.interpolation == Interpolation::cubic_spline ? 3 : 1;
    const std::size_t expected = channel.times.size() * static_cast<std::size_t>(channel.width) * copies;
    if (channel.values.size() != expected)
        fail(values.where, fmt::format("it holds {} numbers, its {} keys need {}", channel.values.size(),
                                       channel.times.size(), expected));
    return channel;
}

}  // namespace

void read_animations(Reader& reader) {
    const auto& sources = reader.source.model.animations;
    for (std::size_t a = 0; a < sources.size(); ++a) {
        const std::string where = reader.source.where(element("animation", a, sources[a].name));
        Animation& animation = reader.scene.animations.emplace_back();
        animation.name = sources[a].name;
        for (std::size_t c = 0; c < sources[a].channels.size(); ++c) {
            auto channel = read_channel(reader, fmt::format("{}, channel {}", where, c), sources[a],
                                        sources[a].channels[c]);
            if (!channel) continue;
            animation.duration = std::max(animation.duration, static_cast<double>(channel->times.back()));
            animation.channels.push_back(std::move(*channel));
        }
    }
}

void read_skins(Reader& reader) {
    const auto& sources = reader.source.model.skins;
    for (std::size_t s = 0; s < sources.size(); ++s) {
        const std::string where = reader.source.where(element("skin", s, sources[s].name));
        Skin& skin = reader.scene.skins.emplace_back();
        skin.joints = sources[s].joints;
        skin.joint_from_mesh.assign(skin.joints.size(), glm::dmat4(1.0));
        if (sources[s].inverseBindMatrices < 0) continue;
        const Elements elements = reader.accessors.elements(where, sources[s].inverseBindMatrices);
        if (elements.width != 16 || elements.component != TINYGLTF_COMPONENT_TYPE_FLOAT)
            fail(elements.where, "inverse bind matrices must be MAT4 of floats");
        if (elements.count < skin.joints.size())
            fail(elements.where,
                 fmt::format("it has {} matrices for {} joints", elements.count, skin.joints.size()));
        const auto numbers = read_finite(reader, where, elements);
        for (std::size_t j = 0; j < skin.joints.size(); ++j)
            for (int i = 0; i < 16; ++i)
                skin.joint_from_mesh[j][i / 4][i % 4] = numbers[16 * j + static_cast<std::size_t>(i)];
    }
    for (std::size_t n = 0; n < reader.scene.nodes.size(); ++n) {
        const Node& node = reader.scene.nodes[n];
        if (node.skin < 0) continue;
        const std::size_t joints = reader.scene.skins[static_cast<std::size_t>(node.skin)].joints.size();
        const std::uint32_t needed = reader.joints_needed[static_cast<std::size_t>(node.mesh)];
        if (needed > joints)
            fail(reader.source.where(element("node", n, node.name)),
                 fmt::format("its mesh names joint {}, its skin has {} joints", needed - 1, joints));
    }
}

}  // namespace cairn::scenes::gltf
