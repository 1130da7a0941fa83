// Traps for voxelizers, one test per trap. voxelizer_test.cpp has the traps of single triangles.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "scenes/load.h"
#include "shaders/interop/surface.h"
#include "shaders/interop/voxelize.h"
#include "tests/support/gltf_file.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_scenes.h"
#include "tests/support/voxelizer_fixture.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;

constexpr std::int64_t N = lattice_side;

class Traps : public ConservativeTest {
protected:
    [[nodiscard]] BitGrid voxelize_scene(const scenes::Scene& scene, const Grid& grid) {
        return voxelizer().voxelize(upload(build_surface(scene, scenes::take_snapshot(scene), grid)),
                                    whole(grid));
    }
    [[nodiscard]] BitGrid voxelize_around(const scenes::Scene& scene, int resolution) {
        return voxelize_scene(scene, grid_around(scenes::take_snapshot(scene).bounds, resolution));
    }
    void expect_exact(const Surface& surface, const Region& region, const std::string& what) {
        const BitGrid truth = reference::exact_voxels(surface, region);
        EXPECT_TRUE(same_bits(voxelizer().voxelize(upload(surface), region), truth)) << what;
        EXPECT_GT(truth.count(), 0U) << what;
    }
};

// ---- Words
// ---------------------------------------------------------------------------------------------------------

TEST_F(Traps, SpansBeginAndEndAtEveryBitOfAWord) {
    // A row for each pair of ends within three words, one of which is cut short; `1 << 32` is not defined in
    // GLSL.
    constexpr int width = 70;
    const Region region{7, {3, 0, 0}, {width, 128, 128}};
    const std::int64_t side = region.voxel_side();
    std::vector<LatticeTriangle> segments;
    BitGrid expected(region.size);
    int row = 0;
    for (int first = 0; first < width; ++first) {
        for (int last = first; last < width; ++last, ++row) {
            // Through the middles of voxels of every second row, so that no neighbour is touched.
            const glm::ivec3 voxel(0, row % 64 * 2, row / 64 * 2);
            const auto middle = [&](int x) {
                return glm::i64vec3(region.origin + voxel + glm::ivec3(x, 0, 0)) * side + side / 2;
            };
            segments.push_back({middle(first), middle(last), middle(first)});
            for (int x = first; x <= last; ++x)
                expected.set(voxel + glm::ivec3(x, 0, 0));
        }
    }
    ASSERT_LT(row, 64 * 64);
    EXPECT_TRUE(same_bits(voxelize(segments, region), expected));
}

TEST_F(Traps, ThousandsOfVoxelsAlongAnAxisAreExact) {
    Random random(61);
    for (int axis = 0; axis < 3; ++axis) {
        Region region{12, glm::ivec3(2040), glm::ivec3(9)};
        region.origin[axis] = 0;
        region.size[axis] = 4096;
        const std::int64_t side = region.voxel_side();
        std::vector<LatticeTriangle> triangles;
        for (int i = 0; i < 12; ++i) {
            LatticeTriangle& t = triangles.emplace_back();
            for (glm::i64vec3& p : t) {
                p = glm::i64vec3(region.origin) * side + random.point(0, 9 * side);
                p[axis] = random.between(0, N);
            }
        }
        expect_exact(lattice_surface(triangles, 4096), region, fmt::format("axis {}", axis));
    }
}

// ---- The limits of what shaders compute
// ----------------------------------------------------------------------------

TEST_F(Traps, CornersAtTheEndsOfTheShadersRangeAreExact) {
    // The largest normals with the smallest voxels, for which each unit counts.
    Random random(62);
    int met = 0;
    for (int i = 0; i < 400; ++i) {
        LatticeTriangle t;
        for (glm::i64vec3& p : t) {
            for (int axis = 0; axis < 3; ++axis)
                p[axis] =
                    random.between(0, 1) == 0 ? -N + random.between(0, 1) : 2 * N - random.between(0, 1);
        }
        const std::int64_t u = random.between(0, 1024);
        const std::int64_t v = random.between(0, 1024 - u);
        const glm::i64vec3 inside = t[0] + ((t[1] - t[0]) * u + (t[2] - t[0]) * v) / std::int64_t(1024);
        const int level = int(random.between(18, 24));
        Region region{level, glm::ivec3(0), glm::ivec3(9)};
        region.origin = glm::ivec3(inside / std::int64_t(region.voxel_side())) - 4;
        const BitGrid truth = voxels_of(t, region);
        met += truth.count() > 0 ? 1 : 0;
        ASSERT_TRUE(same_bits(voxelize({t}, region), truth)) << to_string(t) << "level " << level;
    }
    EXPECT_GT(met, 200);
}

