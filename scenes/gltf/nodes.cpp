#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenes/gltf/failure.h"
#include "scenes/gltf/reader.h"
#include "scenes/gltf/vertices.h"

namespace cairn::scenes::gltf {
namespace {

void check_finite(const std::string& where, const char* property, const std::vector<double>& numbers) {
    for (const double number : numbers)
        if (!std::isfinite(number)) fail(where, fmt::format("\"{}\" is not finite", property));
}

/// A quaternion of length 1, or no rotation when the file's is zero.
glm::dquat unit_quaternion(double x, double y, double z, double w) {
    const double length = std::sqrt(x * x + y * y + z * z + w * w);
    if (!(length > 0.0) || !std::isfinite(length)) return {1.0, 0.0, 0.0, 0.0};
    return {w / length, x / length, y / length, z / length};
}

Trs read_trs(const std::string& where, const tinygltf::Node& source) {
    Trs trs;
    check_finite(where, "translation", source.translation);
    check_finite(where, "rotation", source.rotation);
    check_finite(where, "scale", source.scale);
    if (const auto& t = source.translation; t.size() == 3) trs.translation = {t[0], t[1], t[2]};
    if (const auto& r = source.rotation; r.size() == 4)
        trs.rotation = unit_quaternion(r[0], r[1], r[2], r[3]);
    if (const auto& s = source.scale; s.size() == 3) trs.scale = {s[0], s[1], s[2]};
    return trs;
}

std::unique_ptr<glm::dmat4> read_matrix(const std::string& where, const std::vector<double>& numbers) {
    check_finite(where, "matrix", numbers);
    auto matrix = std::make_unique<glm::dmat4>();
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            (*matrix)[column][row] =
                numbers[static_cast<std::size_t>(column) * 4 + static_cast<std::size_t>(row)];
    for (int column = 0; column < 4; ++column)
        if (std::abs((*matrix)[column][3] - (column == 3 ? 1.0 : 0.0)) > 1e-6)
            fail(where, "\"matrix\" is no affine transform: its last row is not 0 0 0 1");
    for (int column = 0; column < 4; ++column)
        (*matrix)[column][3] = column == 3 ? 1.0 : 0.0;
    return matrix;
}

/// One attribute of EXT_mesh_gpu_instancing as floats; empty when the file has none.
std::vector<float> read_instance_attribute(Reader& reader, const std::string& where,
                                           const tinygltf::Value& attributes, const char* name, int width,
                                           std::size_t& count) {
    if (!attributes.Has(name)) return {};
    const Elements elements = reader.accessors.elements(where, attributes.Get(name).GetNumberAsInt());
    if (elements.width != width) fail(elements.where, fmt::format("{} must have {} components", name, width));
    if (count != 0 && elements.count != count)
        fail(where, fmt::format("{} has {} elements, another attribute {}", name, elements.count, count));
    count = elements.count;
    reader.budget.charge(where, count, sizeof(Trs));
    std::vector<float> values(count * static_cast<std::size_t>(width));
    read_floats(elements, {}, width, 0.0F, values.data());
    for (const float value : values)
        if (!std::isfinite(value)) fail(elements.where, fmt::format("{} is not finite", name));
    return values;
}

std::vector<Trs> read_instances(Reader& reader, const std::string& node, const tinygltf::Value& extension) {
    const std::string where = node + ", EXT_mesh_gpu_instancing";
    const tinygltf::Value& attributes = extension.Get("attributes");
    std::size_t count = 0;
    const auto translation = read_instance_attribute(reader, where, attributes, "TRANSLATION", 3, count);
    const auto rotation = read_instance_attribute(reader, where, attributes, "ROTATION", 4, count);
    const auto scale = read_instance_attribute(reader, where, attributes, "SCALE", 3, count);
    std::vector<Trs> instances(count);
    for (std::size_t i = 0; i < count; ++i) {
        const float* t = translation.empty() ? nullptr : &translation[3 * i];
        const float* r = rotation.empty() ? nullptr : &rotation[4 * i];
        const float* s = scale.empty() ? nullptr : &scale[3 * i];
        if (t != nullptr) instances[i].translation = {t[0], t[1], t[2]};
        if (r != nullptr) instances[i].rotation = unit_quaternion(r[0], r[1], r[2], r[3]);
        if (s != nullptr) instances[i].scale = {s[0], s[1], s[2]};
    }
    return instances;
}

Node read_node(Reader& reader, const std::string& where, const tinygltf::Node& source) {
    Node node;
    node.name = source.name;
    node.children = source.children;
    node.mesh = source.mesh;
    node.skin = source.mesh < 0 ? -1 : source.skin;
    node.camera = source.camera;
    if (source.matrix.empty())
        node.trs = read_trs(where, source);
    else
        node.matrix = read_matrix(where, source.matrix);
    if (const auto light = source.extensions.find("KHR_lights_punctual"); light != source.extensions.end())
        node.light = light->second.Get("light").GetNumberAsInt();
    const auto visibility = source.extensions.find("KHR_node_visibility");
    if (visibility != source.extensions.end() && visibility->second.Has("visible"))
        node.visible = visibility->second.Get("visible").Get<bool>();
    if (source.mesh < 0) return node;
    const auto& mesh = reader.scene.meshes[static_cast<std::size_t>(source.mesh)];
    node.morph_weights = read_morph_weights(reader, where, source.weights, mesh.morph_weights.size());
    const auto instancing = source.extensions.find("EXT_mesh_gpu_instancing");
    if (instancing != source.extensions.end())
        node.instances = read_instances(reader, where, instancing->second);
    return node;
}

void read_cameras(Reader& reader) {
    for (const tinygltf::Camera& source : reader.source.model.cameras) {
        Camera& camera = reader.scene.cameras.emplace_back();
        camera.name = source.name;
        camera.perspective = source.type == "perspective";
        if (camera.perspective) {
            camera.yfov = source.perspective.yfov;
            camera.znear = source.perspective.znear;
            camera.zfar = source.perspective.zfar;
        } else {
            camera.ymag = source.orthographic.ymag;
            camera.znear = source.orthographic.znear;
            camera.zfar = source.orthographic.zfar;
        }
    }
}

/// Nodes lose lights of a type that is not known.
void read_lights(Reader& reader) {
    const auto& sources = reader.source.model.lights;
    std::vector<bool> known(sources.size(), true);
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const tinygltf::Light& source = sources[i];
        Light& light = reader.scene.lights.emplace_back();
        light.name = source.name;
        if (source.type == "directional")
            light.type = Light::Type::directional;
        else if (source.type == "spot")
            light.type = Light::Type::spot;
        else if (source.type != "point") {
            known[i] = false;
            reader.warn(fmt::format("{}: its \"type\" {} is not known; it does not shine",
                                    reader.source.where(element("light", i, source.name)),
                                    in_quotes(source.type)));
        }
        if (source.color.size() == 3) light.color = {source.color[0], source.color[1], source.color[2]};
        light.intensity = static_cast<float>(source.intensity);
        light.range = static_cast<float>(source.range);
        light.inner_cone = static_cast<float>(source.spot.innerConeAngle);
        light.outer_cone = static_cast<float>(source.spot.outerConeAngle);
    }
    for (Node& node : reader.scene.nodes)
        if (node.light >= 0 && !known[static_cast<std::size_t>(node.light)]) node.light = -1;
}

void read_scenes(Reader& reader) {
    for (const tinygltf::Scene& source : reader.source.model.scenes)
        reader.scene.scenes.push_back({source.name, source.nodes});
    reader.scene.default_scene = std::max(reader.source.model.defaultScene, 0);
    if (!reader.scene.scenes.empty()) return;
    // A file without scenes is a library of parts: show them all.
    std::vector<bool> is_child(reader.scene.nodes.size(), false);
    for (const Node& node : reader.scene.nodes)
        for (const int child : node.children)
            is_child[static_cast<std::size_t>(child)] = true;
    SceneRoots& all = reader.scene.scenes.emplace_back();
    for (std::size_t i = 0; i < is_child.size(); ++i)
        if (!is_child[i]) all.nodes.push_back(static_cast<int>(i));
}

}  // namespace

