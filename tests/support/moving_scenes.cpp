#include "tests/support/moving_scenes.h"

#include <initializer_list>
#include <numeric>

#include "tests/support/lattice_surface.h"

namespace cairn::test {
namespace {

using namespace scenes;

float number(Random& random, double low, double high) {
    return float(low + (high - low) * random.unit());
}

glm::vec3 vector(Random& random, double reach) {
    const float x = number(random, -reach, reach);
    const float y = number(random, -reach, reach);
    return {x, y, number(random, -reach, reach)};
}

glm::dquat rotation(Random& random) {
    const glm::vec3 axis = vector(random, 1.0);
    return glm::normalize(glm::dquat(random.unit() - 0.5, glm::dvec3(axis)));
}

Primitive cloud(Random& random, std::size_t vertex_count, Topology topology) {
    Primitive primitive;
    primitive.topology = topology;
    for (std::size_t i = 0; i < vertex_count; ++i) {
        primitive.positions.push_back(vector(random, 1.0));
        primitive.normals.push_back(glm::normalize(vector(random, 1.0)));
    }
    const std::size_t corners = topology == Topology::triangles ? 3 : topology == Topology::lines ? 2 : 1;
    for (std::size_t i = 0; i < vertex_count * corners; ++i)
        primitive.indices.push_back(std::uint32_t(random.between(0, std::int64_t(vertex_count) - 1)));
    return primitive;
}

void add_targets(Primitive& primitive, Random& random) {
    primitive.morph_targets.resize(5);
    for (MorphTarget& target : primitive.morph_targets) {
        for (std::size_t i = 0; i < primitive.positions.size(); ++i) {
            target.positions.push_back(vector(random, 0.3));
            target.normals.push_back(vector(random, 0.3));
        }
    }
    primitive.morph_targets[1].positions.clear();
    primitive.morph_targets[2].normals.clear();
}

SkinWeights weights(Random& random, std::int64_t joint_count) {
    SkinWeights out;
    for (int i = 0; i < 4; ++i) {
        out.joints[i] = std::uint16_t(random.between(0, joint_count - 1));
        out.weights[i] = random.between(0, 4) == 0 ? 0.0F : number(random, 0.0, 0.3);
    }
    return out;
}

void add_influences(Primitive& primitive, Random& random, std::int64_t joint_count) {
    primitive.more_skin.resize(1);
    for (std::size_t i = 0; i < primitive.positions.size(); ++i) {
        primitive.skin.push_back(weights(random, joint_count));
        primitive.more_skin[0].push_back(weights(random, joint_count));
    }
    primitive.skin[0] = primitive.more_skin[0][0] = SkinWeights{};
    primitive.skin[1].weights = glm::vec4(2.0F, -1.5F, 0.25F, 0.0F);
}

int add_mesh(Scene& scene, Primitive primitive) {
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.morph_weights.assign(primitive.morph_targets.size(), 0.25F);
    mesh.primitives.push_back(std::move(primitive));
    return int(scene.meshes.size()) - 1;
}

/// Adds a child of `parent`, or a root.
int add_node(Scene& scene, int parent, const Trs& trs, int mesh = -1, int skin = -1) {
    const int index = int(scene.nodes.size());
    Node& node = scene.nodes.emplace_back();
    node.trs = trs;
    node.mesh = mesh;
    node.skin = skin;
    if (parent < 0) {
        scene.scenes[0].nodes.push_back(index);
    } else {
        scene.nodes[std::size_t(parent)].children.push_back(index);
    }
    return index;
}

Trs place(Random& random, const glm::dvec3& scale = glm::dvec3(1.0)) {
    const glm::dvec3 translation(vector(random, 2.0));
    return {translation, rotation(random), scale};
}

void animate(Scene& scene, int node, Path path, Interpolation interpolation, int width, Random& random,
             double reach) {
    Channel channel{node, path, interpolation, width, {0.0F, 0.7F, 2.0F}, {}};
    const int count = 3 * width * (interpolation == Interpolation::cubic_spline ? 3 : 1);
    for (int i = 0; i < count; ++i)
        channel.values.push_back(number(random, -reach, reach));
    if (path == Path::weights) channel.values[3] = channel.values[4] = 0.0F;
    scene.animations[0].channels.push_back(channel);
}

Scene empty_scene() {
    Scene scene;
    scene.name = "test";
    scene.scenes.resize(1);
    scene.animations.resize(1);
    scene.animations[0].duration = 2.0;
    return scene;
}

void add_skin(Scene& scene, int root, int joint_count, Random& random) {
    Skin skin;
    for (int i = 0; i < joint_count; ++i) {
        const int joint = add_node(scene, i % 3 == 0 ? root : skin.joints.back(), place(random));
        skin.joints.push_back(joint);
        skin.joint_from_mesh.push_back(
            glm::translate(glm::mat4_cast(rotation(random)), glm::dvec3(vector(random, 1.0))));
        animate(scene, joint, Path::rotation, Interpolation::linear, 4, random, 1.0);
    }
    scene.skins.push_back(skin);
}

}  // namespace

Scene moving_zoo(std::uint32_t seed) {
    Random random(seed);
    Scene scene = empty_scene();
    const int root = add_node(scene, -1, place(random, {-1.3, 0.7, 2.1}));
    animate(scene, root, Path::translation, Interpolation::cubic_spline, 3, random, 2.0);
    add_skin(scene, root, 9, random);

    Primitive morphed = cloud(random, 40, Topology::triangles);
    add_targets(morphed, random);
    const int morphing = add_node(scene, root, place(random), add_mesh(scene, std::move(morphed)));
    animate(scene, morphing, Path::weights, Interpolation::cubic_spline, 5, random, 1.0);
    animate(scene, morphing, Path::scale, Interpolation::linear, 3, random, 2.0);

    Primitive skinned = cloud(random, 60, Topology::triangles);
    add_influences(skinned, random, 9);
    add_node(scene, root, place(random), add_mesh(scene, std::move(skinned)), 0);

    Primitive both = cloud(random, 40, Topology::triangles);
    add_targets(both, random);
    add_influences(both, random, 9);
    const int bending = add_node(scene, -1, place(random), add_mesh(scene, std::move(both)), 0);
    animate(scene, bending, Path::weights, Interpolation::linear, 5, random, 1.0);

    const int flock =
        add_node(scene, root, place(random), add_mesh(scene, cloud(random, 20, Topology::triangles)));
    for (int i = 0; i < 5; ++i)
        scene.nodes[std::size_t(flock)].instances.push_back(place(random, glm::dvec3(vector(random, 1.0))));
    animate(scene, flock, Path::rotation, Interpolation::step, 4, random, 1.0);
    add_node(scene, root, place(random), add_mesh(scene, cloud(random, 20, Topology::lines)));
    add_node(scene, flock, place(random), add_mesh(scene, cloud(random, 20, Topology::points)));
    add_node(scene, flock, place(random, {1.0, 0.0, 1.0}),
             add_mesh(scene, cloud(random, 20, Topology::triangles)));
    return scene;
}

Scene sliding_triangle(float distance) {
    Scene scene = empty_scene();
    Primitive primitive;
    primitive.positions = {{0.25F, 0.25F, 0.5F}, {0.75F, 0.25F, 0.5F}, {0.25F, 0.75F, 0.75F}};
    primitive.indices = {0, 1, 2};
    add_node(scene, -1, {}, add_mesh(scene, std::move(primitive)));
    scene.animations[0].channels.push_back({0,
                                            Path::translation,
                                            Interpolation::linear,
                                            3,
                                            {0.0F, 2.0F},
                                            {0.0F, 0.0F, 0.0F, distance, 0.0F, 0.0F}});
    return scene;
}

Scene points_at(std::vector<glm::vec3> positions) {
    Scene scene = empty_scene();
    Primitive primitive;
    primitive.topology = Topology::points;
    primitive.positions = std::move(positions);
    primitive.indices.resize(primitive.positions.size());
    std::iota(primitive.indices.begin(), primitive.indices.end(), 0U);
    add_node(scene, -1, {}, add_mesh(scene, std::move(primitive)));
    return scene;
}

}  // namespace cairn::test
