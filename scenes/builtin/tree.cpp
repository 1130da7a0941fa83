#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scenes/builtin/generators.h"

// A tree of the size of Forest et al. 2009, Figure 5c (607,608 polygons): a trunk, three orders of branches
// as tapered tubes, and leaves on the last order. How many of each is fixed; the random stream only moves
// them.

namespace cairn::scenes {
namespace {

/// Radians; the golden section of a full turn, so that neighbours never stand in line.
constexpr double golden_angle = 2.399963229728653;

/// One order of branches: the resolution of its tubes, and its relation to the order before.
struct Order {
    std::uint32_t children;  ///< on each branch of the order before
    std::uint32_t sections;
    std::uint32_t sides;
    double length;     ///< length of the lowest child, in lengths of the branch it stands on
    double thickness;  ///< thickness of the lowest child, in thicknesses of that branch there
    double lowest;     ///< place of the lowest child on that branch, 0 = foot, 1 = tip
    double spread;     ///< radians from the direction of the branch it stands on
    double wander;     ///< change of direction over the branch
    double lift;       ///< upward turn over the branch
};

constexpr std::array<Order, 4> orders = {
    Order{1, 32, 20, 0.0, 0.0, 0.0, 0.0, 0.25, 0.3},
    Order{18, 14, 12, 0.56, 0.55, 0.28, 1.2, 0.5, 0.3},
    Order{9, 8, 8, 0.5, 0.6, 0.25, 0.85, 0.6, 0.2},
    Order{8, 4, 5, 0.42, 0.6, 0.2, 0.75, 0.6, 0.0},
};
constexpr std::uint32_t leaves_on_a_twig = 52;
constexpr double trunk_length = 3.4;
constexpr double trunk_radius = 0.16;

/// A branch's axis: `orders[order].sections` + 1 points, and the radius at each.
struct Branch {
    std::size_t order = 0;
    double length = 0.0;
    std::vector<glm::dvec3> points;
    std::vector<glm::dvec3> directions;  ///< unit directions, one per point
    std::vector<double> radii;
};

/// Any unit vector square to a unit vector.
glm::dvec3 square_to(const glm::dvec3& direction) {
    const glm::dvec3 other =
        std::abs(direction.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0);
    return glm::normalize(glm::cross(direction, other));
}

/// The unit vector `angle` away from `direction`, on the side that `azimuth` names.
glm::dvec3 tilted(const glm::dvec3& direction, double angle, double azimuth) {
    const glm::dvec3 side = square_to(direction);
    const glm::dvec3 across = glm::cross(direction, side);
    return std::cos(angle) * direction +
           std::sin(angle) * (std::cos(azimuth) * side + std::sin(azimuth) * across);
}

glm::dvec3 random_vector(RandomStream& random) {
    const double x = random.between(-1.0, 1.0);
    const double y = random.between(-1.0, 1.0);
    return {x, y, random.between(-1.0, 1.0)};
}

class TreeGrower {
public:
    TreeGrower(Primitive& bark, Primitive& foliage, Leaves leaves)
        : bark_(bark), foliage_(foliage), leaves_(leaves) {}

    void grow() {
        grow_branch(0, {0.0, -trunk_length * 0.6, 0.0}, {0.0, 1.0, 0.0}, trunk_length, trunk_radius);
    }

private:
    void grow_branch(std::size_t order, glm::dvec3 foot, glm::dvec3 direction, double length, double radius);
    void grow_children(const Branch& branch);
    void grow_leaves(const Branch& twig);
    void add_tube(const Branch& branch);
    void add_leaf(const glm::dvec3& foot, const glm::dvec3& along, const glm::dvec3& up, double length);
    void add_modelled_leaf(const glm::dvec3& foot, const glm::dmat3& leaf_frame, double length);
    void add_card(const glm::dvec3& foot, const glm::dmat3& leaf_frame, double length);

