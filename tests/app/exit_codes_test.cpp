// Every verb that writes, in every format, where its output cannot be written; and with little memory.
#include <algorithm>
#include <filesystem>
#include <future>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/command.h"
#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

/// A command that writes a file of more than 4 KiB, which is more than "ulimit -f 4" lets through, whose name
/// follows.
struct Writer {
    const char* ending;
    std::vector<std::string> arguments;

    [[nodiscard]] std::vector<std::string> to(const std::string& file) const {
        std::vector<std::string> all = arguments;
        all.push_back(file);
        return all;
    }
    friend void PrintTo(const Writer& writer, std::ostream* out) {
        *out << writer.arguments[0] << writer.ending;
    }
};

class EveryWriter : public testing::TestWithParam<Writer> {
protected:
    ScratchFolder folder_;
    std::string file_ = folder_.file(std::string("out") + GetParam().ending);

    [[nodiscard]] Answer write(const std::string& file, const std::string& limits = {}) const {
        return cairn(GetParam().to(file), {.folder = folder_.path(), .limits = limits});
    }
    static void expect_told(const Answer& answer, int code) {
        EXPECT_EQ(answer.code, code) << answer;
        EXPECT_NE(answer.err.find("error: "), std::string::npos) << answer;
    }
};

TEST_P(EveryWriter, WhereAFileMayNotGrowEndsWithCodeFiveAndLeavesNothing) {
    const Answer answer = write(file_, "ulimit -f 4");
    expect_told(answer, 5);
    EXPECT_EQ(folder_.file_count(), 0U) << answer;
    write_text(file_, "from before");
    expect_told(write(file_, "ulimit -f 4"), 5);
    EXPECT_EQ(read_text(file_), "from before");
    EXPECT_EQ(folder_.file_count(), 1U);
}

TEST_P(EveryWriter, OnAFullDeviceEndsWithCodeFive) {
    std::filesystem::create_symlink("/dev/full", file_);
    expect_told(write(file_), 5);
}

TEST_P(EveryWriter, WhereNothingCanBeWrittenEndsWithCodeTwoBeforeTheWork) {
    for (const std::string& file :
         {std::string("/proc/out") + GetParam().ending, folder_.file("no/such/out") + GetParam().ending}) {
        const Answer answer = write(file);
        expect_told(answer, 2);
        EXPECT_NE(answer.err.find(file), std::string::npos) << answer;
    }
    // The output is looked at before the scene, which is not there.
    std::vector<std::string> arguments = GetParam().to("/proc/out" + std::string(GetParam().ending));
    arguments[1] = "no-such-scene.glb";
    expect_told(cairn(arguments), 2);
    std::filesystem::create_directory(file_);
    expect_told(write(file_), 2);
    EXPECT_TRUE(std::filesystem::is_empty(file_));
}

