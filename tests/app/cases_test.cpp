// Files that once went wrong, each with what is right for it. Where the collection is not beside the scenes,
// only the twins that other tests make are tested.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/scratch_folder.h"

#ifdef CAIRN_SCENE_DATA
namespace cairn::test {
namespace {

const std::filesystem::path collection = std::filesystem::path(CAIRN_SCENE_DATA).parent_path() / "cases";

struct Case {
    const char* file;
    std::vector<std::string> arguments;  ///< before the file
    std::vector<int> codes;              ///< of which one is right
    int occupied = -1;                   ///< voxels; -1: the verb has none
    const char* told = "";               ///< a part of stderr; if empty, nothing need be told

    friend void PrintTo(const Case& a_case, std::ostream* out) {
        *out << a_case.file << " by " << fmt::format("{}", fmt::join(a_case.arguments, " "));
    }
};

class Cases : public testing::TestWithParam<Case> {};

TEST_P(Cases, EndRightly) {
    const std::filesystem::path file = collection / GetParam().file;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "the collection of cases is not beside the scenes";
    const ScratchFolder folder;
    std::vector<std::string> arguments = GetParam().arguments;
    const bool has_voxels = GetParam().occupied >= 0;
    arguments.push_back(file.string());
    if (has_voxels) arguments.insert(arguments.end(), {"--json", "-"});
    const Answer answer = cairn(arguments, {.folder = folder.path()});
    EXPECT_NE(std::ranges::find(GetParam().codes, answer.code), GetParam().codes.end()) << answer;
    if (has_voxels && answer.code == 0) {
        EXPECT_EQ(answer.json().value("occupied", -1), GetParam().occupied) << answer;
    }
    EXPECT_NE(answer.err.find(GetParam().told), std::string::npos) << answer;
    EXPECT_EQ(answer.code != 0, answer.err.starts_with("error: ")) << answer;
}

std::string name_of_case(const testing::TestParamInfo<Case>& info) {
    std::string name =
        fmt::format("{}_{}", info.index, std::filesystem::path(info.param.file).stem().string());
    std::ranges::replace_if(
        name, [](unsigned char letter) { return std::isalnum(letter) == 0; }, '_');
    return name;
}

std::vector<std::string> voxels_of_8(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"voxelize",    "-r",      "8",      "--bounds",
                                       "0,0,0,8,8,8", "--plain", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}
std::vector<std::string> voxels_of_16(const std::string& fill) {
    return {"voxelize", "-r", "16", "--bounds", "0,0,0,16,16,16", "--fill", fill};
}
const std::vector<std::string> small_voxels = {"voxelize", "-r", "16", "--quiet"};
const std::vector<std::string> small_picture = {"render", "--size", "16x12", "-o", "o.png", "--quiet"};
const std::vector<std::string> small_shadow = {"shadow", "--method", "embree", "--size", "16x12", "--quiet"};

INSTANTIATE_TEST_SUITE_P(
    Voxelize, Cases,
    testing::Values(
        Case{"voxelize/tex_missing_file.gltf", voxels_of_8(), {0}, 36, "lost.png"},
        Case{"voxelize/tex_missing_file.gltf", voxels_of_8({"--strict"}), {3}, -1, "lost.png"},
        Case{"voxelize/unusedlost.gltf", voxels_of_8({"--strict"}), {0}, 36},
        Case{"voxelize/tex_webp_as_source.gltf", voxels_of_8(), {0}, 36, "image 0"},
        Case{"voxelize/tex_basisu_required.gltf", voxels_of_8(), {0}, 36, "KTX2"},
        Case{"voxelize/uri_back.gltf", voxels_of_8(), {0}, 120},
        Case{"voxelize/vis_hidden.gltf", voxels_of_8(), {0}, 0},
        Case{"voxelize/vis_hidden_req.gltf", voxels_of_8(), {0}, 0},
        Case{"voxelize/anim_pointer.gltf", voxels_of_8({"--time", "1"}), {0}, 36},
        Case{"voxelize/mixtargets.gltf", voxels_of_8(), {0}, 72},
        Case{"voxelize/wnotarget.gltf", voxels_of_8(), {0}, 36},
        Case{"voxelize/anim_dup.gltf", voxels_of_8(), {0}, 36},
        Case{"voxelize/unusedbad.gltf", voxels_of_8(), {0}, 36},
        Case{"voxelize/skin_far.gltf",
             {"voxelize", "-r", "8", "--bounds=131072,0,0,131072.03125,0.03125,0.03125", "--quiet"},
             {0},
             120},
        Case{"voxelize/skin_far_static.gltf",
             {"voxelize", "-r", "8", "--bounds=131072,0,0,131072.03125,0.03125,0.03125", "--quiet"},
             {0},
             120},
        Case{"voxelize/vox_over_1000.gltf",
             {"voxelize", "-r", "2048", "--bounds", "0,0,0,2048,2048,2048", "--plain", "--quiet", "-o",
              "o.vox"},
             {0},
             -1,
             "-1000 to 999"},
        Case{"voxelize/b64pct.gltf", voxels_of_8(), {0}, 120},
        Case{"voxelize/solid_both_sides.gltf", voxels_of_16("outside"), {0}, 729},
        Case{"voxelize/solid_both_sides.gltf", voxels_of_16("solid"), {0}, 386, "343 voxels stayed empty"},
        Case{"voxelize/solid_overlap_one_flipped.gltf", voxels_of_16("outside"), {0}, 1239},
        Case{"voxelize/solid_overlap_one_flipped.gltf",
             voxels_of_16("solid"),
             {0},
             1179,
             "60 voxels stayed empty"}),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(
    Hostile, Cases,
    testing::Values(
        Case{"hostile/instances_bomb.glb", small_voxels, {5}, -1, "30000000000 triangles"},
        Case{"hostile/instances_bomb.glb", small_picture, {5}, -1, "--memory"},
        Case{"hostile/instances_bomb.glb", small_shadow, {5}, -1, "--memory"},
        Case{"hostile/morph_nodes_bomb.glb", small_voxels, {5}, -1, "posed copies"},
        Case{"hostile/morph_nodes_bomb.glb", small_picture, {5}, -1, "--memory"},
        Case{"hostile/mask_bomb.glb", small_voxels, {3}, -1, "--memory"},
        Case{"hostile/mask_bomb.glb", small_picture, {3}, -1, "--memory"},
        Case{"hostile/anisotropic_volume.mha", small_picture, {3}, -1, "resample it"},
        Case{"hostile/datafile_dot.mhd", small_picture, {3}, -1, "a folder"},
        Case{"hostile/datafile_folder.mhd", small_picture, {3}, -1, "data file"},
        Case{"hostile/multi_member.nii.gz", small_picture, {0}},
        Case{"hostile/uv_inf.glb", small_voxels, {0}}, Case{"hostile/uv_inf.glb", small_picture, {0}},
        Case{"hostile/uv_mirror.glb", small_voxels, {0}}, Case{"hostile/uv_mirror.glb", small_picture, {0}},
        Case{"hostile/uv_inf.glb", small_shadow, {0}}, Case{"hostile/uv_mirror.glb", small_shadow, {0}},
        Case{"hostile/embree_assert.glb", small_voxels, {0}},
        Case{"hostile/embree_assert.glb", small_picture, {2, 3}, -1, "coordinates up to"},
        Case{"hostile/embree_assert.glb", small_shadow, {2, 3}},
        Case{"hostile/far_1e17.glb", small_voxels, {0}},
        Case{"hostile/far_1e17.glb", small_picture, {2, 3}, -1, "coordinates up to"},
        Case{"hostile/far_1e17.glb", small_shadow, {2, 3}},
        Case{"hostile/far_1e17.glb",
             {"shadow", "--method", "voxel", "--compare", "embree", "--size", "16x12", "--quiet"},
             {2, 3}}),
    name_of_case);

}  // namespace
}  // namespace cairn::test
#endif
