// Outputs appear whole or not at all, whatever happens to their process.
#include "base/output_file.h"

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

/// Outputs with and without a name meanwhile: file systems differ, and what is seen of them does not.
class Outputs : public testing::TestWithParam<bool> {
protected:
    [[nodiscard]] std::unique_ptr<OutputFile> begin(const std::string& name,
                                                    const std::string& text = "new") const {
        auto file = std::make_unique<OutputFile>(folder_.path() / name, GetParam());
        file->write(text.data(), text.size());
        return file;
    }
    void finish(const std::string& name, const std::string& text = "new") const {
        begin(name, text)->commit();
    }
    [[nodiscard]] std::string text_of(const std::string& name) const { return read_text(folder_.file(name)); }
    [[nodiscard]] mode_t mode_of(const std::string& name) const {
        struct stat status {};
        EXPECT_EQ(stat(folder_.file(name).c_str(), &status), 0);
        return status.st_mode & 07777U;
    }
    /// Begins an output in a process of its own, and kills it.
    void begin_and_be_killed(const std::string& name) const {
        const pid_t child = fork();
        if (child == 0) {
            const auto file = begin(name, std::string(3U << 20U, 'x'));
            raise(SIGKILL);
        }
        int status = 0;
        waitpid(child, &status, 0);
        ASSERT_TRUE(WIFSIGNALED(status));
    }

    ScratchFolder folder_;
};

TEST_P(Outputs, AppearWhenTheyAreWhole) {
    const auto file = begin("a");
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "a"));
    EXPECT_EQ(folder_.file_count(), GetParam() ? 0U : 1U);
    file->commit();
    EXPECT_EQ(text_of("a"), "new");
    EXPECT_EQ(folder_.file_count(), 1U);
}

TEST_P(Outputs, WithoutCommitLeaveWhatWasThere) {
    write_text(folder_.path() / "a", "old");
    { const auto file = begin("a"); }
    { const auto other = begin("b"); }
    EXPECT_EQ(text_of("a"), "old");
    EXPECT_EQ(folder_.file_count(), 1U);
}

TEST_P(Outputs, KeepTheModeOfTheFileThatTheyReplace) {
    for (const mode_t mode : {0600U, 0640U, 0755U}) {
        write_text(folder_.path() / "a", "old");
        ASSERT_EQ(chmod(folder_.file("a").c_str(), mode), 0);
        finish("a");
        EXPECT_EQ(mode_of("a"), mode);
        EXPECT_EQ(text_of("a"), "new");
    }
    const mode_t mask = umask(027);
    finish("b");
    umask(mask);
    EXPECT_EQ(mode_of("b"), 0640U);
}

