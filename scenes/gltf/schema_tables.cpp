#include "scenes/gltf/schema_tables.h"

#include <array>

namespace cairn::scenes::gltf {
namespace {

constexpr bool required = true;

constexpr Property value(const char* name, Kind kind, bool must = false) {
    return {name, kind, must};
}
constexpr Property numbers(const char* name, std::size_t length) {
    return {name, Kind::numbers, false, nullptr, length};
}
constexpr Property index(const char* name, const char* target, bool must = false, Kind kind = Kind::index) {
    return {name, kind, must, target};
}
constexpr Property object(const char* name, const Shape& inside, bool must = false) {
    return {name, Kind::object, must, nullptr, 0, &inside};
}
constexpr Property objects(const char* name, const char* label, const Shape& inside, bool must = false,
                           std::uint64_t Limits::*most = &Limits::elements) {
    return {name, Kind::objects, must, nullptr, 0, &inside, label, most};
}

constexpr const char* lights_array = "/extensions/KHR_lights_punctual/lights";

// Each object of the specification is an array of rows and the Shape that names it.

constexpr std::array asset_rows{value("version", Kind::string, required), value("minVersion", Kind::string)};
constexpr Shape asset{asset_rows};

// --- bytes

constexpr std::array buffer_rows{value("uri", Kind::string), value("byteLength", Kind::whole, required)};
constexpr Shape buffer{buffer_rows};

constexpr std::array meshopt_rows{index("buffer", "/buffers", required),
                                  value("byteOffset", Kind::whole_int),
                                  value("byteLength", Kind::whole_int, required),
                                  value("byteStride", Kind::whole_int, required),
                                  value("count", Kind::whole_int, required),
                                  value("mode", Kind::string, required),
                                  value("filter", Kind::string)};
constexpr Shape meshopt{meshopt_rows};
constexpr std::array view_extension_rows{object("EXT_meshopt_compression", meshopt),
                                         object("KHR_meshopt_compression", meshopt)};
constexpr Shape view_extensions{view_extension_rows};
constexpr std::array view_rows{index("buffer", "/buffers", required), value("byteOffset", Kind::whole),
                               value("byteLength", Kind::whole, required), value("byteStride", Kind::whole),
                               object("extensions", view_extensions)};
constexpr Shape view{view_rows};

constexpr std::array sparse_index_rows{index("bufferView", "/bufferViews", required),
                                       value("byteOffset", Kind::whole_int),
                                       value("componentType", Kind::whole_int, required)};
constexpr Shape sparse_indices{sparse_index_rows};
constexpr std::array sparse_value_rows{index("bufferView", "/bufferViews", required),
                                       value("byteOffset", Kind::whole_int)};
constexpr Shape sparse_values{sparse_value_rows};
constexpr std::array sparse_rows{value("count", Kind::whole_int, required),
                                 object("indices", sparse_indices, required),
                                 object("values", sparse_values, required)};
constexpr Shape sparse{sparse_rows};
constexpr std::array accessor_rows{index("bufferView", "/bufferViews"),
                                   value("byteOffset", Kind::whole),
                                   value("componentType", Kind::whole_int, required),
                                   value("count", Kind::whole, required),
                                   value("type", Kind::string, required),
                                   value("normalized", Kind::boolean),
                                   object("sparse", sparse)};
constexpr Shape accessor{accessor_rows};

// --- meshes

// The ids in "attributes" are Draco's own; draco.cpp checks them.
constexpr std::array draco_rows{index("bufferView", "/bufferViews", required),
                                value("attributes", Kind::any_object, required)};
constexpr Shape draco{draco_rows};
constexpr std::array primitive_extension_rows{object("KHR_draco_mesh_compression", draco)};
constexpr Shape primitive_extensions{primitive_extension_rows};
constexpr std::array primitive_rows{index("attributes", "/accessors", required, Kind::index_map),
                                    index("indices", "/accessors"),
                                    index("material", "/materials"),
                                    value("mode", Kind::whole_int),
                                    index("targets", "/accessors", false, Kind::index_maps),
                                    object("extensions", primitive_extensions)};
constexpr Shape primitive{primitive_rows};
constexpr std::array mesh_rows{value("name", Kind::string),
                               objects("primitives", "primitive", primitive, required),
                               numbers("weights", 0)};
constexpr Shape mesh{mesh_rows};

// --- materials

constexpr std::array transform_rows{numbers("offset", 2), value("rotation", Kind::number),
                                    numbers("scale", 2), value("texCoord", Kind::whole_int)};
constexpr Shape transform{transform_rows};
constexpr std::array texture_info_extension_rows{object("KHR_texture_transform", transform)};
constexpr Shape texture_info_extensions{texture_info_extension_rows};
constexpr std::array texture_info_rows{index("index", "/textures", required),
                                       value("texCoord", Kind::whole_int),
                                       object("extensions", texture_info_extensions)};
constexpr Shape texture_info{texture_info_rows};
constexpr std::array roughness_rows{numbers("baseColorFactor", 4), object("baseColorTexture", texture_info)};
constexpr Shape roughness{roughness_rows};
constexpr std::array glossiness_rows{numbers("diffuseFactor", 4), object("diffuseTexture", texture_info)};
constexpr Shape glossiness{glossiness_rows};
constexpr std::array material_extension_rows{object("KHR_materials_pbrSpecularGlossiness", glossiness)};
constexpr Shape material_extensions{material_extension_rows};
constexpr std::array material_rows{
    value("name", Kind::string),         object("pbrMetallicRoughness", roughness),
    value("alphaMode", Kind::string),    value("alphaCutoff", Kind::number),
    value("doubleSided", Kind::boolean), object("extensions", material_extensions)};
constexpr Shape material{material_rows};

// The formats of its other pictures are told, not read.
constexpr std::array texture_rows{index("source", "/images"), index("sampler", "/samplers"),
                                  value("extensions", Kind::any_object)};
constexpr Shape texture{texture_rows};
constexpr std::array image_rows{value("name", Kind::string), value("uri", Kind::string),
                                index("bufferView", "/bufferViews")};
constexpr Shape image{image_rows};
constexpr std::array sampler_rows{value("wrapS", Kind::whole_int), value("wrapT", Kind::whole_int)};
constexpr Shape sampler{sampler_rows};

// --- nodes

constexpr std::array node_light_rows{index("light", lights_array, required)};
constexpr Shape node_light{node_light_rows};
constexpr std::array instancing_rows{index("attributes", "/accessors", required, Kind::index_map)};
constexpr Shape instancing{instancing_rows};
constexpr std::array visibility_rows{value("visible", Kind::boolean)};
constexpr Shape visibility{visibility_rows};
constexpr std::array node_extension_rows{object("KHR_lights_punctual", node_light),
                                         object("KHR_node_visibility", visibility),
                                         object("EXT_mesh_gpu_instancing", instancing)};
constexpr Shape node_extensions{node_extension_rows};
constexpr std::array node_rows{value("name", Kind::string),
                               index("children", "/nodes", false, Kind::indices),
                               index("mesh", "/meshes"),
                               index("skin", "/skins"),
                               index("camera", "/cameras"),
                               numbers("matrix", 16),
                               numbers("translation", 3),
                               numbers("rotation", 4),
                               numbers("scale", 3),
                               numbers("weights", 0),
                               object("extensions", node_extensions)};
constexpr Shape node{node_rows};
constexpr std::array scene_rows{value("name", Kind::string), index("nodes", "/nodes", false, Kind::indices)};
constexpr Shape scene{scene_rows};
constexpr std::array skin_rows{index("joints", "/nodes", required, Kind::indices),
                               index("inverseBindMatrices", "/accessors"), index("skeleton", "/nodes")};
constexpr Shape skin{skin_rows};

constexpr std::array perspective_rows{value("yfov", Kind::number, required),
                                      value("znear", Kind::number, required), value("zfar", Kind::number)};
constexpr Shape perspective{perspective_rows};
constexpr std::array orthographic_rows{
    value("xmag", Kind::number, required), value("ymag", Kind::number, required),
    value("znear", Kind::number, required), value("zfar", Kind::number, required)};
constexpr Shape orthographic{orthographic_rows};
constexpr std::array camera_rows{value("name", Kind::string), value("type", Kind::string, required),
                                 object("perspective", perspective), object("orthographic", orthographic)};
constexpr Shape camera{camera_rows};

constexpr std::array spot_rows{value("innerConeAngle", Kind::number), value("outerConeAngle", Kind::number)};
constexpr Shape spot{spot_rows};
constexpr std::array light_rows{value("name", Kind::string),  value("type", Kind::string, required),
                                numbers("color", 3),          value("intensity", Kind::number),
                                value("range", Kind::number), object("spot", spot)};
constexpr Shape light{light_rows};
constexpr std::array lights_rows{objects("lights", "light", light, required)};
constexpr Shape lights{lights_rows};
constexpr std::array document_extension_rows{object("KHR_lights_punctual", lights)};
constexpr Shape document_extensions{document_extension_rows};

// --- animation

constexpr std::array pointer_rows{value("pointer", Kind::string, required)};
constexpr Shape pointer{pointer_rows};
constexpr std::array target_extension_rows{object("KHR_animation_pointer", pointer)};
constexpr Shape target_extensions{target_extension_rows};
constexpr std::array target_rows{index("node", "/nodes"), value("path", Kind::string, required),
                                 object("extensions", target_extensions)};
constexpr Shape target{target_rows};
constexpr std::array channel_rows{value("sampler", Kind::whole_int, required),
                                  object("target", target, required)};
constexpr Shape channel{channel_rows};
constexpr std::array key_frame_rows{index("input", "/accessors", required),
                                    index("output", "/accessors", required),
                                    value("interpolation", Kind::string)};
constexpr Shape key_frames{key_frame_rows};
constexpr std::array animation_rows{value("name", Kind::string),
                                    objects("channels", "channel", channel, required),
                                    objects("samplers", "sampler", key_frames, required)};
constexpr Shape animation{animation_rows};

constexpr std::array document_rows{object("asset", asset, required),
                                   value("extensionsUsed", Kind::strings),
                                   value("extensionsRequired", Kind::strings),
                                   object("extensions", document_extensions),
                                   objects("buffers", "buffer", buffer),
                                   objects("bufferViews", "buffer view", view),
                                   objects("accessors", "accessor", accessor),
                                   objects("meshes", "mesh", mesh),
                                   objects("materials", "material", material, !required, &Limits::materials),
                                   objects("textures", "texture", texture),
                                   objects("images", "image", image),
                                   objects("samplers", "texture sampler", sampler),
                                   objects("nodes", "node", node),
                                   objects("scenes", "scene", scene),
                                   objects("skins", "skin", skin),
                                   objects("cameras", "camera", camera),
                                   objects("animations", "animation", animation),
                                   index("scene", "/scenes")};
constexpr Shape document{document_rows};

}  // namespace

const Shape& schema_of_document() {
    return document;
}

}  // namespace cairn::scenes::gltf