TEST_P(EveryWriter, WritesAPipeAsItWritesAFile) {
    const Answer answer = write(file_);
    ASSERT_EQ(answer.code, 0) << answer;
    const std::string expected = read_text(file_);
    EXPECT_GT(expected.size(), 4096U) << "too small for the other tests";
    const std::string pipe = folder_.file(std::string("pipe") + GetParam().ending);
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::future<std::string> read = std::async(std::launch::async, [&] { return read_text(pipe); });
    const Answer piped = write(pipe);
    if (piped.code != 0) std::ofstream(pipe, std::ios::app).close();  // lets the reader go
    EXPECT_EQ(piped.code, 0) << piped;
    EXPECT_TRUE(read.get() == expected);
    EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST_P(EveryWriter, WritesToNowhere) {
    std::filesystem::create_symlink("/dev/null", file_);
    const Answer answer = write(file_);
    EXPECT_EQ(answer.code, 0) << answer;
}

std::vector<std::string> voxelize(const std::string& last) {
    return {"voxelize", "builtin:knot", "-r", "64", "--quiet", last};
}

INSTANTIATE_TEST_SUITE_P(
    Formats, EveryWriter,
    testing::Values(
        Writer{".npy", voxelize("-o")}, Writer{".vdb", voxelize("-o")}, Writer{".vox", voxelize("-o")},
        Writer{".binvox", voxelize("-o")},
        Writer{".npy",
               {"voxelize", "builtin:cornell", "-r", "64", "--fill", "solid", "--quiet", "--doubtful"}},
        Writer{".png",
               {"render", "builtin:cornell", "--size", "160x120", "--max-resolution", "64", "--quiet", "-o"}},
        Writer{".png",
               {"shadow", "builtin:knot", "--size", "160x120", "--method", "embree", "--quiet", "-o"}},
        Writer{".glb", {"export", "builtin:knot", "--quiet", "-o"}}),
    [](const auto& param) {
        return fmt::format("{}_{}_{}", param.index, param.param.arguments[0], param.param.ending + 1);
    });

TEST(ExitCodes, OfReportsThatCannotBeWritten) {
    const std::vector<std::vector<std::string>> verbs = {
        {"info", "builtin:knot"},
        {"check", "builtin:cornell", "-r", "16"},
        {"voxelize", "builtin:cornell", "-r", "16"},
        {"export", "builtin:cornell", "-o", "out.glb"},
        {"render", "builtin:cornell", "--size", "16x12", "--max-resolution", "32", "-o", "out.png"},
        {"shadow", "builtin:cornell", "--method", "embree", "--size", "16x12"}};
    for (const std::vector<std::string>& verb : verbs) {
        for (const auto& [report, code] : {std::pair{"/dev/full", 5}, {"/proc/report.json", 2}}) {
            const ScratchFolder folder;
            std::vector<std::string> arguments = verb;
            arguments.insert(arguments.end(), {"--quiet", "--json", report});
            const Answer answer = cairn(arguments, {.folder = folder.path()});
            EXPECT_EQ(answer.code, code) << verb[0] << " to " << report << answer;
            EXPECT_NE(answer.err.find("error: "), std::string::npos) << verb[0] << answer;
        }
    }
}

/// Whether a run with little memory ended as it may: done, or out of memory with a message. Mesa's compiler
/// ends the process by a signal if it gets no memory; nobody can answer for that.
testing::AssertionResult ended_well(const Answer& answer, bool has_driver) {
    const bool by_signal = answer.code == -1 || answer.code >= 128;
    if (answer.code == 0 || (has_driver && by_signal)) return testing::AssertionSuccess();
    if (answer.code == 5 && answer.err.find("error: ") != std::string::npos)
        return testing::AssertionSuccess();
    return testing::AssertionFailure() << answer;
}

TEST(ExitCodes, WithLittleMemoryAreFiveAndFilesAreWholeOrNotThere) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer needs more address space than this test leaves";
#endif
    const std::vector<std::vector<std::string>> verbs = {
        {"info", "builtin:knot"},
        {"check", "builtin:cornell", "-r", "16"},
        {"voxelize", "builtin:knot", "-r", "64", "-o", "out.npy"},
        {"voxelize", "builtin:knot", "-r", "64", "--fill", "solid", "-o", "out.vdb"},
        {"render", "builtin:cornell", "--size", "64x48", "--max-resolution", "64", "-o", "out.png"},
        {"shadow", "builtin:cornell", "--method", "embree", "--size", "16x12", "-o", "out.png"},
        {"shadow", "builtin:cornell", "--method", "voxel", "--size", "16x12", "-o", "out.png"},
        {"export", "builtin:knot", "-o", "out.glb"}};
    for (const std::vector<std::string>& verb : verbs) {
        std::size_t whole_size = 0;
        for (const int mib : {6144, 1024, 768, 512, 384, 256}) {
            const ScratchFolder folder;
            std::vector<std::string> arguments = verb;
            arguments.emplace_back("--quiet");
            const Answer answer = cairn(
                arguments,
                {.folder = folder.path(), .limits = fmt::format("ulimit -c 0 && ulimit -v {}", mib * 1024)});
            const bool has_driver =
                verb[0] != "info" && verb[0] != "export" && std::ranges::find(verb, "embree") == verb.end();
            EXPECT_TRUE(ended_well(answer, has_driver)) << verb[0] << " in " << mib << " MiB";
            const bool writes = verb[verb.size() - 2] == "-o";
            EXPECT_EQ(folder.file_count(), writes && answer.code == 0 ? 1U : 0U) << verb[0] << " in " << mib;
            if (!writes || answer.code != 0) continue;
            const std::size_t size = std::filesystem::file_size(folder.file(verb.back()));
            if (whole_size == 0) whole_size = size;
            EXPECT_EQ(size, whole_size) << verb[0] << " in " << mib << " MiB";
        }
        EXPECT_TRUE(verb[verb.size() - 2] != "-o" || whole_size > 0) << verb[0] << " did nothing in 6 GiB";
    }
}

#ifdef CAIRN_BENCH
TEST(ExitCodes, OfChartsAreThoseOfTheCommand) {
    const std::vector<std::string> chart = {
        "bench", "voxelize", "--scene", "builtin:cornell", "--resolutions", "8", "--runs", "1", "--quiet"};
    const auto run = [&](const std::vector<std::string>& more) {
        const ScratchFolder folder;
        std::vector<std::string> arguments = chart;
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Answer answer = cairn(arguments, {.folder = folder.path()});
        EXPECT_EQ(answer.code != 0, answer.err.starts_with("error: ")) << answer;
        return answer.code;
    };
    EXPECT_EQ(run({}), 0);
    EXPECT_EQ(run({"-o", "/proc"}), 2);
    EXPECT_EQ(run({"--json", "/dev/full"}), 5);
    EXPECT_EQ(run({"--scene", "no-such-scene.glb"}), 3);
    EXPECT_EQ(run({"--no-such-option"}), 2);
    EXPECT_EQ(cairn({"bench", "--", "no-such-chart"}).code, 2);
    EXPECT_EQ(cairn({"bench", "--help"}).code, 0);
}
#endif

TEST(ExitCodes, OfBoundsTooSmallForTheScene) {
    for (const char* verb : {"voxelize", "check"}) {
        const Answer answer =
            cairn({verb, "builtin:cornell", "-r", "16", "--bounds", "0,0,0,1e-9,1e-9,1e-9"});
        EXPECT_EQ(answer.code, 2) << answer;
        EXPECT_NE(answer.err.find("--bounds"), std::string::npos) << answer;
    }
}

}  // namespace
}  // namespace cairn::test
