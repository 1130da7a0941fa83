// Voxel files, read back by other readers (read_voxels.py).
#include <cstdlib>
#include <fstream>
#include <optional>

#include <fmt/format.h>
#include <fmt/os.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "scenes/snapshot.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/scratch_folder.h"
#include "voxelizer/files/voxel_tiles.h"
#include "voxelizer/files/voxel_writer.h"
#include "voxelizer/methods/conservative_voxelizer.h"
#include "voxelizer/methods/voxel_attributes.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;

struct Voxels {
    Grid grid;
    BitGrid bits;
    VoxelAttributes attributes;  ///< attributes of all voxels, or empty
};

/// Calls visit(tile) for each tile that holds voxels, in the writers' order.
template <typename Visit>
void for_each_tile(const Voxels& voxels, const Visit& visit) {
    const glm::ivec3& size = voxels.bits.size;
    std::vector<std::uint32_t> numbers(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z));
    const auto place = [&](const glm::ivec3& v) {
        return (std::size_t(v.z) * std::size_t(size.y) + std::size_t(v.y)) * std::size_t(size.x) +
               std::size_t(v.x);
    };
    for_each_voxel(voxels.bits, [&](const glm::ivec3& v, std::size_t number) {
        numbers[place(v)] = std::uint32_t(number);
    });
    for (int x = 0; x < size.x; x += VOXEL_TILE_SIDE) {
        for (int z = 0; z < size.z; z += VOXEL_TILE_SIDE) {
            for (int y = 0; y < size.y; y += VOXEL_TILE_SIDE) {
                VoxelTile tile{{x, y, z}, tile_bits(voxels.bits, {x, y, z}), {}};
                if (!voxels.attributes.colors.empty()) {
                    for_each_voxel(tile.bits, [&](const glm::ivec3& v, std::size_t) {
                        const std::uint32_t number = numbers[place(tile.origin + v)];
                        tile.attributes.colors.push_back(voxels.attributes.colors[number]);
                        tile.attributes.normals.push_back(voxels.attributes.normals[number]);
                    });
                }
                if (tile.bits.count() != 0) visit(tile);
            }
        }
    }
}

void write_expected(const Voxels& voxels, const std::string& path) {
    auto out = fmt::output_file(path);
    const glm::ivec3& r = voxels.grid.resolution;
    const glm::dvec3& o = voxels.grid.origin;
    out.print("{} {} {}\n{} {} {} {}\n", r.x, r.y, r.z, o.x, o.y, o.z, voxels.grid.voxel_size);
    for_each_voxel(voxels.bits, [&](const glm::ivec3& v, std::size_t number) {
        out.print("{} {} {}", v.x, v.y, v.z);
        if (!voxels.attributes.colors.empty()) {
            const glm::vec3& c = voxels.attributes.colors[number];
            const glm::vec3& n = voxels.attributes.normals[number];
            out.print(" {} {} {} {} {} {}", c.r, c.g, c.b, n.x, n.y, n.z);
        }
        out.print("\n");
    });
}

std::string write_file(const Voxels& voxels, const ScratchFolder& folder, const std::string& ending) {
    const std::string path = folder.file("voxels" + ending);
    const std::unique_ptr<VoxelWriter> writer = make_voxel_writer(path, voxels.grid);
    for_each_tile(voxels, [&](const VoxelTile& tile) { writer->add(tile); });
    writer->finish();
    EXPECT_EQ(folder.file_count(), std::size_t(std::filesystem::exists(folder.file("expected")) ? 2 : 1))
        << "something was left behind";
    return path;
}

/// Passes if another reader sees the voxels of "expected" in the folder.
void expect_reads(const std::string& path, const ScratchFolder& folder, double tolerance) {
    const std::string command = fmt::format("{} {} {} {} {} > {} 2>&1", CAIRN_TEST_PYTHON, CAIRN_READ_VOXELS,
                                            path, folder.file("expected"), tolerance, folder.file("answer"));
    const int code = WEXITSTATUS(std::system(command.c_str()));
    const std::string answer = read_text(folder.file("answer"));
    if (code == 77) GTEST_SKIP() << "no reader of " << path << ": " << answer;
    EXPECT_EQ(code, 0) << path << ": " << answer;
}

