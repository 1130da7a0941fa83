// Every way to run the driver gives the same bits: contexts, numbers of threads, widths of vectors. llvmpipe
// reads its variables when it starts, so each run is a process of its own. Other drivers ignore the
// variables, and must agree with themselves.
#include <map>
#include <string>
#include <tuple>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

constexpr int no_context = 4;  // the command's exit code

struct Scene {
    const char* name;
    int resolution;
};

void PrintTo(const Scene& scene, std::ostream* out) {
    *out << scene.name;
}

using Environment = std::map<std::string, std::string>;

struct Voxels {
    Answer answer;
    std::string file;  ///< bytes of the .npy file
};

Voxels voxelize(const Scene& scene, const std::string& context, const Environment& environment) {
    const ScratchFolder folder;
    const std::string path = folder.file("voxels.npy");
    Voxels out;
    out.answer = cairn({"voxelize", fmt::format("builtin:{}", scene.name), "-r",
                        std::to_string(scene.resolution), "--context", context, "-o", path, "--json", "-"},
                       {.environment = environment});
    if (out.answer.code == 0) out.file = read_text(path);
    return out;
}

class EveryDriver : public ::testing::TestWithParam<std::tuple<Scene, const char*>> {
protected:
    void SetUp() override {
        // Any context, without variables.
        const Voxels voxels = voxelize(scene(), "auto", {});
        ASSERT_EQ(voxels.answer.code, 0) << voxels.answer;
        ASSERT_GT(voxels.answer.json()["occupied"], 1000) << voxels.answer;
        expected_ = voxels.file;
    }

    [[nodiscard]] static Scene scene() { return std::get<0>(GetParam()); }
    [[nodiscard]] static std::string context() { return std::get<1>(GetParam()); }

    /// @param says  part of llvmpipe's name in such a run
    void expect_same(const Environment& environment, const std::string& says = "") {
        const Voxels voxels = voxelize(scene(), context(), environment);
        std::string variables;
        for (const auto& [name, value] : environment)
            variables += fmt::format("{}={} ", name, value);
        if (voxels.answer.code == no_context) GTEST_SKIP() << "no such context here" << voxels.answer;
        ASSERT_EQ(voxels.answer.code, 0) << variables << voxels.answer;
        const nlohmann::json figures = voxels.answer.json();
        EXPECT_EQ(figures["backend"], context());
        const std::string driver = figures["driver"];
        if (driver.starts_with("llvmpipe")) {
            EXPECT_NE(driver.find(says), std::string::npos) << driver << " does not know " << variables;
        }
        // Not EXPECT_EQ, which would print both files.
        EXPECT_TRUE(voxels.file == expected_) << "other bits with " << variables << "on " << driver;
    }

private:
    std::string expected_;
};

TEST_P(EveryDriver, GivesTheSameBitsWithAnyNumberOfThreads) {
    for (const char* threads : {"0", "1", "2"})
        expect_same({{"LP_NUM_THREADS", threads}});
}

TEST_P(EveryDriver, GivesTheSameBitsWithVectorsOfAnyWidth) {
    for (const char* bits : {"128", "256", "512"})
        expect_same({{"LP_NATIVE_VECTOR_WIDTH", bits}, {"LP_NUM_THREADS", "2"}},
                    fmt::format("{} bits", bits));
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryDriver,
                         ::testing::Combine(::testing::Values(Scene{"knot", 100}, Scene{"needles", 128},
                                                              Scene{"spheres", 64}, Scene{"tree-leaves", 40}),
                                            ::testing::Values("osmesa", "egl")),
                         [](const auto& test) {
                             std::string name = std::get<0>(test.param).name;
                             std::erase(name, '-');
                             return fmt::format("{}_{}", name, std::get<1>(test.param));
                         });

}  // namespace
}  // namespace cairn::test
