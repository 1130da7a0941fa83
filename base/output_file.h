#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>

namespace cairn {

/// A file that appears whole or not at all: the bytes go to a temporary file beside it, which `commit()`
/// renames. Without `commit()` the temporary file is removed, and a file of that name from before stays. A
/// symbolic link stays a link: the file that it names is replaced. A device or a pipe (/dev/null) cannot be
/// replaced, so it is written in place.
///
/// @throws Error (Fault::usage) if the folder is missing or not writable, (Fault::memory) if the disk is
/// full.
class OutputFile {
public:
    explicit OutputFile(std::filesystem::path path);
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    OutputFile(OutputFile&&) = delete;
    OutputFile& operator=(OutputFile&&) = delete;
    ~OutputFile();

    void write(const void* data, std::size_t size_bytes);
    /// Appends zeros. Long runs take no room on file systems that can store holes.
    void write_zeros(std::uint64_t size_bytes);
    void commit();

private:
    void settle_zeros();
    void discard();

    std::filesystem::path path_;
    std::filesystem::path temporary_;  // empty when written in place
    std::FILE* file_ = nullptr;
    std::uint64_t zeros_ = 0;  // zeros that were skipped since the last write
};

}  // namespace cairn