TEST_F(Traps, MoreTrianglesThanOneBatchAreExact) {
    Random random(63);
    std::vector<LatticeTriangle> triangles;
    for (int i = 0; i < int(BatchLimits().triangles) + 1000; ++i) {
        const glm::i64vec3 p = random.point(0, N);
        triangles.push_back({p, p + random.point(-9999, 9999), p + random.point(-9999, 9999)});
    }
    expect_exact(lattice_surface(triangles, 128), {7, glm::ivec3(0), glm::ivec3(128)}, "");
}

TEST_F(Traps, EveryChunkOfASurfaceCounts) {
    Random random(64);
    const Region region{5, glm::ivec3(0), glm::ivec3(32)};
    std::vector<LatticeTriangle> triangles;
    for (int i = 0; i < 30; ++i)
        triangles.push_back(random_triangle(random, region.voxel_side()));
    Surface surface = lattice_surface({triangles.begin(), triangles.begin() + 10}, 32);
    for (const int first : {10, 20}) {
        surface.chunks.push_back(
            lattice_surface({triangles.begin() + first, triangles.begin() + first + 10}, 32).chunks[0]);
    }
    const GpuSurface on_gpu = upload(surface);
    EXPECT_TRUE(same_bits(voxelizer().voxelize(on_gpu, region), voxelize(triangles, region)));
    const std::vector<std::uint32_t> some = {3, surface_chunk_triangles + 4, 2 * surface_chunk_triangles + 5};
    EXPECT_TRUE(same_bits(voxelizer().voxelize(on_gpu, region, some),
                          voxelize({triangles[3], triangles[14], triangles[25]}, region)));
}

// ---- The world
// -----------------------------------------------------------------------------------------------------

/// Triangles with whole coordinates within +-100, some without area.
std::vector<glm::vec3> whole_corners() {
    Random random(65);
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 60; ++i)
        corners.emplace_back(random.point(-100, 100));
    corners.insert(corners.end(), {corners[0], corners[1], corners[1], corners[2], corners[2], corners[2]});
    return corners;
}

TEST_F(Traps, ScalesDownToDenormalNumbersGiveTheSameVoxels) {
    // Embree, used first, leaves threads behind that flush denormal numbers.
    const std::vector<LatticeTriangle> one = {{glm::i64vec3(0), glm::i64vec3(N), glm::i64vec3(0, N, 0)}};
    (void)reference::exact_voxels(lattice_surface(one, 16), {4, glm::ivec3(0), glm::ivec3(16)});
    const std::vector<glm::vec3> corners = whole_corners();
    const BitGrid expected = voxelize_around(triangles(corners), 50);
    EXPECT_GT(expected.count(), 1000U);
    for (const int exponent : {-149, -140, -126, -20, 20, 120}) {
        std::vector<glm::vec3> scaled = corners;
        for (glm::vec3& corner : scaled) {
            for (int axis = 0; axis < 3; ++axis)
                corner[axis] = std::ldexp(corner[axis], exponent);
        }
        EXPECT_TRUE(same_bits(voxelize_around(triangles(scaled), 50), expected)) << "times 2^" << exponent;
    }
}

TEST_F(Traps, DenormalTrianglesAmongLargeOnesArePoints) {
    const float least = std::ldexp(1.0F, -149);
    std::vector<glm::vec3> corners = whole_corners();
    const Grid grid = grid_over({{-128, -128, -128}, {128, 128, 128}}, 32);
    const BitGrid without = voxelize_scene(triangles(corners), grid);
    corners.insert(corners.end(), {glm::vec3(0), glm::vec3(least, 0, 0), glm::vec3(0, -least, least)});
    const BitGrid with = voxelize_scene(triangles(corners), grid);
    for (int corner = 0; corner < 8; ++corner) {
        // The origin is a corner of eight voxels.
        EXPECT_TRUE(with.at(16 - glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2))) << corner;
    }
    EXPECT_LE(with.count(), without.count() + 8);
}