/// Passes if another reader sees the same voxels in the same places.
void expect_read_back(const Voxels& voxels, const std::string& ending, double tolerance) {
    const ScratchFolder folder;
    write_expected(voxels, folder.file("expected"));
    expect_reads(write_file(voxels, folder, ending), folder, tolerance);
}

/// Blobs, single voxels at the corners of the grid, and empty tiles between.
Voxels random_voxels(const glm::ivec3& resolution, std::uint32_t seed, bool with_attributes) {
    Random random(seed);
    Voxels voxels;
    voxels.grid = {{-12.75, 1000.125, 3.0e-3}, 0.37, resolution};
    voxels.bits = BitGrid(resolution);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 high(corner & 1, corner >> 1 & 1, corner >> 2);
        voxels.bits.set(high * (resolution - 1));
    }
    for (int blob = 0; blob < 12; ++blob) {
        const glm::ivec3 centre(random.between(0, resolution.x - 1), random.between(0, resolution.y - 1),
                                random.between(0, resolution.z - 1));
        const auto radius = int(random.between(1, 6));
        const glm::ivec3 low = glm::max(centre - radius, 0);
        const glm::ivec3 high = glm::min(centre + radius, resolution - 1);
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x)
                    if (random.between(0, 3) != 0) voxels.bits.set({x, y, z});
    }
    if (!with_attributes) return voxels;
    for (std::uint64_t left = voxels.bits.count(); left != 0; --left) {
        const auto unit = [&] { return float(random.unit()); };
        const float r = unit();
        const float g = unit();
        voxels.attributes.colors.emplace_back(r, g, unit());
        const float x = unit() - 0.5F;
        const float y = unit() - 0.5F;
        voxels.attributes.normals.push_back(glm::normalize(glm::vec3(x, y, unit() - 0.5F)));
    }
    return voxels;
}

class VoxelFiles : public ::testing::TestWithParam<std::string> {};

std::string name_of_ending(const ::testing::TestParamInfo<std::string>& info) {
    return info.param.substr(1);
}

TEST_P(VoxelFiles, BitsAndPlacesAreReadBack) {
    for (const glm::ivec3 resolution :
         {glm::ivec3(40, 70, 129), glm::ivec3(1), glm::ivec3(300, 33, 257), glm::ivec3(129, 260, 31)}) {
        SCOPED_TRACE(fmt::format("{} x {} x {}", resolution.x, resolution.y, resolution.z));
        expect_read_back(random_voxels(resolution, 5, false), GetParam(), 0.0);
    }
}

TEST_P(VoxelFiles, AGridWithoutVoxelsIsAFileToo) {
    Voxels voxels = random_voxels({20, 30, 40}, 6, false);
    voxels.bits = BitGrid(voxels.bits.size);
    expect_read_back(voxels, GetParam(), 0.0);
}

TEST_P(VoxelFiles, UnfinishedLeavesNothingBehind) {
    const ScratchFolder folder;
    const Voxels voxels = random_voxels({140, 20, 20}, 7, true);
    {
        const std::unique_ptr<VoxelWriter> writer =
            make_voxel_writer(folder.file("a" + GetParam()), voxels.grid);
        for_each_tile(voxels, [&](const VoxelTile& tile) { writer->add(tile); });
    }
    EXPECT_EQ(folder.file_count(), 0U);
}

TEST_P(VoxelFiles, TheSameVoxelsAreTheSameFile) {
    const Voxels voxels = random_voxels({140, 20, 20}, 8, true);
    const ScratchFolder one;
    const ScratchFolder two;
    EXPECT_EQ(read_text(write_file(voxels, one, GetParam())), read_text(write_file(voxels, two, GetParam())));
}

INSTANTIATE_TEST_SUITE_P(All, VoxelFiles, ::testing::ValuesIn(voxel_file_endings()), name_of_ending);

// The tree's upper nodes have 4096 voxels per side.
TEST(VdbWriter, ManyUpperNodesAreReadBack) {
    const Grid grid{{0.0, 0.0, -5.0}, 1.0 / 1024, {9000, 300, 8300}};
    const ScratchFolder folder;
    auto expected = fmt::output_file(folder.file("expected"));
    expected.print("9000 300 8300\n0 0 -5 {}\n", grid.voxel_size);
    const std::unique_ptr<VoxelWriter> writer = make_voxel_writer(folder.file("a.vdb"), grid);
    for (const int x : {0, 3968, 4096, 8192}) {
        for (const int z : {0, 4096, 8192}) {
            for (const int y : {128, 256}) {
                VoxelTile tile{{x, y, z}, BitGrid(glm::min(grid.resolution - glm::ivec3(x, y, z), 128)), {}};
                for (const glm::ivec3 v : {glm::ivec3(0), tile.bits.size - 1, glm::ivec3(x % 31, 9, 17)}) {
                    tile.bits.set(v);
                    expected.print("{} {} {}\n", x + v.x, y + v.y, z + v.z);
                }
                writer->add(tile);
            }
        }
    }
    writer->finish();
    expected.close();
    expect_reads(folder.file("a.vdb"), folder, 0.0);
}