void read_nodes(Reader& reader) {
    const auto& sources = reader.source.model.nodes;
    for (std::size_t i = 0; i < sources.size(); ++i)
        reader.scene.nodes.push_back(
            read_node(reader, reader.source.where(element("node", i, sources[i].name)), sources[i]));
    read_cameras(reader);
    read_lights(reader);
    read_scenes(reader);
}

void check_forest(Reader& reader) {
    const auto& nodes = reader.scene.nodes;
    const auto where = [&](std::size_t i) { return reader.source.where(element("node", i, nodes[i].name)); };
    std::vector<int> parents(nodes.size(), -1);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (const int child : nodes[i].children) {
            int& parent = parents[static_cast<std::size_t>(child)];
            if (parent >= 0)
                fail(where(static_cast<std::size_t>(child)),
                     fmt::format("it is a child of node {} and of node {}", parent, i));
            parent = static_cast<int>(i);
        }
    // With one parent each, the nodes that no root reaches are those of cycles.
    std::vector<bool> reached(nodes.size(), false);
    std::vector<int> open;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (parents[i] < 0) open.push_back(static_cast<int>(i));
    while (!open.empty()) {
        const auto node = static_cast<std::size_t>(open.back());
        open.pop_back();
        reached[node] = true;
        open.insert(open.end(), nodes[node].children.begin(), nodes[node].children.end());
    }
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (!reached[i]) fail(where(i), "it is its own ancestor");

    for (std::size_t s = 0; s < reader.scene.scenes.size(); ++s) {
        std::vector<int> roots = reader.scene.scenes[s].nodes;
        const std::string scene = reader.source.where(element("scene", s, reader.scene.scenes[s].name));
        for (const int root : roots)
            if (parents[static_cast<std::size_t>(root)] >= 0)
                fail(scene, fmt::format("it lists node {}, which is a child of node {}", root,
                                        parents[static_cast<std::size_t>(root)]));
        std::ranges::sort(roots);
        if (std::ranges::adjacent_find(roots) != roots.end()) fail(scene, "it lists a node twice");
    }
}

}  // namespace cairn::scenes::gltf
