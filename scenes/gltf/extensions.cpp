#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "scenes/gltf/failure.h"
#include "scenes/gltf/reader.h"

namespace cairn::scenes::gltf {
namespace {

/// Extensions whose data is read.
constexpr std::array<std::string_view, 7> read_extensions{
    "EXT_mesh_gpu_instancing", "EXT_meshopt_compression", "KHR_draco_mesh_compression",
    "KHR_lights_punctual",     "KHR_mesh_quantization",   "KHR_materials_pbrSpecularGlossiness",
    "KHR_texture_transform"};

/// Extensions that change neither the geometry nor the base colour, and so may be passed over even when
/// required.
constexpr std::array<std::string_view, 20> passed_over{
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",  // the default variant is the material that the primitive names
    "KHR_materials_volume",
    "KHR_materials_volume_scatter",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "EXT_lights_ies",
    "EXT_lights_image_based",
    "EXT_materials_bump",
    "MSFT_packing_occlusionRoughnessMetallic"};

bool is_known(const std::string& name) {
    return std::ranges::find(read_extensions, name) != read_extensions.end() ||
           std::ranges::find(passed_over, name) != passed_over.end();
}

}  // namespace

void check_extensions(Reader& reader) {
    std::string missing;
    for (const std::string& name : reader.source.model.extensionsRequired)
        if (!is_known(name)) missing += (missing.empty() ? "" : ", ") + in_quotes(name);
    if (!missing.empty())
        fail(reader.source.name, "it requires extensions that are not supported: " + missing,
             "export it without them; docs/gltf.md lists what is supported");
    for (const std::string& name : reader.source.model.extensionsUsed)
        if (!is_known(name))
            reader.warn(fmt::format("{}: the optional extension {} is not supported and was ignored",
                                    reader.source.name, in_quotes(name)));
}

void Reader::warn(const std::string& text) {
    constexpr std::size_t most_warnings = 100;
    if (scene.warnings.size() < most_warnings &&
        std::ranges::find(scene.warnings, text) == scene.warnings.end())
        scene.warnings.push_back(text);
}

}  // namespace cairn::scenes::gltf
