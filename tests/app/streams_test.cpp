// The command with standard streams that are closed, or that cannot be written: its files and its exit code
// are those of a run with good ones.
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

/// A scene whose solid fill warns: the file would hold the warning if it had the number of a closed stderr.
Answer fill_tree(const std::string& file, const std::string& redirections) {
    return cairn({"voxelize", "builtin:tree", "-r", "32", "--fill", "solid", "-o", file},
                 {.redirections = redirections});
}

class ClosedStreams : public testing::TestWithParam<std::string> {};

TEST_P(ClosedStreams, LeaveTheFileAsItIs) {
    const ScratchFolder folder;
    const std::string good = folder.file("good" + GetParam());
    const Answer told = fill_tree(good, "");
    ASSERT_EQ(told.code, 0) << told;
    ASSERT_NE(told.err.find("warning"), std::string::npos) << "the test needs a scene that warns" << told;
    const std::string expected = read_text(good);
    for (const char* closed : {"2>&-", "<&- 2>&-", "<&-", "2>/dev/full"}) {
        const std::string file = folder.file("file" + GetParam());
        EXPECT_EQ(fill_tree(file, closed).code, 0) << closed;
        EXPECT_TRUE(read_text(file) == expected) << closed;
    }
    // The report has nowhere to go.
    const std::string file = folder.file("last" + GetParam());
    for (const char* closed : {">&-", "<&- >&- 2>&-", ">/dev/full"}) {
        EXPECT_EQ(fill_tree(file, closed).code, 2) << closed;
        EXPECT_TRUE(read_text(file) == expected) << closed;
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, ClosedStreams, testing::Values(".npy", ".binvox", ".vox", ".vdb"),
                         [](const auto& param) { return param.param.substr(1); });

TEST(AppStreams, AMessageThatCannotBeWrittenChangesNoExitCode) {
    for (const char* lost : {"2>&-", "2>/dev/full"}) {
        EXPECT_EQ(cairn({"info", "no-such-file.glb"}, {.redirections = lost}).code, 3) << lost;
        EXPECT_EQ(cairn({"render"}, {.redirections = lost}).code, 2) << lost;
        EXPECT_EQ(cairn({"voxelize", "builtin:knot", "-r", "16"}, {.redirections = lost}).code, 0) << lost;
    }
}

}  // namespace
}  // namespace cairn::test