// OpenVDB's tool lists the grids by their headers.
TEST(VdbWriter, ItsGridsAreListedByVdbPrint) {
    if (std::system("vdb_print -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "vdb_print is not installed";
    const Voxels voxels = random_voxels({40, 70, 129}, 13, true);
    const ScratchFolder folder;
    const std::string command =
        fmt::format("vdb_print -l {} > {} 2>&1", write_file(voxels, folder, ".vdb"), folder.file("answer"));
    const int code = WEXITSTATUS(std::system(command.c_str()));
    const std::string answer = read_text(folder.file("answer"));
    EXPECT_EQ(code, 0) << answer;
    for (const std::string word : {"Name: density", "Name: Cd", "Name: N", "fog volume", "40 x 70 x 129"})
        EXPECT_NE(answer.find(word), std::string::npos) << "no " << word << " in " << answer;
}

TEST(VoxWriter, GoxelSeesTheSameScene) {
    if (std::system("command -v goxel Xvfb > /dev/null 2>&1") != 0)
        GTEST_SKIP() << "goxel or Xvfb is not installed";
    Voxels voxels = random_voxels({300, 33, 257}, 14, true);
    for (glm::vec3& color : voxels.attributes.colors)
        color = glm::round(color * 4.0F) / 4.0F;
    const ScratchFolder folder;
    write_expected(voxels, folder.file("expected"));
    const std::string path = write_file(voxels, folder, ".vox");
    const std::string command = fmt::format("bash {} goxel -e {} {} > {} 2>&1", CAIRN_WITH_XVFB,
                                            folder.file("goxel.txt"), path, folder.file("answer"));
    const int code = WEXITSTATUS(std::system(command.c_str()));
    ASSERT_TRUE(code == 0 && std::filesystem::exists(folder.file("goxel.txt")))
        << read_text(folder.file("answer"));
    expect_reads(folder.file("goxel.txt"), folder, 0.5001);
}

TEST(VoxWriter, AGridPastTheEditorsRangeLiesAroundTheMiddleAndIsToldOf) {
    for (const int height : {1000, 1001, 2000, 2048}) {
        Voxels voxels;
        voxels.grid = {glm::dvec3(0.0), 1.0, glm::ivec3(3, height, 5)};
        voxels.bits = BitGrid(voxels.grid.resolution);
        for (const int y : {0, 23, 24, height / 2, 2023, 2024, height - 1})
            if (y < height) voxels.bits.set({1, y, 2});
        const ScratchFolder folder;
        write_expected(voxels, folder.file("expected"));
        const std::string path = folder.file("voxels.vox");
        const std::unique_ptr<VoxelWriter> writer = make_voxel_writer(path, voxels.grid);
        for_each_tile(voxels, [&](const VoxelTile& tile) { writer->add(tile); });
        writer->finish();
        expect_reads(path, folder, 0.0);
        // Of 2048 voxels around the middle, the lowest 24 and the highest 24 are outside.
        const std::string expected = height == 2048 ? "4 voxels lie outside of -1000 to 999" : "";
        EXPECT_EQ(writer->warning().find(expected) == std::string::npos, false) << writer->warning();
        EXPECT_EQ(writer->warning().empty(), height <= 2000) << writer->warning();
    }
}

TEST(VoxelColours, AreReadBackFromVdb) {
    expect_read_back(random_voxels({140, 50, 60}, 9, true), ".vdb", 1.0 / 2048);
}

TEST(VoxelColours, AreReadBackFromVoxExactlyWhereThePaletteHoldsThem) {
    Voxels voxels = random_voxels({140, 50, 60}, 10, true);
    Random random(10);
    std::vector<glm::vec3> few;
    for (int i = 0; i < 255; ++i) {
        const auto unit = [&] { return float(random.unit()); };
        const float r = unit();
        const float g = unit();
        few.emplace_back(r, g, unit());
    }
    for (glm::vec3& color : voxels.attributes.colors)
        color = few[std::size_t(random.between(0, 254))];
    expect_read_back(voxels, ".vox", 0.5001);
}

TEST(VoxelColours, OfMoreThanThePaletteHoldsAreReadBackFromVoxNearly) {
    // 255 colours in the whole sRGB cube: 40 apart along each axis where they are spread evenly.
    expect_read_back(random_voxels({140, 50, 60}, 11, true), ".vox", 60.0);
    // A ramp, as of a shaded surface, needs no more than one step.
    Voxels voxels = random_voxels({140, 50, 60}, 12, true);
    for (std::size_t i = 0; i < voxels.attributes.colors.size(); ++i) {
        const float t = float(i) / float(voxels.attributes.colors.size());
        voxels.attributes.colors[i] = {t, 0.5F * t, 1.0F - t};
    }
    expect_read_back(voxels, ".vox", 8.0);
}

TEST(VoxelFileNames, TellTheFormatOrWhichThereAre) {
    const ScratchFolder folder;
    EXPECT_NO_THROW((void)make_voxel_writer(folder.file("A.NPY"), unit_grid(4)));
    for (const std::string name : {"a", "a.obj", "npy"}) {
        try {
            (void)make_voxel_writer(folder.file(name), unit_grid(4));
            ADD_FAILURE() << name << " was taken";
        } catch (const Error& error) {
            EXPECT_EQ(error.fault(), Fault::usage);
            for (const std::string& ending : voxel_file_endings())
                EXPECT_NE(error.way_out().find(ending), std::string::npos) << error.way_out();
        }
    }
}

/// An L of boxes in three colours, like nothing under any turn or mirror.
scenes::Primitive box(const glm::vec3& low, const glm::vec3& high, const glm::u16vec4& color) {
    scenes::Primitive primitive;
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool top : {false, true}) {
            const auto first = std::uint32_t(primitive.positions.size());
            for (int corner = 0; corner < 4; ++corner) {
                glm::bvec3 at(false);
                at[axis] = top;
                at[(axis + 1) % 3] = (corner & 1) != 0;
                at[(axis + 2) % 3] = (corner & 2) != 0;
                primitive.positions.push_back(glm::mix(low, high, at));
                glm::vec3 normal(0.0F);
                normal[axis] = top ? 1.0F : -1.0F;
                primitive.normals.push_back(normal);
                primitive.colors.push_back(color);
            }
            for (const std::uint32_t i : {0U, 1U, 3U, 0U, 3U, 2U})
                primitive.indices.push_back(first + i);
        }
    }
    return primitive;
}

