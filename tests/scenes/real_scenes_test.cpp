// The real scenes of CAIRN_SCENE_DATA against the counts of their MANIFEST.md.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scenes/load.h"
#include "scenes/snapshot.h"

namespace cairn::scenes {
namespace {

const std::filesystem::path data = CAIRN_SCENE_DATA;

/// A row of the manifest's table of glTF files.
struct Row {
    std::string file;
    std::uint64_t triangles = 0;        ///< triangles of the meshes, each once
    std::uint64_t scene_triangles = 0;  ///< triangles of the default scene, with instances
    std::size_t nodes = 0;
};

void PrintTo(const Row& row, std::ostream* out) {
    *out << row.file;
}

std::vector<Row> manifest() {
    std::vector<Row> rows;
    std::ifstream stream(data / "MANIFEST.md");
    for (std::string line; std::getline(stream, line);) {
        if (!line.starts_with("| gltf/")) continue;
        std::vector<std::string> cells;
        std::istringstream cut(line);
        for (std::string cell; std::getline(cut, cell, '|');) {
            const auto first = cell.find_first_not_of(' ');
            cells.push_back(
                first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(' ') - first + 1));
        }
        rows.push_back(
            {cells.at(1), std::stoull(cells.at(3)), std::stoull(cells.at(4)), std::stoull(cells.at(5))});
    }
    return rows;
}

std::uint64_t mesh_triangles(const Scene& scene) {
    std::uint64_t count = 0;
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& primitive : mesh.primitives)
            if (primitive.topology == Topology::triangles) count += primitive.element_count();
    return count;
}

/// Counts what the Scene holds, each mesh once.
std::size_t geometry_bytes(const Scene& scene) {
    std::size_t bytes = 0;
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& p : mesh.primitives)
            bytes += p.indices.size() * 4 + p.positions.size() * 12 + p.normals.size() * 12 +
                     p.texcoords.size() * 8 + p.colors.size() * 8;
    for (const Node& node : scene.nodes)
        bytes += sizeof(Node) + node.instances.size() * sizeof(Trs);
    return bytes;
}

class Manifest : public testing::TestWithParam<Row> {};

TEST_P(Manifest, CountsEqualOurs) {
    const Scene scene = load((data / GetParam().file).string());
    const Snapshot snapshot = take_snapshot(scene);
    EXPECT_EQ(mesh_triangles(scene), GetParam().triangles);
    EXPECT_EQ(snapshot.triangle_count, GetParam().scene_triangles);
    EXPECT_EQ(scene.nodes.size(), GetParam().nodes);
    EXPECT_FALSE(snapshot.bounds.empty());
    for (const Warning& warning : scene.warnings)
        ADD_FAILURE() << "unexpected warning: " << warning.text;
}

