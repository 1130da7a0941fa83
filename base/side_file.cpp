#include "base/side_file.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

#include <unistd.h>

#include "base/error.h"

namespace cairn {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what, int code) {
    const bool no_room = code == ENOSPC || code == EDQUOT || code == EFBIG;
    throw Error(no_room ? Fault::memory : Fault::usage, path.string(), what + ": " + std::strerror(code),
                "name another place for the output");
}

/// -1 when the folder takes no files.
int create_in(const std::filesystem::path& folder) {
    std::string name = (folder / "cairn-XXXXXX").string();
    const int file = mkstemp(name.data());
    if (file >= 0) unlink(name.c_str());
    return file;
}

}  // namespace

SideFile::SideFile(const std::filesystem::path& output) : output_(output) {
    const std::filesystem::path folder = output.has_parent_path() ? output.parent_path() : ".";
    int file = create_in(folder);
    if (file < 0) file = create_in(std::filesystem::temp_directory_path());
    if (file >= 0) file_ = fdopen(file, "w+b");
    if (file_ == nullptr) fail(output_, "there is no place for a temporary file", errno);
    std::setvbuf(file_, nullptr, _IOFBF, 1U << 18);
}

SideFile::~SideFile() {
    std::fclose(file_);
}

std::uint64_t SideFile::write(const void* data, std::size_t size_bytes) {
    if (!std::exchange(at_end_, true) && fseeko(file_, 0, SEEK_END) != 0)
        fail(output_, "cannot write a temporary file", errno);
    if (size_bytes != 0 && std::fwrite(data, 1, size_bytes, file_) != size_bytes)
        fail(output_, "cannot write a temporary file", errno);
    return std::exchange(size_, size_ + size_bytes);
}

void SideFile::read(std::uint64_t offset, void* data, std::size_t size_bytes) {
    at_end_ = false;
    if (fseeko(file_, off_t(offset), SEEK_SET) != 0 ||
        (size_bytes != 0 && std::fread(data, 1, size_bytes, file_) != size_bytes))
        fail(output_, "cannot read back a temporary file", errno);
}

}  // namespace cairn
