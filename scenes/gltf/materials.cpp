#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "scenes/gltf/failure.h"
#include "scenes/gltf/images.h"
#include "scenes/gltf/reader.h"
#include "scenes/gltf/uri.h"

namespace cairn::scenes::gltf {
namespace {

constexpr const char* only_png = "only PNG and JPEG are read; convert the picture";

/// A texture as a material refers to it: the same of "baseColorTexture" and of the older "diffuseTexture".
struct TextureUse {
    int texture = -1;
    int texcoord_set = 0;
    glm::mat3 uv_from_mesh{1.0F};
};

double number_or(const tinygltf::Value& object, const char* key, double fallback) {
    return object.Has(key) ? object.Get(key).GetNumberAsDouble() : fallback;
}

glm::dvec2 pair_or(const tinygltf::Value& object, const char* key, double fallback) {
    if (!object.Has(key)) return glm::dvec2(fallback);
    const tinygltf::Value& numbers = object.Get(key);
    return {numbers.Get(0).GetNumberAsDouble(), numbers.Get(1).GetNumberAsDouble()};
}

/// KHR_texture_transform: translation * rotation * scale. A positive angle turns counter-clockwise where v
/// points down, as the text of the extension, its sample model and the other readers have it; the matrix
/// printed beside that text turns the other way (https://github.com/KhronosGroup/glTF/issues/1563).
void apply_transform(const std::string& where, const tinygltf::Value& transform, TextureUse& use) {
    const glm::dvec2 offset = pair_or(transform, "offset", 0.0);
    const glm::dvec2 scale = pair_or(transform, "scale", 1.0);
    const double rotation = number_or(transform, "rotation", 0.0);
    const double c = std::cos(rotation);
    const double s = std::sin(rotation);
    use.uv_from_mesh =
        glm::mat3(glm::dmat3(glm::dvec3(c * scale.x, -s * scale.x, 0.0),
                             glm::dvec3(s * scale.y, c * scale.y, 0.0), glm::dvec3(offset, 1.0)));
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (!std::isfinite(use.uv_from_mesh[column][row]))
                fail(where, "its texture transform is not finite");
    use.texcoord_set = static_cast<int>(number_or(transform, "texCoord", use.texcoord_set));
}

class Materials {
public:
    explicit Materials(Reader& reader) : reader_(reader) {}

    /// @param used  whether a mesh that is placed has it: only then its texture is read.
    void read(std::size_t index, bool used) {
        const tinygltf::Material& source = reader_.source.model.materials[index];
        material_ = element("material", index, source.name);
        where_ = reader_.source.where(material_);
        Material material;
        material.name = source.name;
        material.double_sided = source.doubleSided;
        material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
        if (source.alphaMode == "MASK")
            material.alpha_mode = AlphaMode::mask;
        else if (source.alphaMode == "BLEND")
            material.alpha_mode = AlphaMode::blend;
        else if (source.alphaMode != "OPAQUE")
            fail(where_, "unknown \"alphaMode\" " + in_quotes(source.alphaMode));

        const TextureUse use = read_base_color(source, material);
        if (used && use.texture >= 0) {
            material.texture = texture(use.texture, material.alpha_mode);
            material.uv_from_mesh = use.uv_from_mesh;
        }
        reader_.texcoord_sets.push_back(material.texture < 0 ? -1 : use.texcoord_set);
        reader_.scene.materials.push_back(std::move(material));
    }

private:
    TextureUse read_base_color(const tinygltf::Material& source, Material& material) const {
        TextureUse use;
        const auto glossiness = source.extensions.find("KHR_materials_pbrSpecularGlossiness");
        if (glossiness != source.extensions.end()) {
            const tinygltf::Value& extension = glossiness->second;
            if (extension.Has("diffuseFactor"))
                for (int c = 0; c < 4; ++c)
                    material.base_color[c] =
                        static_cast<float>(extension.Get("diffuseFactor").Get(c).GetNumberAsDouble());
            if (!extension.Has("diffuseTexture")) return use;
            const tinygltf::Value& info = extension.Get("diffuseTexture");
            use.texture = info.Get("index").GetNumberAsInt();
            use.texcoord_set = static_cast<int>(number_or(info, "texCoord", 0.0));
            const tinygltf::Value nothing{tinygltf::Value::Object{}};
            const tinygltf::Value& extensions = info.Has("extensions") ? info.Get("extensions") : nothing;
            if (extensions.Has("KHR_texture_transform"))
                apply_transform(where_, extensions.Get("KHR_texture_transform"), use);
            return use;
        }
        const auto& roughness = source.pbrMetallicRoughness;
        for (int c = 0; c < 4; ++c)
            material.base_color[c] =
                static_cast<float>(roughness.baseColorFactor[static_cast<std::size_t>(c)]);
        use.texture = roughness.baseColorTexture.index;
        use.texcoord_set = roughness.baseColorTexture.texCoord;
        const auto transform = roughness.baseColorTexture.extensions.find("KHR_texture_transform");
        if (transform != roughness.baseColorTexture.extensions.end())
            apply_transform(where_, transform->second, use);
        return use;
    }

