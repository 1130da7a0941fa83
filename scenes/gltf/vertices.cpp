#include "scenes/gltf/vertices.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenes/gltf/failure.h"

namespace cairn::scenes::gltf {
namespace {

bool finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void check_count(const VertexSource& source, const Elements& elements) {
    if (elements.count != source.positions.count)
        fail(elements.where,
             fmt::format("it has {} elements, POSITION has {}", elements.count, source.positions.count));
}

/// An attribute as vectors of `Vector`, checked for its count and its number of components.
template <typename Vector>
std::vector<Vector> read_vectors(const VertexSource& source, const Elements& elements, int least_width,
                                 float filler = 0.0F) {
    constexpr int width = Vector::length();
    if (elements.width < least_width || elements.width > width)
        fail(elements.where,
             fmt::format("it has {} components where {} are expected", elements.width, width));
    check_count(source, elements);
    source.reader.budget.charge(elements.where, source.count, sizeof(Vector));
    std::vector<Vector> result(source.count);
    if (!result.empty()) read_floats(elements, source.kept, width, filler, &result.front().x);
    return result;
}

void check_finite(const std::string& where, const std::vector<glm::vec3>& vectors) {
    for (std::size_t i = 0; i < vectors.size(); ++i)
        if (!finite(vectors[i])) fail(where, fmt::format("vertex {} is not finite", i));
}

/// Normals and texture coordinates only shade: one that is not finite becomes zero, with a warning.
template <typename Vector>
void mend(const VertexSource& source, const char* what, std::vector<Vector>& vectors) {
    bool mended = false;
    for (Vector& vector : vectors)
        for (int c = 0; c < Vector::length(); ++c)
            if (!std::isfinite(vector[c])) {
                vector[c] = 0.0F;
                mended = true;
            }
    if (mended)
        source.reader.warn(fmt::format("{}: some of its {} are not finite and became 0", source.where, what));
}

void read_colors(const VertexSource& source, Primitive& result) {
    const Elements elements = source.elements("COLOR_0");
    const auto colors = read_vectors<glm::vec4>(source, elements, 3, 1.0F);
    result.colors.reserve(colors.size());
    for (const glm::vec4& color : colors) {
        glm::u16vec4 steps;
        for (int c = 0; c < 4; ++c) {  // the comparison is false for NaN, too
            const float clamped = color[c] > 0.0F ? std::min(color[c], 1.0F) : 0.0F;
            steps[c] = static_cast<std::uint16_t>(std::lround(clamped * 65535.0F));
        }
        result.colors.push_back(steps);
    }
}

/// Joints and weights of one set, four influences a vertex. Weights that are negative or not finite count as
/// 0.
std::vector<SkinWeights> read_skin_set(const VertexSource& source, int set) {
    const Elements joint_elements = source.elements(fmt::format("JOINTS_{}", set));
    const auto weights = read_vectors<glm::vec4>(source, source.elements(fmt::format("WEIGHTS_{}", set)), 4);
    check_count(source, joint_elements);
    if (joint_elements.width != 4) fail(joint_elements.where, "joints must be VEC4");
    source.reader.budget.charge(source.where, source.count, sizeof(SkinWeights) + sizeof(glm::uvec4));
    std::vector<glm::uvec4> joints(source.count);
    if (!joints.empty()) read_integers(joint_elements, source.kept, 4, &joints.front().x);
    std::vector<SkinWeights> result(source.count);
    for (std::size_t i = 0; i < result.size(); ++i)
        for (int c = 0; c < 4; ++c) {
            const float weight = weights[i][c];
            if (!(weight > 0.0F) || !std::isfinite(weight)) continue;  // both stay 0
            if (joints[i][c] > 0xFFFF)
                fail(joint_elements.where, fmt::format("vertex {} names joint {}", i, joints[i][c]));
            result[i].weights[c] = weight;
            result[i].joints[c] = static_cast<std::uint16_t>(joints[i][c]);
        }
    return result;
}

/// Every multiple of 1 / weight_steps up to 1 is a float.
constexpr std::int64_t weight_steps = 1 << 24;

/// Scales the weights of each vertex, over all sets, to the sum 1, exactly.
void normalize_weights(Primitive& result) {
    for (std::size_t i = 0; i < result.skin.size(); ++i) {
        double sum = 0.0;
        const auto add = [&](const SkinWeights& set) {
            for (int c = 0; c < 4; ++c)
                sum += set.weights[c];
        };
        add(result.skin[i]);
        for (const auto& set : result.more_skin)
            add(set[i]);
        if (sum <= 0.0) continue;
        // In whole steps, of which the largest weight takes what rounding leaves: the sum is 1 and nothing
        // near it, else a vertex would shrink towards the world's origin, by metres where that is an Earth's
        // radius away.
        std::int64_t left = weight_steps;
        float* largest = &result.skin[i].weights.x;
        const auto scale = [&](SkinWeights& set) {
            for (int c = 0; c < 4; ++c) {
                float& weight = set.weights[c];
                const auto steps = static_cast<std::int64_t>(std::lround(weight / sum * weight_steps));
                weight = static_cast<float>(steps) / static_cast<float>(weight_steps);
                left -= steps;
                if (weight > *largest) largest = &weight;
            }
        };
        scale(result.skin[i]);
        for (auto& set : result.more_skin)
            scale(set[i]);
        *largest += static_cast<float>(left) / static_cast<float>(weight_steps);
    }
}

void read_skin(const VertexSource& source, Primitive& result) {
    for (int set = 0; source.has(fmt::format("JOINTS_{}", set)) && source.has(fmt::format("WEIGHTS_{}", set));
         ++set) {
        auto weights = read_skin_set(source, set);
        if (set == 0)
            result.skin = std::move(weights);
        else
            result.more_skin.push_back(std::move(weights));
    }
    normalize_weights(result);
}

void read_texcoords(const VertexSource& source, Primitive& result) {
    if (result.material < 0) return;
    const int set = source.reader.texcoord_sets[static_cast<std::size_t>(result.material)];
    if (set < 0) return;
    const std::string name = fmt::format("TEXCOORD_{}", set);
    if (!source.has(name)) {
        source.reader.warn(
            fmt::format("{}: its material has a texture, but it has no {}", source.where, name));
        return;
    }
    result.texcoords = read_vectors<glm::vec2>(source, source.elements(name), 2);
    mend(source, "texture coordinates", result.texcoords);
}

}  // namespace

Elements VertexSource::elements(const std::string& name) const {
    if (const auto found = unpacked.find(name); found != unpacked.end()) return found->second;
    return reader.accessors.elements(where, attributes.at(name));
}

void read_vertices(const VertexSource& source, Primitive& result) {
    result.positions = read_vectors<glm::vec3>(source, source.positions, 3);
    check_finite(source.positions.where, result.positions);
    if (source.has("NORMAL")) {
        result.normals = read_vectors<glm::vec3>(source, source.elements("NORMAL"), 3);
        mend(source, "normals", result.normals);
    }
    if (source.has("COLOR_0")) read_colors(source, result);
    read_texcoords(source, result);
    read_skin(source, result);
}

void read_morph_targets(const VertexSource& source, const std::vector<std::map<std::string, int>>& targets,
                        Primitive& result) {
    for (std::size_t t = 0; t < targets.size(); ++t) {
        const std::string where = fmt::format("{}, morph target {}", source.where, t);
        MorphTarget& target = result.morph_targets.emplace_back();
        const auto read = [&](const char* name) -> std::vector<glm::vec3> {
            const auto found = targets[t].find(name);
            if (found == targets[t].end()) return {};
            return read_vectors<glm::vec3>(source, source.reader.accessors.elements(where, found->second), 3);
        };
        target.positions = read("POSITION");
        check_finite(where, target.positions);
        target.normals = read("NORMAL");
        mend(source, "morphed normals", target.normals);
    }
}

std::vector<float> read_morph_weights(Reader& reader, const std::string& where,
                                      const std::vector<double>& weights, std::size_t target_count) {
    if (weights.empty()) return {};
    if (weights.size() != target_count)
        reader.warn(fmt::format("{}: it has {} weights for {} morph targets; others are 0 or ignored", where,
                                weights.size(), target_count));
    std::vector<float> result(target_count, 0.0F);
    for (std::size_t i = 0; i < std::min(weights.size(), target_count); ++i) {
        const auto narrow = static_cast<float>(weights[i]);
        result[i] = std::isfinite(narrow) ? narrow : 0.0F;
    }
    return result;
}

std::uint32_t joints_needed_by(const Mesh& mesh) {
    std::uint32_t needed = 0;
    const auto look = [&](const std::vector<SkinWeights>& set) {
        for (const SkinWeights& vertex : set)
            for (int c = 0; c < 4; ++c)
                needed = std::max<std::uint32_t>(needed, vertex.joints[c] + 1U);
    };
    for (const Primitive& primitive : mesh.primitives) {
        look(primitive.skin);
        for (const auto& set : primitive.more_skin)
            look(set);
    }
    return needed;
}

}  // namespace cairn::scenes::gltf