TEST_F(Traps, FarFromTheOriginTheVoxelsAreTheSame) {
    const std::vector<glm::vec3> corners = whole_corners();
    const Grid grid = grid_over({{-128, -128, -128}, {128, 128, 128}}, 64);
    const BitGrid expected = voxelize_scene(triangles(corners), grid);
    EXPECT_GT(expected.count(), 1000U);
    for (const glm::dvec3& offset :
         {glm::dvec3(1e6, -1e6, 1e6), glm::dvec3(1e8, 1e8, -1e8), glm::dvec3(1e8, 3, 0.5)}) {
        scenes::Scene scene = triangles(corners);
        scene.nodes[0].trs.translation = offset;
        const Grid moved{grid.origin + offset, grid.voxel_size, grid.resolution};
        EXPECT_TRUE(same_bits(voxelize_scene(scene, moved), expected))
            << fmt::format("by {} {} {}", offset.x, offset.y, offset.z);
        // The default grid, with its own rounding.
        const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
        const Surface around = build_surface(scene, snapshot, grid_around(snapshot.bounds, 60));
        expect_exact(around, whole(around.grid),
                     fmt::format("around {} {} {}", offset.x, offset.y, offset.z));
    }
    // Coordinates that floats hold eight apart.
    std::vector<glm::vec3> coarse = corners;
    std::vector<glm::vec3> far_away = corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        coarse[i] = 8.0F * corners[i];
        far_away[i] = coarse[i] + 1e8F;
    }
    const Grid coarse_grid = grid_over({glm::dvec3(-1024), glm::dvec3(1024)}, 64);
    EXPECT_TRUE(
        same_bits(voxelize_scene(triangles(far_away),
                                 {coarse_grid.origin + 1e8, coarse_grid.voxel_size, coarse_grid.resolution}),
                  voxelize_scene(triangles(coarse), coarse_grid)));
}

TEST_F(Traps, NegativeAndUnevenScalesPlaceTheSameTriangles) {
    const std::vector<glm::vec3> corners = whole_corners();
    const Grid grid = grid_over({{-256, -256, -256}, {256, 256, 256}}, 64);
    for (const glm::vec3& scale : {glm::vec3(-1, 1, 1), glm::vec3(1, -2, 1), glm::vec3(-1, -1, 0.5F),
                                   glm::vec3(-2), glm::vec3(1, 0, 1), glm::vec3(0)}) {
        std::vector<glm::vec3> baked = corners;
        for (glm::vec3& corner : baked)
            corner *= scale;
        scenes::Scene scene = triangles(corners);
        scene.nodes[0].trs.scale = scale;
        EXPECT_TRUE(same_bits(voxelize_scene(scene, grid), voxelize_scene(triangles(baked), grid)))
            << fmt::format("scale {} {} {}", scale.x, scale.y, scale.z);
    }
}

// ---- One shape, written in every way that glTF has
// ------------------------------------------------------------------

/// A convex hexagon in the plane z = x + 2 y + 7. The union of its triangles does not depend on how it is
/// cut.
const std::vector<int> hexagon = {10, 5, 27, 30, 0, 37, 50, 10, 77, 44, 24, 99, 25, 35, 102, 6, 20, 53};
using Write = std::function<void(GltfFile&)>;

template <typename Number>
int add_corners(GltfFile& file, bool normalized = false) {
    // Elements begin at multiples of four bytes.
    constexpr std::size_t stride = (3 * sizeof(Number) + 3) / 4 * 4 / sizeof(Number);
    std::vector<Number> padded;
    for (std::size_t i = 0; i < hexagon.size(); i += 3) {
        for (std::size_t j = 0; j < stride; ++j)
            padded.push_back(Number(j < 3 ? hexagon[i + j] : 0));
    }
    if constexpr (!std::is_same_v<Number, float>)
        file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const int view = file.add_view(bytes_of(padded), int(stride * sizeof(Number)));
    Json accessor = {
        {"bufferView", view}, {"componentType", component_type<Number>()}, {"count", 6}, {"type", "VEC3"}};
    if (normalized) accessor["normalized"] = true;
    return file.add("accessors", accessor);
}

const std::vector<int> fan_indices = {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5};

template <typename Number>
Write as_list(const std::vector<int>& indices) {
    return [indices](GltfFile& file) {
        const int positions = add_corners<float>(file);
        const int accessor = file.add_accessor(std::vector<Number>(indices.begin(), indices.end()), "SCALAR");
        file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", accessor}});
    };
}

Write as_mode(int mode, const std::vector<std::uint16_t>& indices) {
    return [=](GltfFile& file) {
        const int positions = add_corners<float>(file);
        Json primitive = {{"attributes", {{"POSITION", positions}}}, {"mode", mode}};
        if (!indices.empty()) primitive["indices"] = file.add_accessor(indices, "SCALAR");
        file.add_mesh(primitive);
    };
}

template <typename Number>
void write_quantized(GltfFile& file) {
    file.add_mesh({{"attributes", {{"POSITION", add_corners<Number>(file)}}}, {"mode", 6}});
}

