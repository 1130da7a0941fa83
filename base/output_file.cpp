#include "base/output_file.h"

#include <algorithm>
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
    std::setvbuf(file_, nullptr, _IOFBF, 1U << 20);
}

OutputFile::~OutputFile() {
    if (file_ == nullptr) return;
    std::fclose(file_);
    discard();
}

void OutputFile::write(const void* data, std::size_t size_bytes) {
    if (size_bytes == 0) return;
    settle_zeros();
    if (std::fwrite(data, 1, size_bytes, file_) != size_bytes) {
        fail(path_, "cannot write", errno);
    }
}

void OutputFile::write_zeros(std::uint64_t size_bytes) {
    zeros_ += size_bytes;
}

// A seek empties stdio's buffer, so that short runs are cheaper written. What is written in place may be a
// pipe, or hold older bytes: it gets every zero.
void OutputFile::settle_zeros() {
    constexpr std::uint64_t worth_a_seek = 1U << 16;
    static const char zeros[worth_a_seek] = {};
    const std::uint64_t count = std::exchange(zeros_, 0);
    if (count >= worth_a_seek && !temporary_.empty()) {
        if (fseeko(file_, off_t(count), SEEK_CUR) != 0) fail(path_, "cannot write", errno);
        return;
    }
    for (std::uint64_t left = count; left != 0;) {
        const std::size_t part = std::size_t(std::min(left, worth_a_seek));
        if (std::fwrite(zeros, 1, part, file_) != part) fail(path_, "cannot write", errno);
        left -= part;
    }
}

void OutputFile::commit() {
    if (zeros_ != 0) {
        --zeros_;  // the last byte is written, for a file does not grow by a seek
        write("", 1);
    }
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
