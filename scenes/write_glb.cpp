#include "scenes/write_glb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <stb/stb_image_write.h>

#include "base/error.h"
#include "base/output_file.h"

namespace cairn::scenes {
namespace {

using Json = nlohmann::json;

// The numbers of the glTF 2.0 specification, sections 3.6 (accessors), 3.7.2 (meshes) and 3.8.4 (samplers).
enum ComponentType { unsigned_byte = 5121, unsigned_short = 5123, unsigned_int = 5125, float_32 = 5126 };
enum Target { no_target = 0, vertices = 34962, indices = 34963 };
constexpr std::uint32_t glb_magic = 0x46546C67;
constexpr std::uint32_t json_chunk = 0x4E4F534A;
constexpr std::uint32_t binary_chunk = 0x004E4942;

template <class Vector>
Json as_json(const Vector& vector) {
    Json array = Json::array();
    for (int i = 0; i < vector.length(); ++i) {
        array.push_back(static_cast<double>(vector[i]));
    }
    return array;
}

/// The order of glTF: x, y, z, w.
Json as_json(const glm::dquat& rotation) {
    return {rotation.x, rotation.y, rotation.z, rotation.w};
}

/// The binary chunk while it is planned: what the scene already holds is referred to, the rest is kept here.
class BinaryChunk {
public:
    /// Adds a buffer view on memory that outlives this; returns its index.
    int add_view(Json& root, std::span<const std::byte> bytes, Target target) {
        Json view = {{"buffer", 0}, {"byteOffset", size_bytes_}, {"byteLength", bytes.size()}};
        if (target != no_target) view["target"] = static_cast<int>(target);
        root["bufferViews"].push_back(std::move(view));
        parts_.push_back(bytes);
        size_bytes_ += padded(bytes.size());
        return static_cast<int>(parts_.size()) - 1;
    }
    /// The same, and keeps the memory.
    int add_owned_view(Json& root, std::vector<std::byte> bytes, Target target) {
        owned_.push_back(std::move(bytes));
        return add_view(root, owned_.back(), target);
    }
    [[nodiscard]] std::uint64_t size_bytes() const { return size_bytes_; }
    /// Views start at multiples of 4, which every component type divides.
    [[nodiscard]] static std::uint64_t padded(std::uint64_t size_bytes) { return (size_bytes + 3) / 4 * 4; }

    void write(OutputFile& file) const {
        constexpr std::array<std::byte, 4> zeros{};
        for (const std::span<const std::byte> part : parts_) {
            file.write(part.data(), part.size());
            file.write(zeros.data(), padded(part.size()) - part.size());
        }
    }

private:
    std::vector<std::span<const std::byte>> parts_;
    std::vector<std::vector<std::byte>> owned_;  // moving a vector leaves its elements where they are
    std::uint64_t size_bytes_ = 0;
};

template <class Element>
std::vector<std::byte> bytes_of(const std::vector<Element>& elements) {
    const auto bytes = std::as_bytes(std::span(elements));
    return {bytes.begin(), bytes.end()};
}

std::vector<std::byte> encode_png(const Image& image) {
    std::vector<std::byte> file;
    const auto append = [](void* context, void* data, int size_bytes) {
        auto& target = *static_cast<std::vector<std::byte>*>(context);
        const auto* bytes = static_cast<const std::byte*>(data);
        target.insert(target.end(), bytes, bytes + size_bytes);
    };
    // The encoder counts bytes in ints.
    const bool fits = image.rgba.size() < (std::size_t{1} << 30);
    if (!fits ||
        stbi_write_png_to_func(append, &file, image.width, image.height, 4, image.rgba.data(), 0) == 0) {
        throw Error(Fault::usage, fmt::format("image \"{}\"", image.name),
                    fmt::format("{} x {} texels cannot be written as PNG", image.width, image.height),
                    "nothing was written; shrink the image");
    }
    return file;
}

/// Turns one Scene into the JSON and the binary chunk of a .glb.
class GlbBuilder {
public:
    explicit GlbBuilder(const Scene& scene) : scene_(scene) { build(); }
    void write(const std::filesystem::path& path);

private:
    void build();
    void add_textures();
    void add_materials();
    void add_meshes();
    void add_nodes();
    void add_cameras();
    void add_lights();
    void add_scenes();
    [[nodiscard]] Json primitive_json(const Primitive& primitive);
    [[nodiscard]] Json node_json(const Node& node);
    [[nodiscard]] Json instancing_json(const std::vector<Trs>& instances);
    [[nodiscard]] int add_accessor(int view, int component_type, const char* type, std::size_t count);
    [[nodiscard]] int add_indices(const Primitive& primitive);
    [[nodiscard]] int add_positions(const std::vector<glm::vec3>& positions);
    [[nodiscard]] int add_texcoords(const Primitive& primitive);
    void use_extension(const char* name, bool required);

