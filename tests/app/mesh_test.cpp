// `cairn render` with meshes beside the voxels.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

/// Renders, and returns the bytes of the picture.
std::string picture_of(const ScratchFolder& folder, const std::vector<std::string>& options) {
    std::vector<std::string> run = {"render", "builtin:knot", "-o",     folder.file("picture.png"),
                                    "--size", "90x61",        "--quiet"};
    run.insert(run.end(), options.begin(), options.end());
    const Answer answer = cairn(run);
    EXPECT_EQ(answer.code, 0) << answer;
    return read_text(folder.file("picture.png"));
}

TEST(AppMesh, MeshesTheirShadowsAndProxiesChangeThePicture) {
    const ScratchFolder folder;
    const std::string voxels = picture_of(folder, {});
    const std::string mesh = picture_of(folder, {"--mesh", "builtin:spheres"});
    const std::string shadowed = picture_of(folder, {"--mesh", "builtin:spheres", "--mesh-shadows"});
    const std::string cut = picture_of(folder, {"--proxy", "builtin:spheres"});
    EXPECT_NE(mesh, voxels);
    EXPECT_NE(shadowed, mesh);
    EXPECT_NE(cut, voxels);
    EXPECT_NE(cut, mesh);
    EXPECT_EQ(picture_of(folder, {"--mesh", "builtin:spheres", "--shadow", "none", "--mesh-shadows"}),
              picture_of(folder, {"--mesh", "builtin:spheres", "--shadow", "none"}));
}

TEST(AppMesh, FiguresTellTrianglesAndRays) {
    const ScratchFolder folder;
    const std::vector<std::string> run = {"render", "builtin:knot", "--size",
                                          "90x61",  "-o",           folder.file("p.png")};
    const auto with = [&](std::vector<std::string> options) {
        options.insert(options.begin(), run.begin(), run.end());
        return cairn_json(options);
    };
    const int all = with({})["rays_launched"];
    EXPECT_LE(all, 90 * 61);
    const auto mixed = with({"--mesh", "builtin:spheres", "--proxy", "builtin:spheres"});
    EXPECT_EQ(mixed["mesh_triangles"], 6848);
    EXPECT_GT(mixed["rays_launched"], 90 * 61 / 20);
    EXPECT_LT(mixed["rays_launched"], all);
}

TEST(AppMesh, ShadowsWithoutAMeshAndMeshesThatAreNotThereAreRefused) {
    const ScratchFolder folder;
    const std::string output = folder.file("p.png");
    EXPECT_EQ(cairn({"render", "builtin:knot", "-o", output, "--mesh-shadows"}).code, 2);
    EXPECT_EQ(cairn({"render", "builtin:knot", "-o", output, "--mesh", "builtin:nothing"}).code, 2);
    EXPECT_EQ(cairn({"render", "builtin:knot", "-o", output, "--proxy", folder.file("no.glb")}).code, 3);
}

}  // namespace
}  // namespace cairn::test
