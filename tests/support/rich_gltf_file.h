#pragma once

#include "tests/support/gltf_file.h"

namespace cairn::test {

/// A small file with one of everything: indices, normals, texture, colours, sparse values, morph
/// targets, skin, instances, animation, light and camera. Node 0 shows mesh 0, with skin; node 3 shows mesh
/// 1, in instances.
inline GltfFile rich_gltf_file() {
    GltfFile file;
    const int positions = file.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
    const int normals = file.add_accessor(
        std::vector<std::int8_t>{0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0}, "VEC4", true);
    file.json["accessors"][1]["type"] = "VEC3";
    file.json["bufferViews"][1]["byteStride"] = 4;
    const int texcoords = file.add_accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, "VEC2");
    const int colors = file.add_accessor(std::vector<std::uint8_t>(16, 200), "VEC4", true);
    const int joints =
        file.add_accessor(std::vector<std::uint8_t>{0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0}, "VEC4");
    const int weights =
        file.add_accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.5F, 0.5F, 0, 0}, "VEC4");
    const int morph = file.add_accessor(std::vector<float>(12, 0.25F), "VEC3");
    const int places = file.add_view(bytes_of(std::vector<std::uint16_t>{0, 3}));
    const int values = file.add_view(bytes_of(std::vector<float>{1, 2, 3, 4, 5, 6}));
    file.json["accessors"][static_cast<std::size_t>(morph)]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", places}, {"componentType", 5123}}},
        {"values", {{"bufferView", values}}}};
    const int indices = file.add_accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR");
    const int strip = file.add_accessor(std::vector<std::uint8_t>{0, 1, 3, 2}, "SCALAR");
    const int inverse = file.add_accessor(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                                                             1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1},
                                          "MAT4");
    const int times = file.add_accessor(std::vector<float>{0, 1}, "SCALAR");
    const int moves = file.add_accessor(std::vector<float>{0, 0, 0, 0, 3, 0}, "VEC3");

    const Bytes png = PngWriter::make(2, 1, 8, {0, 255, 0, 0, 255, 0, 0, 255, 128});
    file.add("images", {{"bufferView", file.add_view(png)}, {"mimeType", "image/png"}, {"name", "bark"}});
    file.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}});
    file.add("textures", {{"source", 0}, {"sampler", 0}});
    file.add("materials",
             {{"name", "leaf"},
              {"alphaMode", "MASK"},
              {"pbrMetallicRoughness",
               {{"baseColorTexture",
                 {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"scale", {2, 2}}}}}}}}}}});
    const Json attributes = {{"POSITION", positions}, {"NORMAL", normals},  {"TEXCOORD_0", texcoords},
                             {"COLOR_0", colors},     {"JOINTS_0", joints}, {"WEIGHTS_0", weights}};
    file.add("meshes", {{"name", "ear"},
                        {"weights", {0.5}},
                        {"primitives",
                         {{{"attributes", attributes},
                           {"indices", indices},
                           {"material", 0},
                           {"targets", {{{"POSITION", morph}}}}}}}});
    file.add("meshes", {{"primitives",
                         {{{"attributes", {{"POSITION", positions}}}, {"indices", strip}, {"mode", 5}}}}});
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}});
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 4}}};
    file.json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_texture_transform", "EXT_mesh_gpu_instancing",
                                   "KHR_mesh_quantization"};

    file.add_root({{"mesh", 0}, {"skin", 0}, {"name", "body"}});
    file.add_root({{"children", {2}}, {"rotation", {0, 0, 0, 1}}});
    file.add("nodes", {{"translation", {0, 1, 0}},
                       {"camera", 0},
                       {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.add_root(
        {{"mesh", 1},
         {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 0, 0, 1}},
         {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", moves}}}}}}}});
    file.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", inverse}});
    file.add("animations",
             {{"name", "wave"},
              {"samplers", {{{"input", times}, {"output", moves}}}},
              {"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "translation"}}}}}}});
    return file;
}

}  // namespace cairn::test