template <typename Number>
void write_normalized(GltfFile& file) {
    const int mesh = file.add(
        "meshes",
        {{"primitives",
          Json::array({{{"attributes", {{"POSITION", add_corners<Number>(file, true)}}}, {"mode", 6}}})}});
    file.add_root({{"mesh", mesh}, {"scale", std::vector<int>(3, std::numeric_limits<Number>::max())}});
}

void write_without_indices(GltfFile& file) {
    std::vector<float> corners;
    for (const int index : fan_indices) {
        for (int axis = 0; axis < 3; ++axis)
            corners.push_back(float(hexagon[std::size_t(3 * index + axis)]));
    }
    file.add_mesh({{"attributes", {{"POSITION", file.add_accessor(corners, "VEC3")}}}});
}

/// All corners but the first come from the sparse part; what it overwrites is zero, and not there.
void write_sparse(GltfFile& file, bool with_view) {
    std::vector<float> all(hexagon.begin(), hexagon.end());
    Json accessor = {{"componentType", 5126}, {"count", 6}, {"type", "VEC3"}};
    int first = 0;
    if (with_view) {
        first = 1;
        std::vector<float> wrong = all;
        std::fill(wrong.begin() + 3, wrong.end(), -1000.0F);
        accessor["bufferView"] = file.add_view(bytes_of(wrong));
    }
    std::vector<std::uint8_t> places;
    for (int i = first; i < 6; ++i)
        places.push_back(std::uint8_t(i));
    all.erase(all.begin(), all.begin() + 3 * first);
    accessor["sparse"] = {
        {"count", places.size()},
        {"indices", {{"bufferView", file.add_view(bytes_of(places))}, {"componentType", 5121}}},
        {"values", {{"bufferView", file.add_view(bytes_of(all))}}}};
    file.add_mesh({{"attributes", {{"POSITION", file.add("accessors", accessor)}}}, {"mode", 6}});
}

TEST_F(Traps, OneShapeInEveryEncodingGivesTheSameVoxels) {
    const std::vector<std::pair<const char*, Write>> ways = {
        {"no indices", write_without_indices},
        {"8-bit indices", as_list<std::uint8_t>(fan_indices)},
        {"16-bit indices", as_list<std::uint16_t>(fan_indices)},
        {"32-bit indices", as_list<std::uint32_t>(fan_indices)},
        {"other order", as_list<std::uint8_t>({2, 1, 0, 3, 2, 0, 4, 5, 3, 0, 5, 3})},
        {"duplicate indices",
         as_list<std::uint8_t>({0, 1, 2, 0, 0, 1, 0, 2, 3, 2, 2, 2, 0, 3, 4, 5, 4, 5, 0, 4, 5, 3, 0, 3})},
        {"fan without indices", as_mode(6, {})},
        {"fan", as_mode(6, {2, 3, 4, 5, 0, 1})},
        {"strip", as_mode(5, {0, 1, 5, 2, 4, 3})},
        {"strip with triangles of no area", as_mode(5, {0, 0, 1, 5, 2, 4, 3, 3, 3})},
        {"bytes", write_quantized<std::int8_t>},
        {"unsigned bytes", write_quantized<std::uint8_t>},
        {"shorts", write_quantized<std::int16_t>},
        {"unsigned shorts", write_quantized<std::uint16_t>},
        {"normalized bytes", write_normalized<std::int8_t>},
        {"normalized unsigned bytes", write_normalized<std::uint8_t>},
        {"normalized shorts", write_normalized<std::int16_t>},
        {"normalized unsigned shorts", write_normalized<std::uint16_t>},
        {"sparse", [](GltfFile& file) { write_sparse(file, true); }},
        {"sparse over nothing", [](GltfFile& file) { write_sparse(file, false); }},
    };
    // Lattice units are so coarse that what normalized numbers lose is rounded away.
    const Grid grid = grid_over({glm::dvec3(0), glm::dvec3(1024)}, 256);
    BitGrid expected;
    const ScratchFolder folder;
    for (const auto& [name, write] : ways) {
        GltfFile file;
        write(file);
        file.write_glb(folder.file("shape.glb"));
        const scenes::Scene scene = scenes::load(folder.file("shape.glb"));
        if (expected.words.empty()) {
            const Surface surface = build_surface(scene, scenes::take_snapshot(scene), grid);
            expected = reference::exact_voxels(surface, whole(grid));
            EXPECT_GT(expected.count(), 100U);
        }
        EXPECT_TRUE(same_bits(voxelize_scene(scene, grid), expected)) << name;
    }
}

}  // namespace
}  // namespace cairn::voxelizer