std::string test_name(const testing::TestParamInfo<Row>& info) {
    std::string name = std::filesystem::path(info.param.file).stem().string();
    std::ranges::replace_if(
        name, [](unsigned char letter) { return std::isalnum(letter) == 0; }, '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Data, Manifest, testing::ValuesIn(manifest()), test_name);

TEST(Data, EveryFileIsInTheManifest) {
    const auto rows = manifest();
    for (const auto& entry : std::filesystem::recursive_directory_iterator(data / "gltf")) {
        const auto extension = entry.path().extension();
        if (extension != ".glb" && extension != ".gltf") continue;
        const std::string file = std::filesystem::relative(entry.path(), data).string();
        EXPECT_TRUE(std::ranges::any_of(rows, [&](const Row& row) { return row.file == file; })) << file;
    }
}

/// Plays every animation of every file: no vertex flies off, and the counts stay the same.
TEST(Data, EveryAnimationCanBePlayed) {
    for (const Row& row : manifest()) {
        const Scene scene = load((data / row.file).string());
        for (int a = 0; a < static_cast<int>(scene.animations.size()); ++a)
            for (const double part : {0.0, 0.31, 0.5, 1.0, 2.0}) {
                const double seconds = part * scene.animations[static_cast<std::size_t>(a)].duration;
                const Snapshot snapshot = take_snapshot(scene, {seconds, a, std::nullopt});
                EXPECT_EQ(snapshot.triangle_count, row.scene_triangles) << row.file << ", animation " << a;
            }
    }
}

struct GeneratorCount {
    const char* folder;
    int models;
};

TEST(Data, EveryModelOfTheAssetGeneratorLoads) {
    for (const auto& [folder, models] : {GeneratorCount{"Animation_Node", 6},
                                         {"Animation_Skin", 12},
                                         {"Buffer_Interleaved", 5},
                                         {"Material_AlphaMask", 7},
                                         {"Mesh_PrimitiveMode", 16},
                                         {"Node_Attribute", 9}})
        for (int i = 0; i < models; ++i) {
            const std::string file = fmt::format("asset-generator/{0}/{0}_{1:02}.gltf", folder, i);
            const Scene scene = load((data / file).string());
            const Snapshot snapshot = take_snapshot(scene);
            EXPECT_GT(snapshot.triangle_count + snapshot.line_count + snapshot.point_count, 0U) << file;
            EXPECT_TRUE(scene.warnings.empty()) << file << ": " << scene.warnings.front().text;
        }
}

/// The same square with and without indices, as points, lines, loop, strip and triangles, strip, fan.
TEST(Data, PrimitiveModesGiveTheirElements) {
    struct Elements {
        std::uint64_t points, lines, triangles;
    };
    const Elements of_mode[] = {{1024, 0, 0}, {0, 4, 0}, {0, 4, 0}, {0, 4, 0},
                                {0, 0, 2},    {0, 0, 2}, {0, 0, 2}};
    for (int i = 0; i < 16; ++i) {
        const Elements& expected = of_mode[i < 14 ? i % 7 : 6];
        const Scene scene =
            load((data / fmt::format("asset-generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_{:02}.gltf", i))
                     .string());
        const Snapshot snapshot = take_snapshot(scene);
        EXPECT_EQ(snapshot.point_count, expected.points) << i;
        EXPECT_EQ(snapshot.line_count, expected.lines) << i;
        EXPECT_EQ(snapshot.triangle_count, expected.triangles) << i;
        EXPECT_EQ(snapshot.bounds.low, glm::dvec3(-0.5, -0.5, 0.0)) << i;
        EXPECT_EQ(snapshot.bounds.high, glm::dvec3(0.5, 0.5, 0.0)) << i;
    }
}

/// Finds the vertex of a mesh that lies nearest to a point, if one lies within `reach`.
class NearestVertex {
public:
    NearestVertex(const std::vector<glm::vec3>& points, float reach) : points_(points), reach_(reach) {
        for (std::size_t i = 0; i < points.size(); ++i)
            cells_[cell(points[i])].push_back(i);
    }

    [[nodiscard]] std::size_t operator()(const glm::vec3& point) const {
        std::size_t best = points_.size();
        float best_distance = reach_;
        const Cell middle = cell(point);
        for (int n = 0; n < 27; ++n) {
            const auto found =
                cells_.find({middle[0] + n % 3 - 1, middle[1] + n / 3 % 3 - 1, middle[2] + n / 9 - 1});
            if (found == cells_.end()) continue;
            for (const std::size_t i : found->second) {
                const float distance = glm::distance(points_[i], point);
                if (distance >= best_distance) continue;
                best_distance = distance;
                best = i;
            }
        }
        return best;
    }

private:
    using Cell = std::array<int, 3>;
    [[nodiscard]] Cell cell(const glm::vec3& point) const {
        const glm::vec3 scaled = glm::floor(point / reach_);
        return {static_cast<int>(scaled.x), static_cast<int>(scaled.y), static_cast<int>(scaled.z)};
    }

    const std::vector<glm::vec3>& points_;
    float reach_;
    std::map<Cell, std::vector<std::size_t>> cells_;
};

using Triangle = std::array<std::size_t, 3>;

/// The triangles of a primitive by `name_of` their corners, each begun at its smallest, sorted.
template <typename NameOf>
std::vector<Triangle> triangle_set(const Primitive& primitive, NameOf name_of) {
    std::vector<Triangle> set;
    for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
        Triangle triangle{};
        for (std::size_t c = 0; c < 3; ++c)
            triangle[c] = name_of(primitive.positions[primitive.indices[i + c]]);
        std::rotate(triangle.begin(), std::ranges::min_element(triangle), triangle.end());
        set.push_back(triangle);
    }
    std::ranges::sort(set);
    return set;
}

/// Draco reorders vertices and triangles, so each corner is identified by the plain bunny's vertex at its
/// place.
TEST(Data, TheDracoBunnyIsThePlainBunny) {
    const Scene plain = load((data / "gltf/stanford_bunny_69k.glb").string());
    const Scene packed = load((data / "gltf/stanford_bunny_69k_draco.glb").string());
    const Bounds bounds = take_snapshot(plain).bounds;
    const double side = bounds.high.x - bounds.low.x;
    const auto step = static_cast<float>(side / (1 << 14));  // the stream has 14 bits a coordinate
    const Primitive& a = plain.meshes.at(0).primitives.at(0);
    const Primitive& b = packed.meshes.at(0).primitives.at(0);
    const NearestVertex nearest(a.positions, step);
    for (const glm::vec3& position : b.positions)
        ASSERT_LT(nearest(position), a.positions.size())
            << position.x << ' ' << position.y << ' ' << position.z;
    EXPECT_EQ(triangle_set(a, nearest), triangle_set(b, nearest));
}

TEST(Data, TheMeshoptDragonIsThePlainDragon) {
    const Scene plain = load((data / "gltf/stanford_dragon_871k.glb").string());
    const Scene packed = load((data / "gltf/stanford_dragon_871k_meshopt.glb").string());
    const Snapshot a = take_snapshot(plain);
    const Snapshot b = take_snapshot(packed);
    EXPECT_EQ(a.triangle_count, b.triangle_count);
    const double step = (a.bounds.high.x - a.bounds.low.x) / (1 << 14);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(a.bounds.low[c], b.bounds.low[c], 2.0 * step);
        EXPECT_NEAR(a.bounds.high[c], b.bounds.high[c], 2.0 * step);
    }
}