    Primitive& bark_;
    Primitive& foliage_;
    Leaves leaves_;
    RandomStream random_{607608};
    /// Apart, so that both kinds of leaves stand on the same branches.
    RandomStream leaf_random_{6848};
};

void TreeGrower::grow_branch(std::size_t order, glm::dvec3 foot, glm::dvec3 direction, double length,
                             double radius) {
    const Order& shape = orders[order];
    Branch branch;
    branch.order = order;
    branch.length = length;
    for (std::uint32_t section = 0; section <= shape.sections; ++section) {
        const double way = static_cast<double>(section) / shape.sections;
        branch.points.push_back(foot);
        branch.directions.push_back(direction);
        branch.radii.push_back(radius * (1.0 - 0.85 * way));
        const glm::dvec3 bend = shape.wander * random_vector(random_) + glm::dvec3(0.0, shape.lift, 0.0);
        foot += length / shape.sections * direction;
        direction = glm::normalize(direction + bend / static_cast<double>(shape.sections));
    }
    // The trunk's root flares out.
    if (order == 0) {
        branch.radii[0] *= 1.5;
        branch.radii[1] *= 1.15;
    }
    add_tube(branch);
    if (order + 1 < orders.size()) {
        grow_children(branch);
    } else {
        grow_leaves(branch);
    }
}

void TreeGrower::grow_children(const Branch& branch) {
    const Order& shape = orders[branch.order + 1];
    const std::uint32_t sections = orders[branch.order].sections;
    const double first_azimuth = random_.between(0.0, 2.0 * std::numbers::pi);
    for (std::uint32_t child = 0; child < shape.children; ++child) {
        // The section is found in integers, so that no rounding can move a child to another one.
        const std::uint32_t first_section = static_cast<std::uint32_t>(shape.lowest * sections);
        const std::uint32_t section = first_section + (sections - first_section) * child / shape.children;
        const double way =
            static_cast<double>(child) / shape.children;  // 0 at the lowest child, near 1 at the tip
        const double spread = shape.spread * (1.0 - 0.45 * way) * random_.between(0.85, 1.15);
        const double azimuth = first_azimuth + golden_angle * child + random_.between(-0.3, 0.3);
        const glm::dvec3 direction = tilted(branch.directions[section], spread, azimuth);
        const double length = branch.length * shape.length * (1.0 - 0.65 * way) * random_.between(0.85, 1.15);
        grow_branch(branch.order + 1, branch.points[section], direction, length,
                    branch.radii[section] * shape.thickness);
    }
}

void TreeGrower::grow_leaves(const Branch& twig) {
    const std::uint32_t sections = orders[twig.order].sections;
    const double first_azimuth = leaf_random_.between(0.0, 2.0 * std::numbers::pi);
    for (std::uint32_t leaf = 0; leaf < leaves_on_a_twig; ++leaf) {
        const std::uint32_t place = leaf * sections;
        const std::uint32_t section = place / leaves_on_a_twig;
        const double within = static_cast<double>(place % leaves_on_a_twig) / leaves_on_a_twig;
        const glm::dvec3 foot = glm::mix(twig.points[section], twig.points[section + 1], within);
        const double azimuth = first_azimuth + golden_angle * leaf;
        const glm::dvec3 along = tilted(twig.directions[section], leaf_random_.between(0.5, 1.3), azimuth);
        const glm::dvec3 up = glm::dvec3(0.0, 1.0, 0.0) + 0.6 * random_vector(leaf_random_);
        add_leaf(foot, along, up, leaf_random_.between(0.045, 0.08));
    }
}

/// A tapered tube whose last ring is one point: its tip.
void TreeGrower::add_tube(const Branch& branch) {
    const std::uint32_t sides = orders[branch.order].sides;
    const auto first = static_cast<std::uint32_t>(bark_.positions.size());
    const std::size_t tip_section = branch.points.size() - 1;
    glm::dvec3 side = square_to(branch.directions[0]);
    for (std::size_t section = 0; section < tip_section; ++section) {
        // The frame is carried along the axis: squared up again at each section, it does not twist.
        const glm::dvec3& axis = branch.directions[section];
        side = glm::normalize(side - glm::dot(side, axis) * axis);
        const glm::dvec3 across = glm::cross(axis, side);
        for (std::uint32_t i = 0; i < sides; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / sides;
            const glm::dvec3 normal = std::cos(angle) * side + std::sin(angle) * across;
            bark_.positions.emplace_back(branch.points[section] + branch.radii[section] * normal);
            bark_.normals.emplace_back(normal);
        }
    }
    bark_.positions.emplace_back(branch.points[tip_section]);
    bark_.normals.emplace_back(branch.directions[tip_section]);
    const auto tip = static_cast<std::uint32_t>(bark_.positions.size()) - 1;
    for (std::uint32_t ring = first; ring + sides <= tip; ring += sides) {
        for (std::uint32_t i = 0; i < sides; ++i) {
            const std::uint32_t next = (i + 1) % sides;
            if (ring + sides == tip) {
                bark_.indices.insert(bark_.indices.end(), {ring + i, ring + next, tip});
                continue;
            }
            const std::uint32_t above = ring + sides;
            bark_.indices.insert(bark_.indices.end(), {ring + i, ring + next, above + next});
            bark_.indices.insert(bark_.indices.end(), {ring + i, above + next, above + i});
        }
    }
}

void TreeGrower::add_leaf(const glm::dvec3& foot, const glm::dvec3& along, const glm::dvec3& up,
                          double length) {
    const glm::dvec3 across = glm::normalize(glm::cross(along, up));
    const glm::dmat3 leaf_frame(across, along, glm::cross(across, along));
    if (leaves_ == Leaves::triangles) {
        add_modelled_leaf(foot, leaf_frame, length);
    } else {
        add_card(foot, leaf_frame, length);
    }
    const double age = leaf_random_.unit();
    const auto shade = [&](double young, double old) {
        return static_cast<std::uint16_t>(65535.0 * (young + (old - young) * age));
    };
    const glm::u16vec4 color(shade(0.7, 1.0), shade(1.0, 0.75), shade(0.8, 0.5), 65535);
    foliage_.colors.resize(foliage_.positions.size(), color);
}

/// Eight triangles: foot, two stations of left, middle and right, tip; folded along the middle and drooping.
void TreeGrower::add_modelled_leaf(const glm::dvec3& foot, const glm::dmat3& leaf_frame, double length) {
    constexpr std::array<glm::dvec3, 8> points = {{{0.0, 0.0, 0.0},
                                                   {-0.26, 0.38, 0.06},
                                                   {0.0, 0.36, 0.0},
                                                   {0.26, 0.38, 0.06},
                                                   {-0.2, 0.72, 0.01},
                                                   {0.0, 0.72, -0.05},
                                                   {0.2, 0.72, 0.01},
                                                   {0.0, 1.0, -0.16}}};
    constexpr std::array<std::uint32_t, 24> corners = {0, 2, 1, 0, 3, 2, 1, 2, 5, 1, 5, 4,
                                                       2, 3, 6, 2, 6, 5, 4, 5, 7, 5, 6, 7};
    const auto first = static_cast<std::uint32_t>(foliage_.positions.size());
    for (const glm::dvec3& point : points) {
        foliage_.positions.emplace_back(foot + length * (leaf_frame * point));
        // Away from the fold to either side, and more so towards the tip: what the triangles do, smoothed.
        foliage_.normals.emplace_back(
            glm::normalize(leaf_frame * glm::dvec3(-0.8 * point.x, 0.3 * point.y, 1.0)));
    }
    for (const std::uint32_t corner : corners) {
        foliage_.indices.push_back(first + corner);
    }
}

/// Two triangles under a texture that cuts the leaf out of them.
void TreeGrower::add_card(const glm::dvec3& foot, const glm::dmat3& leaf_frame, double length) {
    const auto first = static_cast<std::uint32_t>(foliage_.positions.size());
    constexpr std::array<glm::dvec2, 4> corners = {{{0.0, 1.0}, {1.0, 1.0}, {1.0, 0.0}, {0.0, 0.0}}};
    for (const glm::dvec2& texcoord : corners) {
        const glm::dvec3 point((texcoord.x - 0.5) * 0.6, 1.0 - texcoord.y, 0.0);
        foliage_.positions.emplace_back(foot + length * (leaf_frame * point));
        foliage_.normals.emplace_back(leaf_frame[2]);
        foliage_.texcoords.emplace_back(texcoord);
    }
    foliage_.indices.insert(foliage_.indices.end(),
                            {first, first + 1, first + 2, first, first + 2, first + 3});
}

/// A leaf upright in its image, green with a pale midrib. Arithmetic alone, so every machine cuts the same
/// leaf.
Image make_leaf_image() {
    constexpr int width = 64;
    constexpr int height = 64;
    Image image{"leaf", width, height, {}};
    for (int row = 0; row < height; ++row) {
        for (int column = 0; column < width; ++column) {
            const double from_foot = 1.0 - (row + 0.5) / height;
            const double from_middle = std::abs((column + 0.5) / width - 0.5) * 2.0;
            const double half_width = 4.3 * from_foot * (1.0 - from_foot) * (1.0 - 0.3 * from_foot);
            // Alpha falls over some texels, so that a cutoff of one half follows the outline when it is
            // magnified.
            const double inside = (half_width - from_middle) * width / 2.0 / 3.0 + 0.5;
            const double alpha = std::min(std::max(inside, 0.0), 1.0);
            const double vein = std::max(0.0, 1.0 - from_middle * 12.0);
            const auto texel = [](double value) { return static_cast<std::uint8_t>(std::lround(value)); };
            image.rgba.insert(image.rgba.end(), {texel(92.0 + 45.0 * vein), texel(140.0 + 40.0 * vein),
                                                 texel(52.0 + 40.0 * vein), texel(255.0 * alpha)});
        }
    }
    return image;
}

/// The material of the leaves; returns its index.
int add_leaf_material(Scene& scene, Leaves leaves) {
    const int index = add_material(scene, "leaf", {0.11F, 0.27F, 0.035F});
    Material& material = scene.materials[index];
    material.double_sided = true;
    if (leaves == Leaves::masked_cards) {
        scene.images.push_back(make_leaf_image());
        scene.textures.push_back({0, Wrap::clamp_to_edge, Wrap::clamp_to_edge});
        material.base_color = glm::vec4(1.0F);
        material.texture = 0;
        material.alpha_mode = AlphaMode::mask;
    }
    return index;
}

}  // namespace

Scene make_tree(Leaves leaves) {
    Scene scene;
    Mesh mesh;
    mesh.name = "tree";
    mesh.primitives.resize(2);
    mesh.primitives[0].material = add_material(scene, "bark", {0.19F, 0.115F, 0.065F});
    mesh.primitives[1].material = add_leaf_material(scene, leaves);
    TreeGrower(mesh.primitives[0], mesh.primitives[1], leaves).grow();
    scene.meshes.push_back(std::move(mesh));
    scene.scenes.push_back({"tree", {add_node(scene, "tree", 0)}});
    return scene;
}

}  // namespace cairn::scenes