    [[nodiscard]] Wrap wrap(int value) const {
        switch (value) {
            case TINYGLTF_TEXTURE_WRAP_REPEAT:
                return Wrap::repeat;
            case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
                return Wrap::mirrored_repeat;
            case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
                return Wrap::clamp_to_edge;
            default:
                fail(where_,
                     fmt::format("the sampler of its texture has wrap mode {}, which glTF does not know",
                                 value));
        }
    }

    /// Index into Scene::textures, or -1 when the texture has no picture that can be read.
    /// @throws Error  in that case, if an alpha mask needs it.
    int texture(int index, AlphaMode mode) {
        const tinygltf::Texture& source = reader_.source.model.textures[static_cast<std::size_t>(index)];
        if (source.source < 0) {
            const std::string what = fmt::format(
                "{} of its base colour {}", element("texture", static_cast<std::size_t>(index), source.name),
                format_of(source));
            if (mode == AlphaMode::mask) fail(where_, what + ", and its alpha mask needs it", only_png);
            reader_.alter(where_, what + "; the colour factor stands alone", only_png);
            return -1;
        }
        Texture result;
        if (source.sampler >= 0) {
            const tinygltf::Sampler& sampler =
                reader_.source.model.samplers[static_cast<std::size_t>(source.sampler)];
            result.wrap_s = wrap(sampler.wrapS);
            result.wrap_t = wrap(sampler.wrapT);
        }
        result.image = image(source.source, mode);
        if (result.image < 0) return -1;
        const auto key = std::tuple(result.image, result.wrap_s, result.wrap_t);
        const auto [found, is_new] =
            textures_.try_emplace(key, static_cast<int>(reader_.scene.textures.size()));
        if (is_new) reader_.scene.textures.push_back(result);
        return found->second;
    }

    /// Why a texture without a "source" has no picture.
    static std::string format_of(const tinygltf::Texture& texture) {
        constexpr std::array<std::pair<const char*, const char*>, 4> formats{{{"EXT_texture_avif", "AVIF"},
                                                                              {"EXT_texture_webp", "WebP"},
                                                                              {"KHR_texture_basisu", "KTX2"},
                                                                              {"MSFT_texture_dds", "DDS"}}};
        for (const auto& [extension, format] : formats)
            if (texture.extensions.contains(extension))
                return fmt::format("has only a {} picture ({}), which is not read", format, extension);
        return "names no picture";
    }

    /// Index into Scene::images, or -1 when the picture cannot be read.
    /// @throws Error  in that case, if an alpha mask needs it.
    int image(int index, AlphaMode mode) {
        auto found = pictures_.find(index);
        if (found == pictures_.end()) found = pictures_.emplace(index, read_picture(index)).first;
        const Picture& picture = found->second;
        if (!picture.failure) return picture.image;
        const Error& failure = *picture.failure;
        if (mode == AlphaMode::mask)
            fail("", fmt::format("{}; the alpha mask of {} needs it", failure.what(), material_),
                 failure.way_out());
        reader_.alter("", fmt::format("{}; the colour factors stand alone", failure.what()),
                      failure.way_out());
        return -1;
    }

    /// A picture that some base colour uses.
    struct Picture {
        int image = -1;  ///< index into Scene::images; -1: it cannot be read
        std::optional<Error> failure;
    };

    Picture read_picture(int index) {
        const ImageSource& source = reader_.source.images[static_cast<std::size_t>(index)];
        const std::string name = !source.name.empty()                      ? source.name
                                 : source.uri && !is_data_uri(*source.uri) ? *source.uri
                                                                           : std::string();
        const std::string where =
            reader_.source.where(element("image", static_cast<std::size_t>(index), name));
        try {
            Image image = decode(where, source);
            image.name = name;
            reader_.scene.images.push_back(std::move(image));
            return {static_cast<int>(reader_.scene.images.size()) - 1, std::nullopt};
        } catch (const Error& error) {
            if (error.fault() != Fault::input) throw;
            return {-1, error};
        }
    }

    Image decode(const std::string& where, const ImageSource& source) {
        const std::uint64_t most_bytes = reader_.source.options.limits.image_bytes;
        if (source.buffer_view >= 0)
            return decode_image(where, reader_.buffers.view(source.buffer_view), reader_.picture_budget,
                                most_bytes);
        if (!source.uri) fail(where, "it has neither a URI nor a buffer view");
        const auto file = read_uri(where, *source.uri, reader_.source.folder, reader_.source.options);
        return decode_image(where, file, reader_.picture_budget, most_bytes);
    }

    Reader& reader_;
    std::string material_;  ///< name of the one that is read, for messages
    std::string where_;
    std::map<int, Picture> pictures_;
    std::map<std::tuple<int, Wrap, Wrap>, int> textures_;
};

}  // namespace

void read_materials(Reader& reader) {
    const tinygltf::Model& model = reader.source.model;
    std::vector<bool> used(model.materials.size());
    for (std::size_t m = 0; m < model.meshes.size(); ++m) {
        if (!reader.is_placed(m)) continue;
        for (const tinygltf::Primitive& primitive : model.meshes[m].primitives)
            if (primitive.material >= 0) used[static_cast<std::size_t>(primitive.material)] = true;
    }
    Materials materials(reader);
    for (std::size_t i = 0; i < model.materials.size(); ++i)
        materials.read(i, used[i]);
}

}  // namespace cairn::scenes::gltf