TEST(Data, InstancesStayShared) {
    const std::pair<const char*, std::size_t> most_bytes[] = {
        {"gltf/TeapotsGalore/TeapotsGalore.gltf", 1U << 20U},
        {"gltf/kaykit_city.glb", 16U << 20U},
        {"gltf/forest_mask_1200.glb", 8U << 20U}};
    for (const auto& [file, most] : most_bytes)
        EXPECT_LT(geometry_bytes(load((data / file).string())), most) << file;
}

/// The arrow of this model must point at the sign "Correct": KHR_texture_transform turns the right way round.
TEST(Data, TheTextureTransformTestPointsAtCorrect) {
    const Scene scene = load((data / "gltf/TextureTransformTest/TextureTransformTest.gltf").string());
    const auto texture_coordinate = [&](const char* tile, const char* sign) {
        const auto named = [&](const char* name) {
            return std::ranges::find_if(scene.nodes, [&](const Node& node) { return node.name == name; });
        };
        const glm::dvec3 at =
            named(sign)->trs.translation;  // in the tile, whose texture runs from (-0.5, 0.5)
        const int material = scene.meshes[static_cast<std::size_t>(named(tile)->mesh)].primitives[0].material;
        return scene.materials[static_cast<std::size_t>(material)].uv_from_mesh *
               glm::vec3(at.x + 0.5, 0.5 - at.y, 1.0);
    };
    // The arrow's tip is at (0.69, 0.69) of its picture; the signs stand just before it.
    for (const auto& [tile, sign] :
         {std::pair("Rotation", "Rotation - Correct"), std::pair("Scale", "Scale - Correct"),
          std::pair("All", "All - Correct")}) {
        const glm::vec3 uv = texture_coordinate(tile, sign);
        EXPECT_NEAR(uv.x, 0.77F, 0.03F) << tile;
        EXPECT_NEAR(uv.y, 0.77F, 0.03F) << tile;
    }
}

TEST(Data, MultiSceneHasThreeScenesLightsAndACamera) {
    const Scene scene = load((data / "gltf/multi_scene.glb").string());
    ASSERT_EQ(scene.scenes.size(), 3U);
    EXPECT_EQ(scene.default_scene, 1);
    std::size_t lights = 0;
    std::size_t cameras = 0;
    std::uint64_t triangles = 0;
    for (int i = 0; i < 3; ++i) {
        const Snapshot snapshot = take_snapshot(scene, {0.0, std::nullopt, i});
        lights += snapshot.lights.size();
        cameras += snapshot.cameras.size();
        triangles += snapshot.triangle_count;
    }
    EXPECT_EQ(triangles, mesh_triangles(scene));
    EXPECT_EQ(lights, 2U);
    EXPECT_EQ(cameras, 1U);
}

}  // namespace
}  // namespace cairn::scenes
