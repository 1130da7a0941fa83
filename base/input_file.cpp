#include "base/input_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"

namespace cairn {
namespace {

/// Text of a file, fit for one line of a message.
std::string printable(std::string text) {
    constexpr std::size_t longest = 80;
    if (text.size() > longest) text = "..." + text.substr(text.size() - longest);
    std::ranges::replace_if(
        text, [](unsigned char letter) { return letter < 0x20 || letter == 0x7F; }, '?');
    return '"' + text + '"';
}

const char* kind_of(mode_t mode) {
    if (S_ISDIR(mode)) return "a folder";
    if (S_ISFIFO(mode)) return "a pipe";
    if (S_ISSOCK(mode)) return "a socket";
    return "a device";
}

bool is_under(const std::filesystem::path& path, const std::filesystem::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

InputFile::InputFile(std::string where, const std::filesystem::path& path,
                     const std::filesystem::path& folder)
    : where_(where.empty() ? path.string() : std::move(where)), name_(printable(path.filename().string())) {
    // Without O_NONBLOCK, opening a pipe waits until somebody writes to it.
    file_ = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file_ < 0) {
        const int code = errno;
        if (code == ENOENT || code == ENOTDIR)
            fail("there is no file " + name_, "check the name, and that all files were copied together");
        if (code == ENXIO) fail(name_ + " is a socket and not a regular file", "name a file");
        fail(name_ + " cannot be opened: " + std::strerror(code), "check its permissions");
    }
    try {
        struct stat status {};
        if (fstat(file_, &status) != 0)
            fail(name_ + " cannot be read: " + std::strerror(errno), "check its permissions");
        if (!S_ISREG(status.st_mode))
            fail(name_ + " is " + kind_of(status.st_mode) + " and not a regular file", "name a file");
        size_bytes_ = static_cast<std::uint64_t>(status.st_size);
        if (!folder.empty()) check_inside(path, folder);
    } catch (...) {
        close(file_);
        throw;
    }
}

InputFile::~InputFile() {
    close(file_);
}

void InputFile::check_inside(const std::filesystem::path& path, const std::filesystem::path& folder) const {
    std::error_code failed;
    const std::filesystem::path real = std::filesystem::canonical(path, failed);
    const std::filesystem::path real_folder =
        failed ? std::filesystem::path() : std::filesystem::canonical(folder, failed);
    struct stat opened {};
    struct stat found {};
    // The path may lead elsewhere by now; then it says nothing about what was opened.
    const bool same = !failed && fstat(file_, &opened) == 0 && stat(real.c_str(), &found) == 0 &&
                      opened.st_dev == found.st_dev && opened.st_ino == found.st_ino;
    if (!same || !is_under(real, real_folder))
        fail(name_ + " is a link out of the folder of the file",
             "if you trust the file, allow it with LoadOptions::trust_paths");
}

void InputFile::read(void* data, std::size_t count_bytes) {
    auto* out = static_cast<char*>(data);
    while (count_bytes != 0) {
        const ssize_t got = ::read(file_, out, count_bytes);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail("reading " + name_ + " failed: " + std::strerror(errno), "check the disk");
        if (got == 0) fail(name_ + " became shorter while it was read", "read it again");
        out += got;
        count_bytes -= static_cast<std::size_t>(got);
    }
}

void InputFile::fail(const std::string& what, const std::string& way_out) const {
    throw Error(Fault::input, where_, what, way_out);
}

}  // namespace cairn
