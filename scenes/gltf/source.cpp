#include "scenes/gltf/source.h"

#include <algorithm>
#include <regex>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/gltf/container.h"
#include "scenes/gltf/failure.h"
#include "scenes/gltf/limits.h"
#include "scenes/gltf/schema.h"
#include "scenes/gltf/uri.h"

namespace cairn::scenes::gltf {
namespace {

using nlohmann::json;

/// The first line of a library's message, without "[json.exception.parse_error.101]".
std::string first_line(std::string text) {
    if (text.starts_with("[json.exception")) text.erase(0, std::min(text.size(), text.find("] ") + 2));
    text.resize(std::min({text.size(), text.find('\n'), std::size_t{200}}));
    // It may quote bytes of the file that are no text.
    for (char& letter : text)
        if (static_cast<unsigned char>(letter) < 0x20 || static_cast<unsigned char>(letter) > 0x7E)
            letter = '?';
    return text;
}

json parse_json(const std::string& name, std::string_view text, const Limits& limits) {
    check_json_size(name, text, limits);
    try {
        return json::parse(text.begin(), text.end());
    } catch (const json::exception& error) {
        fail(name, "its JSON is broken: " + first_line(error.what()));
    }
}

void check_version(const std::string& name, const json& document) {
    const json& asset = document.at("asset");
    for (const char* key : {"version", "minVersion"}) {
        if (!asset.contains(key)) continue;
        const auto& version = asset.at(key).get_ref<const std::string&>();
        const bool newer_needed = std::string_view(key) == "minVersion" && version != "2.0";
        if (!version.starts_with("2.") || newer_needed)
            fail(name, fmt::format("it is glTF of {} {}; only 2.0 is read", key, in_quotes(version)),
                 "convert it to glTF 2.0");
    }
}

json take_array(json& document, const char* key) {
    json taken = json::array();
    const auto found = document.find(key);
    if (found == document.end()) return taken;
    taken = std::move(*found);
    document.erase(found);
    return taken;
}

std::optional<std::string> take_string(json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end()) return std::nullopt;
    return std::move(found->get_ref<std::string&>());
}

/// Buffers and images leave the document: tinygltf would read and decode them all at once, and crashes on
/// some.
void take_buffers_and_images(Source& source, json& document) {
    for (json& buffer : take_array(document, "buffers"))
        source.buffers.push_back({take_string(buffer, "uri"), buffer.at("byteLength").get<std::uint64_t>()});
    for (json& image : take_array(document, "images"))
        source.images.push_back({take_string(image, "name").value_or(""), take_string(image, "uri"),
                                 image.contains("bufferView") ? image.at("bufferView").get<int>() : -1});
}

/// tinygltf refuses index accessors without a buffer view, which Draco and sparse accessors are allowed: they
/// are lent one that does not exist in the file.
void lend_views(Source& source, json& document) {
    if (!document.contains("bufferViews")) document["bufferViews"] = json::array();
    json& views = document.at("bufferViews");
    source.no_view = static_cast<int>(views.size());
    views.push_back({{"buffer", 0}, {"byteLength", 0}});
    if (!document.contains("accessors")) return;
    for (json& accessor : document.at("accessors"))
        if (!accessor.contains("bufferView")) accessor["bufferView"] = source.no_view;
}

/// KHR_animation_pointer: a pointer to a node's translation, rotation, scale or weights becomes the channel's
/// node and path, as glTF itself writes them. Other pointers stay as the path, for animations.cpp to tell:
/// with some node, for tinygltf passes over channels without one.
void follow_pointers(json& document) {
    static const std::regex to_node(R"(/nodes/(\d{1,9})/(translation|rotation|scale|weights))");
    const std::size_t node_count = document.contains("nodes") ? document.at("nodes").size() : 0;
    if (!document.contains("animations")) return;
    for (json& animation : document.at("animations"))
        for (json& channel : animation.at("channels")) {
            json& target = channel.at("target");
            if (target.at("path") != "pointer" || !target.contains("extensions")) continue;
            const json extensions = std::exchange(target["extensions"], json::object());
            if (!extensions.contains("KHR_animation_pointer")) continue;
            const auto pointer = extensions.at("KHR_animation_pointer").at("pointer").get<std::string>();
            target["node"] = 0;
            target["path"] = pointer;
            std::smatch parts;
            if (!std::regex_match(pointer, parts, to_node)) continue;
            const std::size_t node = std::stoul(parts[1]);
            if (node >= node_count) continue;
            target["node"] = node;
            target["path"] = parts[2].str();
        }
}

void parse_model(Source& source, const json& document) {
    const std::string text = document.dump();
    std::string error;
    std::string warning;
    tinygltf::TinyGLTF parser;
    const bool parsed = parser.LoadASCIIFromString(&source.model, &error, &warning, text.data(),
                                                   static_cast<unsigned int>(text.size()), "", 0);
    if (!parsed) fail(source.name, first_line(error.empty() ? "tinygltf refuses it" : error));
}

}  // namespace

Source read_source(const std::filesystem::path& path, const LoadOptions& options) {
    Source source;
    source.name = path.filename().string();
    source.folder = path.parent_path();
    source.options = options;
    source.file = read_file(path.string(), path, options.limits);
    const Container container = split_container(source.name, source.file, options.limits);
    source.json_bytes = container.json.size();
    source.glb_chunk = container.binary;
    json document = parse_json(source.name, container.json, options.limits);
    if (!container.is_glb) std::exchange(source.file, {});
    check_schema(source.name, document, options.limits);
    check_version(source.name, document);
    take_buffers_and_images(source, document);
    lend_views(source, document);
    follow_pointers(document);
    parse_model(source, document);
    return source;
}

}  // namespace cairn::scenes::gltf
