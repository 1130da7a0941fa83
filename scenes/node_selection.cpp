#include <charconv>
#include <optional>

#include "base/error.h"
#include "scenes/snapshot.h"

namespace cairn::scenes {
namespace {

std::optional<std::size_t> index_in(const Scene& scene, const std::string& text) {
    std::size_t index = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, fault] = std::from_chars(text.data(), end, index);
    if (fault != std::errc() || rest != end || index >= scene.nodes.size()) return std::nullopt;
    return index;
}

std::vector<std::size_t> nodes_called(const Scene& scene, const std::string& text) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i)
        if (!text.empty() && scene.nodes[i].name == text) found.push_back(i);
    if (found.empty()) {
        if (const std::optional<std::size_t> index = index_in(scene, text)) found.push_back(*index);
    }
    return found;
}

/// "0 "ground", 1 "bunny", ...": a scene may have thousands.
std::string list_of_nodes(const Scene& scene) {
    constexpr std::size_t most = 40;
    std::string list;
    for (std::size_t i = 0; i < scene.nodes.size() && i < most; ++i)
        list += (i > 0 ? ", " : "") + std::to_string(i) + " \"" + scene.nodes[i].name + "\"";
    if (scene.nodes.size() > most) list += ", and " + std::to_string(scene.nodes.size() - most) + " more";
    return list.empty() ? "none" : list;
}

}  // namespace

NodeSelection select_nodes(const Scene& scene, std::span<const std::string> wanted) {
    NodeSelection selection(scene.nodes.size(), false);
    std::vector<std::size_t> open;
    for (const std::string& text : wanted) {
        const std::vector<std::size_t> found = nodes_called(scene, text);
        if (found.empty()) {
            throw Error(Fault::usage, scene.name, "no node has the name or the index \"" + text + "\"",
                        "its nodes are: " + list_of_nodes(scene));
        }
        open.insert(open.end(), found.begin(), found.end());
    }
    while (!open.empty()) {
        const std::size_t node = open.back();
        open.pop_back();
        if (selection[node]) continue;
        selection[node] = true;
        for (const int child : scene.nodes[node].children)
            open.push_back(std::size_t(child));
    }
    return selection;
}

NodeSelection other_nodes(const NodeSelection& selection) {
    NodeSelection others = selection;
    others.flip();
    return others;
}

Snapshot part_of(const Snapshot& whole, const NodeSelection& selection) {
    Snapshot part;
    for (const Item& item : whole.items) {
        if (!selection[std::size_t(item.node)]) continue;
        part.items.push_back(item);
        const Primitive& primitive = *item.primitive;
        for (const std::uint32_t vertex : primitive.indices)
            part.bounds.add(item.world(vertex));
        switch (primitive.topology) {
            case Topology::triangles:
                part.triangle_count += primitive.element_count();
                break;
            case Topology::lines:
                part.line_count += primitive.element_count();
                break;
            case Topology::points:
                part.point_count += primitive.element_count();
                break;
        }
    }
    return part;
}

}  // namespace cairn::scenes
