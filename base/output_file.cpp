#include "base/output_file.h"

#include <cerrno>
#include <cstring>
#include <random>
#include <system_error>
#include <utility>

#include "base/error.h"

namespace cairn {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, int code) {
    throw Error(code == ENOSPC ? Fault::memory : Fault::usage, path.string(),
                std::string(what) + ": " + std::strerror(code),
                "nothing was left half written; name another place for the output");
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)) {
    std::error_code ignored;
    const std::filesystem::file_status there = std::filesystem::status(path_, ignored);
    if (std::filesystem::is_directory(there)) fail(path_, "cannot write", EISDIR);
    if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there)) {
        file_ = std::fopen(path_.c_str(), "wb");
    } else {
        if (std::filesystem::is_symlink(path_, ignored)) path_ = std::filesystem::weakly_canonical(path_);
        temporary_ = path_;
        temporary_ += ".part-" + std::to_string(std::random_device{}());
        file_ = std::fopen(temporary_.c_str(), "wbx");
    }
    if (file_ == nullptr) fail(path_, "cannot write", errno);
}

OutputFile::~OutputFile() {
    if (file_ == nullptr) return;
    std::fclose(file_);
    discard();
}

void OutputFile::write(const void* data, std::size_t size_bytes) {
    if (size_bytes != 0 && std::fwrite(data, 1, size_bytes, file_) != size_bytes) {
        fail(path_, "cannot write", errno);
    }
}

void OutputFile::commit() {
    // fclose reports what the buffers still held, so a full disk is seen before the rename.
    const int closed = std::fclose(std::exchange(file_, nullptr));
    const int code = errno;
    std::error_code failed;
    if (closed == 0) {
        if (!temporary_.empty()) std::filesystem::rename(temporary_, path_, failed);
        if (!failed) return;
    }
    discard();
    fail(path_, "cannot finish", closed != 0 ? code : failed.value());
}

void OutputFile::discard() {
    std::error_code ignored;
    if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

}  // namespace cairn
