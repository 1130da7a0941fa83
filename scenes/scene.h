#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

/// A glTF 2.0 scene in memory. As in the file, each mesh is there once, and nodes and instances refer to it.
///
/// Units are the file's (metres by glTF's rule), right-handed, +Y up. Indices into the vectors of `Scene` are
/// ints, -1 = none; the loader has checked them all, so no caller needs to.
namespace cairn::scenes {

/// How a texture coordinate outside [0, 1] is brought back (glTF 2.0, sampler.wrapS and wrapT).
enum class Wrap : std::uint8_t { repeat, mirrored_repeat, clamp_to_edge };

/// 8-bit RGBA texels, row 0 at the top (v = 0), sRGB-encoded colour, linear alpha.
struct Image {
    std::string name;
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;  ///< 4 * width * height
};

/// A base-colour texture: an image and how it is addressed.
struct Texture {
    int image = -1;  ///< index into Scene::images
    Wrap wrap_s = Wrap::repeat;
    Wrap wrap_t = Wrap::repeat;
};

enum class AlphaMode : std::uint8_t {
    opaque,
    /// A texel whose alpha is under the cutoff is a hole in the surface.
    mask,
    blend,  ///< taken for opaque surface
};

struct Material {
    std::string name;
    glm::vec4 base_color{1.0F};  ///< linear
    int texture = -1;            ///< index into Scene::textures
    /// Texture coordinate = uv_from_mesh * (u, v, 1): KHR_texture_transform, identity without it.
    glm::mat3 uv_from_mesh{1.0F};
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5F;
    bool double_sided = false;
};

enum class Topology : std::uint8_t { points, lines, triangles };

struct MorphTarget {
    std::vector<glm::vec3> positions;  ///< displacements, one per vertex, or empty
    std::vector<glm::vec3> normals;    ///< displacements, one per vertex, or empty
};

struct SkinWeights {
    glm::u16vec4 joints{0};  ///< indices into Skin::joints
    /// The sum of the weights over all sets of a vertex (Primitive::more_skin) is exactly 1: they are
    /// multiples of 2^-24, normalized when loaded. Or all weights are 0.
    glm::vec4 weights{0.0F};
};

/// Vertices, and the points, lines or triangles that they span. Strips, fans and loops are unrolled and
/// missing indices written out when loaded, so `indices` always holds 1, 2 or 3 entries per point, line or
/// triangle. An optional attribute is empty if the file has none, else it has one entry per vertex.
struct Primitive {
    Topology topology = Topology::triangles;
    int material = -1;  ///< index into Scene::materials; -1: white, opaque
    std::vector<std::uint32_t> indices;
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    /// Texture coordinates of the set that the material's base colour texture uses, before uv_from_mesh.
    std::vector<glm::vec2> texcoords;
    std::vector<glm::u16vec4> colors;  ///< COLOR_0: linear RGBA, 65535 = 1
    std::vector<SkinWeights> skin;
    /// Further sets of influences (JOINTS_1, ...), each with one entry per vertex.
    std::vector<std::vector<SkinWeights>> more_skin;
    std::vector<MorphTarget> morph_targets;

    [[nodiscard]] std::size_t element_count() const {
        return indices.size() / (topology == Topology::triangles ? 3 : topology == Topology::lines ? 2 : 1);
    }
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
    /// Default weights, one per morph target of its primitives. A primitive may have fewer targets, which
    /// are then the first ones.
    std::vector<float> morph_weights;
};

/// A transform: scale, then rotation, then translation.
struct Trs {
    glm::dvec3 translation{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 scale{1.0};
};

struct Node {
    std::string name;
    std::vector<int> children;
    Trs trs;  ///< used if `matrix` is null
    std::unique_ptr<glm::dmat4> matrix;
    int mesh = -1;
    int skin = -1;
    int camera = -1;
    int light = -1;
    /// EXT_mesh_gpu_instancing: the mesh is drawn once per instance; if there are none, once, where the node
    /// is.
    std::vector<Trs> instances;
    std::vector<float> morph_weights;  ///< replace the mesh's if not empty
    bool visible = true;               ///< KHR_node_visibility; if not, nor are its descendants
};

struct Skin {
    std::vector<int> joints;                  ///< indices of nodes
    std::vector<glm::dmat4> joint_from_mesh;  ///< inverse bind matrices, one per joint
};

enum class Path : std::uint8_t { translation, rotation, scale, weights };
enum class Interpolation : std::uint8_t { step, linear, cubic_spline };

/// Key frames of one property of one node. `values` holds `width` floats per key (3, 4, or the count of morph
/// targets); for cubic_spline three times as many: in-tangent, value, out-tangent.
struct Channel {
    int node = -1;
    Path path = Path::translation;
    Interpolation interpolation = Interpolation::linear;
    int width = 3;
    std::vector<float> times;  ///< seconds, never decreasing; of equal ones the last counts from there on
    std::vector<float> values;
};

struct Animation {
    std::string name;
    std::vector<Channel> channels;
    double duration = 0.0;  ///< time of the last key of any channel, seconds
};

/// A glTF camera, which looks along -Z of its node.
struct Camera {
    std::string name;
    bool perspective = true;
    double yfov = 0.8;  ///< whole vertical angle, radians; perspective only
    double ymag = 1.0;  ///< half the height; orthographic only
    double znear = 0.01;
    double zfar = 0.0;  ///< 0 = infinite
};

/// A light of KHR_lights_punctual, which shines along -Z of its node.
struct Light {
    enum class Type : std::uint8_t { directional, point, spot };
    std::string name;
    Type type = Type::point;
    glm::vec3 color{1.0F};
    float intensity = 1.0F;
    float range = 0.0F;            ///< 0 = infinite
    float inner_cone = 0.0F;       ///< radians from the axis; spot only
    float outer_cone = 0.785398F;  ///< radians from the axis; spot only
};

/// The memory that one file may take, if nobody says otherwise, and the places of its primitives.
inline constexpr std::uint64_t usual_memory_bytes = 8ULL << 30;
inline constexpr std::uint64_t usual_primitives = 4'000'000;

/// What the primitives of a scene may take where its nodes place them (take_snapshot()): few bytes of a file
/// can ask for billions of triangles.
struct PlacingLimits {
    /// Posed copies of vertices, placed triangles, and the tables of alpha masks, each.
    std::uint64_t bytes = usual_memory_bytes;
    std::uint64_t primitives = usual_primitives;
};

/// A statement of a file that a reader did not follow as it stands.
struct Warning {
    std::string text;
    /// What is voxelized or shown differs from what the file means: a picture is lost, for one. Programs
    /// should not hide such a warning.
    bool alters = false;

    friend bool operator==(const Warning&, const Warning&) = default;
};

struct SceneRoots {
    std::string name;
    std::vector<int> nodes;
};

struct Scene {
    std::string name;  ///< file name or "builtin:NAME", for messages
    std::vector<Image> images;
    std::vector<Texture> textures;
    std::vector<Material> materials;
    /// A mesh that is damaged and that no node uses is here without primitives.
    std::vector<Mesh> meshes;
    std::vector<Node> nodes;  ///< a forest: no node is its own ancestor
    std::vector<Skin> skins;
    std::vector<Animation> animations;
    std::vector<Camera> cameras;
    std::vector<Light> lights;
    std::vector<SceneRoots> scenes;  ///< at least one
    int default_scene = 0;
    /// Warnings about optional extensions that are not supported, and the like; each text once.
    std::vector<Warning> warnings;
    PlacingLimits placing;
};

}  // namespace cairn::scenes