    const Scene& scene_;
    Json root_ = {{"asset", {{"version", "2.0"}, {"generator", "Cairn"}}}};
    BinaryChunk binary_;
    std::vector<int> written_mesh_;     ///< -1: it draws nothing, which glTF cannot say
    std::vector<int> written_texture_;  ///< -1: its image has no texels
};

void GlbBuilder::build() {
    add_textures();
    add_materials();
    add_meshes();
    add_cameras();
    add_lights();
    add_nodes();
    add_scenes();
    if (binary_.size_bytes() != 0) root_["buffers"].push_back({{"byteLength", binary_.size_bytes()}});
}

void GlbBuilder::use_extension(const char* name, bool required) {
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        Json& names = root_[list];
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
        if (!required) return;
    }
}

void GlbBuilder::add_textures() {
    std::vector<int> written_image(scene_.images.size(), -1);
    for (std::size_t i = 0; i < scene_.images.size(); ++i) {
        const Image& image = scene_.images[i];
        if (image.rgba.empty()) continue;
        const int view = binary_.add_owned_view(root_, encode_png(image), no_target);
        written_image[i] = static_cast<int>(root_["images"].size());
        root_["images"].push_back({{"name", image.name}, {"mimeType", "image/png"}, {"bufferView", view}});
    }
    const auto gl_wrap = [](Wrap wrap) {
        return wrap == Wrap::repeat ? 10497 : wrap == Wrap::mirrored_repeat ? 33648 : 33071;
    };
    for (const Texture& texture : scene_.textures) {
        const int image = texture.image < 0 ? -1 : written_image[texture.image];
        written_texture_.push_back(image < 0 ? -1 : static_cast<int>(root_["textures"].size()));
        if (image < 0) continue;
        const Json sampler = {{"wrapS", gl_wrap(texture.wrap_s)}, {"wrapT", gl_wrap(texture.wrap_t)}};
        Json& samplers = root_["samplers"];
        const auto found = std::find(samplers.begin(), samplers.end(), sampler);
        const auto index = found - samplers.begin();
        if (found == samplers.end()) samplers.push_back(sampler);
        root_["textures"].push_back({{"source", image}, {"sampler", index}});
    }
}

void GlbBuilder::add_materials() {
    for (const Material& material : scene_.materials) {
        Json surface = {{"baseColorFactor", as_json(material.base_color)}, {"metallicFactor", 0}};
        const int texture = material.texture < 0 ? -1 : written_texture_[material.texture];
        if (texture >= 0) surface["baseColorTexture"] = {{"index", texture}};
        Json json = {{"name", material.name}, {"pbrMetallicRoughness", std::move(surface)}};
        if (material.alpha_mode == AlphaMode::blend) json["alphaMode"] = "BLEND";
        if (material.alpha_mode == AlphaMode::mask) {
            json["alphaMode"] = "MASK";
            json["alphaCutoff"] = material.alpha_cutoff;
        }
        if (material.double_sided) json["doubleSided"] = true;
        root_["materials"].push_back(std::move(json));
    }
}

void GlbBuilder::add_meshes() {
    for (const Mesh& mesh : scene_.meshes) {
        Json primitives = Json::array();
        for (const Primitive& primitive : mesh.primitives) {
            if (primitive.element_count() != 0) primitives.push_back(primitive_json(primitive));
        }
        written_mesh_.push_back(primitives.empty() ? -1 : static_cast<int>(root_["meshes"].size()));
        if (!primitives.empty()) {
            root_["meshes"].push_back({{"name", mesh.name}, {"primitives", std::move(primitives)}});
        }
    }
}

Json GlbBuilder::primitive_json(const Primitive& primitive) {
    const std::size_t count = primitive.positions.size();
    const auto view_of = [&](const auto& elements) {
        return binary_.add_view(root_, std::as_bytes(std::span(elements)), vertices);
    };
    Json attributes = {{"POSITION", add_positions(primitive.positions)}};
    if (!primitive.normals.empty()) {
        attributes["NORMAL"] = add_accessor(view_of(primitive.normals), float_32, "VEC3", count);
    }
    if (!primitive.texcoords.empty()) attributes["TEXCOORD_0"] = add_texcoords(primitive);
    if (!primitive.colors.empty()) {
        const int accessor = add_accessor(view_of(primitive.colors), unsigned_short, "VEC4", count);
        root_["accessors"][accessor]["normalized"] = true;
        attributes["COLOR_0"] = accessor;
    }
    const int mode = primitive.topology == Topology::triangles ? 4
                     : primitive.topology == Topology::lines   ? 1
                                                               : 0;
    Json json = {{"attributes", std::move(attributes)}, {"indices", add_indices(primitive)}, {"mode", mode}};
    if (primitive.material >= 0) json["material"] = primitive.material;
    return json;
}

int GlbBuilder::add_accessor(int view, int component_type, const char* type, std::size_t count) {
    root_["accessors"].push_back(
        {{"bufferView", view}, {"componentType", component_type}, {"type", type}, {"count", count}});
    return static_cast<int>(root_["accessors"].size()) - 1;
}

int GlbBuilder::add_indices(const Primitive& primitive) {
    const std::vector<std::uint32_t>& wide = primitive.indices;
    // The highest value of a type restarts a primitive (section 3.7.2.1), so 65,535 vertices are the most for
    // shorts.
    if (primitive.positions.size() > 65535) {
        const int view = binary_.add_view(root_, std::as_bytes(std::span(wide)), indices);
        return add_accessor(view, unsigned_int, "SCALAR", wide.size());
    }
    const std::vector<std::uint16_t> narrow(wide.begin(), wide.end());
    const int view = binary_.add_owned_view(root_, bytes_of(narrow), indices);
    return add_accessor(view, unsigned_short, "SCALAR", wide.size());
}

int GlbBuilder::add_positions(const std::vector<glm::vec3>& positions) {
    glm::vec3 low = positions.front();
    glm::vec3 high = low;
    for (const glm::vec3& position : positions) {
        if (!std::isfinite(position.x + position.y + position.z)) {
            throw Error(Fault::usage, scene_.name, "a vertex is not finite", "nothing was written");
        }
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    const int view = binary_.add_view(root_, std::as_bytes(std::span(positions)), vertices);
    const int accessor = add_accessor(view, float_32, "VEC3", positions.size());
    root_["accessors"][accessor]["min"] = as_json(low);
    root_["accessors"][accessor]["max"] = as_json(high);
    return accessor;
}

/// The material's transform is applied here, once, and not written as KHR_texture_transform.
int GlbBuilder::add_texcoords(const Primitive& primitive) {
    std::vector<glm::vec2> texcoords = primitive.texcoords;
    if (primitive.material >= 0) {
        const glm::mat3& uv_from_mesh = scene_.materials[primitive.material].uv_from_mesh;
        for (glm::vec2& texcoord : texcoords) {
            texcoord = glm::vec2(uv_from_mesh * glm::vec3(texcoord, 1.0F));
        }
    }
    const int view = binary_.add_owned_view(root_, bytes_of(texcoords), vertices);
    return add_accessor(view, float_32, "VEC2", texcoords.size());
}

void GlbBuilder::add_cameras() {
    for (const Camera& camera : scene_.cameras) {
        Json lens = {{"znear", camera.znear}};
        if (camera.zfar > 0.0) lens["zfar"] = camera.zfar;
        lens.update(camera.perspective ? Json{{"yfov", camera.yfov}}
                                       : Json{{"xmag", camera.ymag}, {"ymag", camera.ymag}});
        const char* type = camera.perspective ? "perspective" : "orthographic";
        root_["cameras"].push_back({{"name", camera.name}, {"type", type}, {type, std::move(lens)}});
    }
}

void GlbBuilder::add_lights() {
    if (scene_.lights.empty()) return;
    use_extension("KHR_lights_punctual", false);
    Json lights = Json::array();
    for (const Light& light : scene_.lights) {
        Json json = {{"name", light.name}, {"color", as_json(light.color)}, {"intensity", light.intensity}};
        if (light.range > 0.0F) json["range"] = light.range;
        json["type"] = light.type == Light::Type::directional ? "directional"
                       : light.type == Light::Type::point     ? "point"
                                                              : "spot";
        if (light.type == Light::Type::spot) {
            json["spot"] = {{"innerConeAngle", light.inner_cone}, {"outerConeAngle", light.outer_cone}};
        }
        lights.push_back(std::move(json));
    }
    root_["extensions"]["KHR_lights_punctual"]["lights"] = std::move(lights);
}

void GlbBuilder::add_nodes() {
    for (const Node& node : scene_.nodes) {
        root_["nodes"].push_back(node_json(node));
    }
}

Json GlbBuilder::node_json(const Node& node) {
    Json json = {{"name", node.name}};
    if (!node.children.empty()) json["children"] = node.children;
    if (node.matrix != nullptr) {
        Json columns = Json::array();
        for (int i = 0; i < 16; ++i) {
            columns.push_back((*node.matrix)[i / 4][i % 4]);
        }
        json["matrix"] = std::move(columns);
    } else {
        if (node.trs.translation != glm::dvec3(0.0)) json["translation"] = as_json(node.trs.translation);
        if (node.trs.rotation != glm::dquat(1.0, 0.0, 0.0, 0.0))
            json["rotation"] = as_json(node.trs.rotation);
        if (node.trs.scale != glm::dvec3(1.0)) json["scale"] = as_json(node.trs.scale);
    }
    const int mesh = node.mesh < 0 ? -1 : written_mesh_[node.mesh];
    if (mesh >= 0) json["mesh"] = mesh;
    if (node.camera >= 0) json["camera"] = node.camera;
    if (node.light >= 0) json["extensions"]["KHR_lights_punctual"]["light"] = node.light;
    if (!node.visible) {
        use_extension("KHR_node_visibility", true);
        json["extensions"]["KHR_node_visibility"]["visible"] = false;
    }
    if (mesh >= 0 && !node.instances.empty()) {
        json["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = instancing_json(node.instances);
    }
    return json;
}

/// EXT_mesh_gpu_instancing stores floats, so the places of instances lose what a double has beyond them.
Json GlbBuilder::instancing_json(const std::vector<Trs>& instances) {
    use_extension("EXT_mesh_gpu_instancing", true);
    std::vector<glm::vec3> translations;
    std::vector<glm::vec4> rotations;
    std::vector<glm::vec3> scales;
    for (const Trs& trs : instances) {
        translations.emplace_back(trs.translation);
        rotations.emplace_back(trs.rotation.x, trs.rotation.y, trs.rotation.z, trs.rotation.w);
        scales.emplace_back(trs.scale);
    }
    const auto add = [&](const auto& elements, const char* type) {
        const int view = binary_.add_owned_view(root_, bytes_of(elements), no_target);
        return add_accessor(view, float_32, type, elements.size());
    };
    return {{"TRANSLATION", add(translations, "VEC3")},
            {"ROTATION", add(rotations, "VEC4")},
            {"SCALE", add(scales, "VEC3")}};
}

void GlbBuilder::add_scenes() {
    for (const SceneRoots& roots : scene_.scenes) {
        Json json = {{"name", roots.name}};
        if (!roots.nodes.empty()) json["nodes"] = roots.nodes;
        root_["scenes"].push_back(std::move(json));
    }
    root_["scene"] = scene_.default_scene;
}

void GlbBuilder::write(const std::filesystem::path& path) {
    // Names come from anywhere; what is not UTF-8 in them is replaced rather than refused.
    std::string text = root_.dump(-1, ' ', false, Json::error_handler_t::replace);
    text.resize(BinaryChunk::padded(text.size()), ' ');
    const bool has_binary = binary_.size_bytes() != 0;
    const std::uint64_t size_bytes = 12 + 8 + text.size() + (has_binary ? 8 + binary_.size_bytes() : 0);
    if (size_bytes > 0xFFFFFFFFU) {
        throw Error(Fault::usage, path.string(),
                    fmt::format("the scene takes {} bytes, a .glb file holds 4,294,967,295", size_bytes),
                    "nothing was written; write parts of the scene");
    }
    OutputFile file(path);
    const auto write_words = [&](std::initializer_list<std::uint64_t> words) {
        for (const std::uint64_t word : words) {
            const auto narrow = static_cast<std::uint32_t>(word);
            file.write(&narrow, sizeof narrow);
        }
    };
    write_words({glb_magic, 2, size_bytes, text.size(), json_chunk});
    file.write(text.data(), text.size());
    if (has_binary) {
        write_words({binary_.size_bytes(), binary_chunk});
        binary_.write(file);
    }
    file.commit();
}

}  // namespace

void write_glb(const Scene& scene, const std::filesystem::path& path) {
    GlbBuilder(scene).write(path);
}

}  // namespace cairn::scenes
