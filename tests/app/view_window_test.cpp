// `cairn view` on a display, with real keys and a real mouse (xdotool); tests/support/with_xvfb.sh provides
// the display.

#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

/// Runs `cairn view` beside the test, in a folder of its own.
class Session {
public:
    explicit Session(const std::string& options) {
        // The shell writes its process number to a file, and then becomes the program.
        shell(
            fmt::format("cd '{}' && (CAIRN_GL_DEBUG=1 sh -c 'echo $$ >pid; \"{}\" view {} --log --json "
                        "report.json >out 2>log; echo $? >code' &) ",
                        folder_.path().string(), CAIRN_COMMAND, options));
    }
    ~Session() {
        if (!std::filesystem::exists(folder_.file("code"))) {
            shell(fmt::format("pkill -P $(cat '{}')", folder_.file("pid")));
        }
    }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;
    Session(Session&&) = delete;
    Session& operator=(Session&&) = delete;

    static int shell(const std::string& line) { return std::system(line.c_str()); }
    static void xdotool(const std::string& what) {
        EXPECT_EQ(shell("xdotool " + what + " >/dev/null"), 0) << what;
    }
    [[nodiscard]] std::string text(const char* name) const {
        return std::filesystem::exists(folder_.file(name)) ? read_text(folder_.file(name)) : std::string();
    }
    [[nodiscard]] int count(const std::string& what) const {
        const std::string log = text("log");
        int found = 0;
        for (std::size_t at = log.find(what); at != std::string::npos; at = log.find(what, at + 1))
            ++found;
        return found;
    }
    /// Waits until `what` is in the log `times` times.
    [[nodiscard]] bool wait(const std::string& what, int times) const {
        return wait_for([&] { return count(what) >= times; });
    }
    [[nodiscard]] bool wait_for_end() const {
        return wait_for([&] { return !text("code").empty(); });
    }
    [[nodiscard]] const ScratchFolder& folder() const { return folder_; }

private:
    template <typename Condition>
    static bool wait_for(Condition condition) {
        for (int i = 0; i < 600; ++i) {
            if (condition()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        return false;
    }
    ScratchFolder folder_;
};

TEST(View, AnswersKeysAndMouseAndItsPictureCanBeMadeAgain) {
    const Session session("builtin:cornell --size 320x240");
    ASSERT_TRUE(session.wait("converged 320x240", 1)) << session.text("log");
    Session::xdotool("mousemove 160 120 key F1");
    Session::xdotool("mousedown 1 mousemove_relative 30 10 mousemove_relative 30 5 mouseup 1");
    ASSERT_TRUE(session.wait("converged 320x240", 2)) << "dragging changed nothing";
    int converged = 2;
    for (const char* input : {"click 4", "key l", "key l", "key l", "key h", "key bracketright"}) {
        Session::xdotool(input);
        ASSERT_TRUE(session.wait("converged 320x240", ++converged)) << input << " changed nothing";
    }
    Session::xdotool("key p");
    ASSERT_TRUE(session.wait("picture cairn-1.png", 1)) << session.text("log");

    Session::xdotool("key f keydown w sleep 0.3 keyup w");
    ASSERT_TRUE(session.wait("converged 320x240", ++converged)) << "flying changed nothing";
    Session::xdotool("search --name 'cairn view' windowsize 200 160");
    ASSERT_TRUE(session.wait("converged 200x160", 1)) << "the new size was not seen";
    Session::xdotool("key Escape");
    ASSERT_TRUE(session.wait_for_end());
    EXPECT_EQ(session.text("code"), "0\n") << session.text("log");

    const auto report = nlohmann::json::parse(session.text("report.json"));
    EXPECT_GT(report["moving_frames"], 8) << report.dump(2);
    EXPECT_EQ(report["converged"], true);
    ASSERT_EQ(report["pictures"].size(), 1U);
    std::string command = report["pictures"][0]["command"];
    EXPECT_NE(session.text("out").find(command + "\n"), std::string::npos) << session.text("out");
    ASSERT_TRUE(command.starts_with("cairn "));
    command = fmt::format("cd '{}' && mv cairn-1.png ours.png && '{}' {} --quiet && cmp ours.png cairn-1.png",
                          session.folder().path().string(), CAIRN_COMMAND, command.substr(6));
    EXPECT_EQ(Session::shell(command), 0) << "another picture: " << command;
}

TEST(View, LeavesAfterFramesThatWereAskedFor) {
    const Session session("builtin:cornell --size 160x120 --frames 3");
    ASSERT_TRUE(session.wait_for_end());
    EXPECT_EQ(session.text("code"), "0\n") << session.text("log");
    const auto report = nlohmann::json::parse(session.text("report.json"));
    EXPECT_GE(report["frames"], 3);
    EXPECT_EQ(report["converged"], true);
}

TEST(View, WithoutADisplaySaysWhatToUse) {
    const ScratchFolder folder;
    const int status =
        Session::shell(fmt::format("env -u DISPLAY -u WAYLAND_DISPLAY '{}' view builtin:cornell 2>'{}'",
                                   CAIRN_COMMAND, folder.file("err")));
    EXPECT_EQ(status / 256, 4);
    EXPECT_NE(read_text(folder.file("err")).find("cairn render"), std::string::npos)
        << read_text(folder.file("err"));
}

}  // namespace
}  // namespace cairn::test
