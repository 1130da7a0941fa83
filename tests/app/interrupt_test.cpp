// Verbs that are interrupted or killed while they work.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

using Arguments = std::vector<std::string>;

/// A run of the command, whose stderr is a file. It is killed with the object if it still works then.
class StartedCommand {
public:
    explicit StartedCommand(Arguments arguments) {
        arguments.insert(arguments.begin(), CAIRN_COMMAND);
        std::vector<char*> argv;
        for (std::string& argument : arguments)
            argv.push_back(argument.data());
        argv.push_back(nullptr);
        child_ = fork();
        if (child_ != 0) return;
        const int err = open(streams_.file("err").c_str(), O_WRONLY | O_CREAT, 0600);
        const int out = open(streams_.file("out").c_str(), O_WRONLY | O_CREAT, 0600);
        dup2(err, STDERR_FILENO);
        dup2(out, STDOUT_FILENO);
        execv(CAIRN_COMMAND, argv.data());
        _exit(127);
    }
    StartedCommand(const StartedCommand&) = delete;
    StartedCommand& operator=(const StartedCommand&) = delete;
    StartedCommand(StartedCommand&&) = delete;
    StartedCommand& operator=(StartedCommand&&) = delete;
    ~StartedCommand() {
        if (child_ <= 0) return;
        kill(child_, SIGKILL);
        waitpid(child_, nullptr, 0);
    }

    /// Waits until an output in the folder is open, also one that has no name yet.
    [[nodiscard]] bool waits_for_output(const std::filesystem::path& folder) const {
        // The command checks first that it can write. Wait for a file that stays.
        int seen = 0;
        for (int turn = 0; turn < 3000 && seen < 3; ++turn) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            seen = has_open(folder) ? seen + 1 : 0;
        }
        return seen == 3;
    }

    /// Waits until the run has worked for so many seconds of processor time.
    [[nodiscard]] bool waits_for_work(double seconds) const {
        for (int turn = 0; turn < 3000; ++turn) {
            if (cpu_seconds() >= seconds) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }

    /// Sends a signal, and waits for the end. @return the exit code, or minus the signal that ended it.
    int end_by(int signal) {
        kill(child_, signal);
        int status = 0;
        waitpid(child_, &status, 0);
        child_ = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }

    [[nodiscard]] std::string err() const { return read_text(streams_.file("err")); }

private:
    [[nodiscard]] std::filesystem::path proc() const {
        return std::filesystem::path("/proc") / std::to_string(child_);
    }

    [[nodiscard]] bool has_open(const std::filesystem::path& folder) const {
        std::error_code over;
        for (std::filesystem::directory_iterator entry(proc() / "fd", over), end; !over && entry != end;
             entry.increment(over)) {
            std::error_code closed;
            const std::string target = std::filesystem::read_symlink(entry->path(), closed).string();
            if (!closed && target.starts_with(folder.string() + "/")) return true;
        }
        return false;
    }

    [[nodiscard]] double cpu_seconds() const {
        std::ifstream file(proc() / "stat");
        std::string text(std::istreambuf_iterator<char>(file), {});
        const std::size_t name_end = text.rfind(')');
        if (name_end == std::string::npos) return 0.0;
        std::istringstream fields(text.substr(name_end + 2));
        std::string field;
        double ticks = 0.0;
        for (int number = 3; fields >> field && number <= 15; ++number)
            if (number >= 14) ticks += std::stod(field);  // utime and stime
        return ticks / double(sysconf(_SC_CLK_TCK));
    }

    ScratchFolder streams_;
    pid_t child_ = 0;
};

/// A verb with work for far longer than anybody waits.
struct Long {
    const char* name;
    Arguments arguments;
};
void PrintTo(const Long& verb, std::ostream* out) {
    *out << verb.name;
}

const Long long_verbs[] = {
    {"Voxelize", {"voxelize", "builtin:tree", "-r", "4096", "-o", "OUT.npy"}},
    {"VoxelizeLargeTiles", {"voxelize", "builtin:needles", "-r", "8192", "-o", "OUT.vdb"}},
    {"Check", {"check", "builtin:tree", "-r", "4096"}},
    {"Render",
     {"render", "builtin:tree", "--size", "8000x8000", "--shadow", "soft", "--light", "3,5,4,1",
      "--pixel-error", "0.1", "-o", "OUT.png"}},
    {"Shadow",
     {"shadow", "builtin:tree", "--method", "voxel", "--light", "3,5,4,1", "--size", "4000x4000", "--rays",
      "256", "-o", "OUT.png"}},
    {"Embree", {"shadow", "builtin:tree", "--method", "embree", "--size", "8000x8000", "-o", "OUT.png"}},
#ifdef CAIRN_BENCH
    {"Bench", {"bench", "levels", "-o", "OUT", "--quiet"}},
#endif
};

class Interrupted : public testing::TestWithParam<Long> {};

TEST_P(Interrupted, EveryVerbEndsSoonAndLeavesNothing) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const ScratchFolder folder;
        Arguments arguments = GetParam().arguments;
        for (std::string& argument : arguments)
            if (argument.starts_with("OUT")) argument = folder.file(argument);
        StartedCommand run(arguments);
        ASSERT_TRUE(run.waits_for_work(1.0));
        EXPECT_EQ(run.end_by(signal), 130) << run.err();
        EXPECT_EQ(run.err(), "error: interrupted; nothing was left half written\n");
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
            EXPECT_TRUE(entry.is_directory()) << entry.path();
    }
}

INSTANTIATE_TEST_SUITE_P(Verbs, Interrupted, testing::ValuesIn(long_verbs),
                         [](const auto& verb) { return std::string(verb.param.name); });

TEST(AppInterrupt, WhileItWritesLeavesNoFile) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const ScratchFolder folder;
        StartedCommand run({"voxelize", "builtin:tree", "-r", "1024", "-o", folder.file("a.npy")});
        ASSERT_TRUE(run.waits_for_output(folder.path()));
        EXPECT_EQ(run.end_by(signal), 130) << run.err();
        EXPECT_EQ(run.err(), "error: interrupted; nothing was left half written\n");
        EXPECT_EQ(folder.file_count(), 0U);
    }
}

TEST(OutputFiles, LeaveNothingWhereTheProcessIsKilled) {
    const ScratchFolder folder;
    write_text(folder.path() / "a.npy", "old");
    StartedCommand run({"voxelize", "builtin:tree", "-r", "2048", "-o", folder.file("a.npy")});
    ASSERT_TRUE(run.waits_for_output(folder.path()));
    EXPECT_EQ(run.end_by(SIGKILL), -SIGKILL);
    EXPECT_EQ(folder.file_count(), 1U);
    EXPECT_EQ(read_text(folder.file("a.npy")), "old");
}

TEST(AppInterrupt, ASignalThatTheParentIgnoresStaysIgnored) {
    const ScratchFolder folder;
    const auto before = std::signal(SIGHUP, SIG_IGN);
    StartedCommand run({"voxelize", "builtin:tree", "-r", "512", "-o", folder.file("a.npy")});
    std::signal(SIGHUP, before);
    ASSERT_TRUE(run.waits_for_output(folder.path()));
    EXPECT_EQ(run.end_by(SIGHUP), 0) << run.err();
    EXPECT_EQ(folder.file_count(), 1U);
}

}  // namespace
}  // namespace cairn::test