TEST_P(Outputs, DoNotReplaceWhatMayNotBeWritten) {
    write_text(folder_.path() / "a", "old");
    ASSERT_EQ(chmod(folder_.file("a").c_str(), 0444), 0);
    ASSERT_EQ(chmod(folder_.path().c_str(), 0777), 0);
    const pid_t child = fork();
    if (child == 0) {
        constexpr uid_t nobody = 65534;
        if (geteuid() == 0 && setuid(nobody) != 0) _exit(3);  // root may write everything
        try {
            finish("a");
        } catch (const Error& error) {
            _exit(error.fault() == Fault::usage ? 0 : 2);
        }
        _exit(1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    EXPECT_EQ(text_of("a"), "old");
}

TEST_P(Outputs, MayHaveNamesAsLongAsTheSystemAllows) {
    const std::string longest(255, 'n');
    finish(longest);
    EXPECT_EQ(text_of(longest), "new");
    try {
        (void)begin(longest + "n");
        ADD_FAILURE() << "a name that is too long shows only when all work is done";
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::usage) << error.what();
    }
}

TEST_P(Outputs, OfAKilledProcessAreGoneAfterTheNextRun) {
    write_text(folder_.path() / "b", "another file");
    begin_and_be_killed("a");
    EXPECT_EQ(folder_.file_count(), GetParam() ? 1U : 2U);
    finish("a");
    EXPECT_EQ(text_of("a"), "new");
    EXPECT_EQ(text_of("b"), "another file");
    EXPECT_EQ(folder_.file_count(), 2U);
}

TEST_P(Outputs, OfALivingProcessAreLeftAlone) {
    const auto slow = begin("a", "slow");
    finish("a", "quick");
    EXPECT_EQ(text_of("a"), "quick");
    slow->commit();
    EXPECT_EQ(text_of("a"), "slow");
    EXPECT_EQ(folder_.file_count(), 1U);
}

TEST_P(Outputs, ThroughALinkReplaceTheFileThatItNames) {
    write_text(folder_.path() / "sub/target", "old");
    std::filesystem::create_symlink("sub/target", folder_.path() / "link");
    std::filesystem::create_symlink("sub/later", folder_.path() / "dangling");
    finish("link");
    finish("dangling");
    EXPECT_TRUE(std::filesystem::is_symlink(folder_.path() / "link"));
    EXPECT_EQ(text_of("sub/target"), "new");
    EXPECT_EQ(text_of("sub/later"), "new");
    std::filesystem::create_symlink("loop", folder_.path() / "loop");
    EXPECT_THROW((void)begin("loop"), Error);
}

TEST_P(Outputs, ThatCannotBeWrittenAreRefusedAtOnce) {
    for (const char* name : {"no/such/folder", "", "sub/"}) {
        std::filesystem::create_directory(folder_.path() / "sub");
        EXPECT_THROW((void)OutputFile(folder_.path() / name, GetParam()), Error) << name;
    }
    EXPECT_EQ(folder_.file_count(), 1U);
}

TEST_P(Outputs, OnAFullDiskSayNoMemoryAndLeaveNothing) {
    // A limit of the size of files is the disk that a test can fill.
    const pid_t child = fork();
    if (child == 0) {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{1U << 20U, 1U << 20U};
        setrlimit(RLIMIT_FSIZE, &limit);
        try {
            finish("a", std::string(3U << 20U, 'x'));
        } catch (const Error& error) {
            _exit(error.fault() == Fault::memory ? 0 : 2);
        }
        _exit(1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    EXPECT_EQ(folder_.file_count(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Meanwhile, Outputs, testing::Bool(),
                         [](const auto& nameless) { return nameless.param ? "Nameless" : "Named"; });

std::string numbered_bytes(std::size_t count) {
    std::string bytes;
    for (std::size_t i = 0; i < count; ++i)
        bytes += char(1 + i % 200);
    return bytes;
}

TEST(OutputFileZeros, AreZerosInAFileAndInAPipe) {
    const ScratchFolder folder;
    const std::string data = numbered_bytes(1000);
    std::string expected;
    const auto write = [&](OutputFile& file) {
        expected.clear();
        for (const std::size_t zeros :
             {std::size_t(0), std::size_t(7), std::size_t(65535), std::size_t(300000)}) {
            file.write(data.data(), data.size());
            file.write_zeros(zeros / 2);
            file.write_zeros(zeros - zeros / 2);
            expected += data + std::string(zeros, '\0');
        }
        file.commit();
    };
    OutputFile file(folder.file("a"));
    write(file);
    EXPECT_TRUE(read_text(folder.file("a")) == expected);

    ASSERT_EQ(std::system(("mkfifo " + folder.file("pipe")).c_str()), 0);
    ASSERT_EQ(std::system(fmt::format("cat {} > {} &", folder.file("pipe"), folder.file("b")).c_str()), 0);
    OutputFile pipe(folder.file("pipe"));
    write(pipe);
    for (int i = 0; i < 100 && read_text(folder.file("b")).size() < expected.size(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_TRUE(read_text(folder.file("b")) == expected);
}

}  // namespace
}  // namespace cairn::test
