#include "base/output_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <random>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"

namespace cairn {
namespace {

constexpr std::string_view prefix = ".cairn-";
constexpr std::string_view suffix = ".part";

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, int code) {
    const bool no_room = code == ENOSPC || code == EDQUOT || code == EFBIG;
    throw Error(no_room ? Fault::memory : Fault::usage, path.string(),
                std::string(what) + ": " + std::strerror(code),
                "nothing was left half written; name another place for the output");
}

std::string hexadecimal(std::uint64_t number) {
    std::array<char, 17> digits{};
    (void)std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(number));
    return digits.data();
}

/// How the names begin of the unfinished files of a path. They are short, whatever the path's own name is.
std::string unfinished_prefix(const std::filesystem::path& path) {
    std::uint64_t hash = 14695981039346656037U;  // FNV-1a
    for (const char letter : path.filename().string())
        hash = (hash ^ static_cast<unsigned char>(letter)) * 1099511628211U;
    return std::string(prefix) + hexadecimal(hash) + "-";
}

std::filesystem::path unfinished_path(const std::filesystem::path& path) {
    std::random_device random;
    const std::uint64_t number = std::uint64_t(random()) << 32U | random();
    return path.parent_path() / (unfinished_prefix(path) + hexadecimal(number) + std::string(suffix));
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
    return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

/// The name of an open file without a name, by which it can be given one.
std::string name_by_number(int file) {
    return "/proc/self/fd/" + std::to_string(file);
}

}  // namespace

bool is_unfinished_output(std::string_view name) {
    return name.starts_with(prefix) && name.ends_with(suffix);
}

std::filesystem::path file_behind_links(const std::filesystem::path& path) {
    constexpr int most_links = 40;
    std::filesystem::path file = path;
    std::error_code failed;
    for (int links = 0; std::filesystem::is_symlink(file, failed); ++links) {
        if (links == most_links) fail(path, "cannot write", ELOOP);
        file = file.parent_path() / std::filesystem::read_symlink(file, failed);
        if (failed) fail(path, "cannot write", failed.value());
    }
    return file;
}

OutputFile::OutputFile(std::filesystem::path path, bool nameless) : path_(std::move(path)) {
    std::error_code failed;
    const std::filesystem::file_status there = std::filesystem::status(path_, failed);
    if (std::filesystem::is_directory(there)) fail(path_, "cannot write", EISDIR);
    if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there)) {
        in_place_ = true;
        file_ = std::fopen(path_.c_str(), "wb");
    } else {
        path_ = file_behind_links(path_);
        if (path_.filename().empty()) fail(path_, "cannot write", EISDIR);
        // Renaming over it would not ask for its permission.
        if (std::filesystem::exists(there) && access(path_.c_str(), W_OK) != 0)
            fail(path_, "cannot write", errno);
        const long longest = pathconf(folder_of(path_).c_str(), _PC_NAME_MAX);
        if (longest > 0 && path_.filename().string().size() > std::size_t(longest))
            fail(path_, "cannot write", ENAMETOOLONG);
        remove_leftovers();
        open_beside(nameless);
    }
    if (file_ == nullptr) fail(path_, "cannot write", errno);
    std::setvbuf(file_, nullptr, _IOFBF, 1U << 20);
}

void OutputFile::open_beside(bool nameless) {
    int file = -1;
    if (nameless) {
        file = open(folder_of(path_).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
        // Without /proc such a file cannot be given a name.
        if (file >= 0 && access(name_by_number(file).c_str(), F_OK) != 0) {
            close(file);
            file = -1;
        }
    }
    if (file < 0) {
        temporary_ = unfinished_path(path_);
        file = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    }
    if (file < 0) return;
    (void)flock(file, LOCK_EX | LOCK_NB);  // tells remove_leftovers() that its process lives
    file_ = fdopen(file, "wb");
    if (file_ != nullptr) return;
    const int code = errno;
    close(file);
    discard();
    errno = code;
}

/// Removes unfinished files of this path whose processes were killed: the system has dropped their locks.
void OutputFile::remove_leftovers() const {
    const std::string wanted = unfinished_prefix(path_);
    std::error_code failed;
    for (std::filesystem::directory_iterator entry(folder_of(path_), failed), end; !failed && entry != end;
         entry.increment(failed)) {
        const std::string name = entry->path().filename().string();
        if (!name.starts_with(wanted) || !is_unfinished_output(name)) continue;
        const int file = open(entry->path().c_str(), O_WRONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
        if (file < 0) continue;
        if (flock(file, LOCK_EX | LOCK_NB) == 0) unlink(entry->path().c_str());
        close(file);
    }
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
    if (count >= worth_a_seek && !in_place_) {
        if (fseeko(file_, off_t(count), SEEK_CUR) != 0) fail(path_, "cannot write", errno);
        return;
    }
    for (std::uint64_t left = count; left != 0;) {
        const std::size_t part = std::size_t(std::min(left, worth_a_seek));
        if (std::fwrite(zeros, 1, part, file_) != part) fail(path_, "cannot write", errno);
        left -= part;
    }
}

/// Gives the bytes the path's name, in one step for whoever looks, and the mode and the owner of the file
/// that had it.
void OutputFile::take_name(int file) {
    struct stat before {};
    if (stat(path_.c_str(), &before) == 0) {
        // Only root may give a file away; others keep their own.
        if (fchown(file, before.st_uid, before.st_gid) != 0) errno = 0;
        (void)fchmod(file, before.st_mode & 07777U);
    }
    if (temporary_.empty()) {
        const std::filesystem::path name = unfinished_path(path_);  // link() replaces no file, rename() does
        if (linkat(AT_FDCWD, name_by_number(file).c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) != 0)
            fail(path_, "cannot finish", errno);
        temporary_ = name;
    }
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_, "cannot finish", errno);
    temporary_.clear();
}

void OutputFile::commit() {
    if (zeros_ != 0) {
        --zeros_;  // the last byte is written, for a file does not grow by a seek
        write("", 1);
    }
    const int file = in_place_ ? -1 : dup(fileno(file_));
    if (!in_place_ && file < 0) fail(path_, "cannot finish", errno);
    try {
        // What the buffers still hold may not fit on the disk: fclose() tells that before there is a name.
        if (std::fclose(std::exchange(file_, nullptr)) != 0) fail(path_, "cannot finish", errno);
        if (!in_place_) take_name(file);
    } catch (...) {
        if (file >= 0) close(file);
        discard();
        throw;
    }
    if (file >= 0) close(file);
}

void OutputFile::discard() {
    if (!temporary_.empty()) unlink(temporary_.c_str());
    temporary_.clear();
}

}  // namespace cairn
