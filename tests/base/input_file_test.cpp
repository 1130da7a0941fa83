// What may be opened for reading, and what is said of the rest.
#include "base/input_file.h"

#include <array>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "base/error.h"
#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

class InputFiles : public testing::Test {
protected:
    [[nodiscard]] std::filesystem::path place(const std::string& name) const { return folder_.path() / name; }
    static std::string refusal(const std::filesystem::path& path, const std::filesystem::path& folder = {}) {
        try {
            const InputFile file("ear.gltf: buffer 0", path, folder);
        } catch (const Error& error) {
            EXPECT_EQ(error.fault(), Fault::input);
            EXPECT_FALSE(error.way_out().empty()) << error.what();
            return error.what();
        }
        ADD_FAILURE() << path << " was opened";
        return {};
    }
    static void expect_refused(const std::string& why, const std::filesystem::path& path,
                               const std::filesystem::path& folder = {}) {
        const std::string text = refusal(path, folder);
        EXPECT_NE(text.find(why), std::string::npos) << text;
        EXPECT_TRUE(text.starts_with("ear.gltf: buffer 0: ")) << text;
    }

    ScratchFolder folder_;
};

TEST_F(InputFiles, AreReadInParts) {
    write_text(place("a"), "abcdef");
    InputFile file("", place("a"));
    EXPECT_EQ(file.size_bytes(), 6U);
    std::array<char, 4> part{};
    file.read(part.data(), 4);
    EXPECT_EQ(std::string(part.data(), 4), "abcd");
    file.read(part.data(), 2);
    EXPECT_EQ(std::string(part.data(), 2), "ef");
    EXPECT_THROW(file.read(part.data(), 1), Error);
}

TEST_F(InputFiles, ThatBecomeShorterAreAnError) {
    write_text(place("a"), "abcdef");
    InputFile file("", place("a"));
    std::filesystem::resize_file(place("a"), 2);
    std::array<char, 6> all{};
    EXPECT_THROW(file.read(all.data(), 6), Error);
}

TEST_F(InputFiles, AreRegularFiles) {
    expect_refused("no file \"gone\"", place("gone"));
    write_text(place("a"), "");
    expect_refused("no file", place("a/b"));
    std::filesystem::create_directory(place("sub"));
    expect_refused("a folder", place("sub"));
    ASSERT_EQ(mkfifo(place("pipe").c_str(), 0600), 0);
    expect_refused("a pipe", place("pipe"));
    expect_refused("a device", "/dev/null");
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string name = place("s").string();
    ASSERT_LT(name.size(), sizeof(address.sun_path));
    name.copy(address.sun_path, name.size());
    const int socket_file = socket(AF_UNIX, SOCK_STREAM, 0);
    ASSERT_EQ(bind(socket_file, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    expect_refused("a socket", place("s"));
    close(socket_file);
}

TEST_F(InputFiles, MustLieInTheFolderOnceLinksAreFollowed) {
    write_text(place("scene/in"), "");
    write_text(place("scene2/near"), "");  // a folder whose name begins alike is another
    write_text(place("out"), "");
    std::filesystem::create_symlink("in", place("scene/good"));
    std::filesystem::create_symlink(place("scene/in"), place("scene/whole"));
    std::filesystem::create_symlink("../out", place("scene/bad"));
    std::filesystem::create_symlink("../scene2/near", place("scene/near"));
    std::filesystem::create_symlink("bad", place("scene/twice"));
    for (const char* name : {"scene/in", "scene/good", "scene/whole"})
        EXPECT_NO_THROW((void)InputFile("", place(name), place("scene"))) << name;
    for (const char* name : {"scene/bad", "scene/near", "scene/twice", "scene/../out"})
        expect_refused("a link out of the folder", place(name), place("scene"));
    EXPECT_NO_THROW((void)InputFile("", place("scene/bad"), place(".")));
    EXPECT_NO_THROW((void)InputFile("", place("scene/bad")));
}

TEST_F(InputFiles, NamesInMessagesDriveNoTerminal) {
    const std::string text = refusal(place("\x1B[31m\n" + std::string(200, 'n')));
    EXPECT_EQ(text.find('\x1B'), std::string::npos);
    EXPECT_EQ(text.find('\n'), std::string::npos);
    EXPECT_LT(text.size(), 200U) << text;
}

}  // namespace
}  // namespace cairn::test
