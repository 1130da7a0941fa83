#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>

namespace cairn {

/// A file that appears whole or not at all: it is written beside its name and renamed by `commit()`.
/// Without `commit()` nothing is left behind, and what stood there before stays. A symbolic link stays one:
/// what it names is replaced. A device or a pipe (/dev/null) cannot be replaced, so it is written in place.
///
/// @throws Error (Fault::usage) when the folder is missing or not writable, (Fault::memory) when the disk is
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
    /// Zeros that follow; long ones take no room on disks that can leave them out.
    void write_zeros(std::uint64_t size_bytes);
    void commit();

private:
    void settle_zeros();
    void discard();

    std::filesystem::path path_;
    std::filesystem::path temporary_;  // empty when written in place
    std::FILE* file_ = nullptr;
    std::uint64_t zeros_ = 0;  // skipped since the last write
};

}  // namespace cairn
