#include <algorithm>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "scenes/gltf/failure.h"
#include "scenes/gltf/reader.h"

namespace cairn::scenes::gltf {
namespace {

using Names = std::span<const std::string_view>;

/// Extensions whose data is read.
constexpr std::string_view read_extensions[] = {
    "EXT_mesh_gpu_instancing",    "EXT_meshopt_compression", "KHR_animation_pointer",
    "KHR_draco_mesh_compression", "KHR_lights_punctual",     "KHR_materials_pbrSpecularGlossiness",
    "KHR_mesh_quantization",      "KHR_meshopt_compression", "KHR_node_visibility",
    "KHR_texture_transform"};

/// Extensions that change neither the geometry nor the base colour, and so may be passed over even when
/// required.
constexpr std::string_view passed_over[] = {
    "EXT_lights_ies",
    "EXT_lights_image_based",
    "EXT_materials_bump",
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
    "MSFT_packing_occlusionRoughnessMetallic"};

/// Extensions that change no geometry either, and whose absence somebody may notice: formats of pictures
/// (materials.cpp tells which base colours lack theirs), labels of features, and what an avatar does.
constexpr std::string_view told[] = {"EXT_instance_features",    "EXT_mesh_features",
                                     "EXT_structural_metadata",  "EXT_texture_avif",
                                     "EXT_texture_webp",         "KHR_audio_emitter",
                                     "KHR_implicit_shapes",      "KHR_interactivity",
                                     "KHR_node_hoverability",    "KHR_node_selectability",
                                     "KHR_physics_rigid_bodies", "KHR_texture_basisu",
                                     "MSFT_texture_dds",         "VRM",
                                     "VRMC_materials_mtoon",     "VRMC_node_constraint",
                                     "VRMC_springBone",          "VRMC_vrm",
                                     "VRMC_vrm_animation"};

bool holds(Names names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
}

}  // namespace

void check_extensions(Reader& reader) {
    std::string missing;
    for (const std::string& name : reader.source.model.extensionsRequired)
        if (!holds(read_extensions, name) && !holds(passed_over, name) && !holds(told, name))
            missing += (missing.empty() ? "" : ", ") + in_quotes(name);
    if (!missing.empty())
        fail(reader.source.name, "it requires extensions that are not supported: " + missing,
             "export it without them; docs/gltf.md lists what is supported");
    const auto& required = reader.source.model.extensionsRequired;
    for (const std::string& name : reader.source.model.extensionsUsed) {
        if (holds(read_extensions, name) || holds(passed_over, name)) continue;
        const bool is_required = std::ranges::find(required, name) != required.end();
        reader.warn(fmt::format("{}: the {} extension {} is not supported and was ignored",
                                reader.source.name, is_required ? "required" : "optional", in_quotes(name)));
    }
}

Reader::Reader(Source read, const LoadOptions& options)
    : source(std::move(read)),
      memory(options.memory_bytes.value_or(usual_memory_bytes)),
      budget("its geometry", options.memory_bytes ? Budget::unlimited : geometry_floor_bytes, memory),
      picture_budget("its pictures", options.memory_bytes ? Budget::unlimited : picture_floor_bytes, memory) {
    budget.grant(source.json_bytes + source.glb_chunk.size());
    scene.name = source.name;
    placed_.resize(source.model.meshes.size());
    for (const tinygltf::Node& node : source.model.nodes)
        if (node.mesh >= 0) placed_[static_cast<std::size_t>(node.mesh)] = true;
}

void Reader::warn(const std::string& text) {
    add_warning({text, false});
}

void Reader::alter(const std::string& where, const std::string& what, const std::string& way_out) {
    if (source.options.strict) fail(where, what, way_out);
    add_warning({where.empty() ? what : where + ": " + what, true});
}

void Reader::add_warning(Warning warning) {
    // A hundred of either kind tell enough of a file.
    constexpr std::ptrdiff_t most_warnings = 100;
    if (std::ranges::count(scene.warnings, warning.alters, &Warning::alters) < most_warnings &&
        std::ranges::find(scene.warnings, warning) == scene.warnings.end())
        scene.warnings.push_back(std::move(warning));
}

PlacingLimits Reader::placing_limits() const {
    const LoadOptions& options = source.options;
    const std::uint64_t of_this_size = placing_floor_bytes + budget.input_bytes() * bytes_per_input_byte;
    return {options.memory_bytes.value_or(std::min(usual_memory_bytes, of_this_size)),
            options.limits.primitives};
}

}  // namespace cairn::scenes::gltf