class VoxelFileScenes : public GlTest {};

TEST_F(VoxelFileScenes, AnAsymmetricSceneStandsWhereItIs) {
    const scenes::Scene scene;
    const std::vector<scenes::Primitive> boxes = {
        box({10.2F, -4.9F, 7.1F}, {11.7F, -4.2F, 13.2F}, {65535, 0, 0, 65535}),
        box({10.2F, -4.2F, 7.1F}, {10.7F, -1.8F, 7.9F}, {0, 128 * 257, 0, 65535}),
        box({11.2F, -4.2F, 12.5F}, {11.7F, -3.9F, 13.2F}, {0, 30 * 257, 65535, 65535})};
    scenes::Snapshot snapshot;
    for (const scenes::Primitive& primitive : boxes)
        snapshot.items.push_back({&primitive, primitive.positions, primitive.normals, glm::dmat4(1.0)});
    Voxels voxels;
    voxels.grid = {{10.0, -5.0, 7.0}, 0.05, {40, 70, 129}};
    const GpuSurface surface = upload(build_surface(scene, snapshot, voxels.grid, {.attributes = true}));
    voxels.bits = ConservativeVoxelizer().voxelize(surface, whole(voxels.grid));
    voxels.attributes = AttributeVoxelizer().gather(surface, whole(voxels.grid), voxels.bits);
    ASSERT_GT(voxels.bits.count(), 1000U);
    for (const std::string& ending : voxel_file_endings()) {
        SCOPED_TRACE(ending);
        expect_read_back(voxels, ending, ending == ".vox" ? 2.0 : 1.0 / 2048);
    }
}

}  // namespace
}  // namespace cairn::voxelizer
