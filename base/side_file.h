#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>

namespace cairn {

/// A file without a name, for what does not fit in memory until an output is written. It lies on the output's
/// disk (where that folder takes no files, in the folder for temporary ones) and is gone when this is, or
/// when the program ends.
///
/// @throws Error (Fault::usage) when neither folder takes files, (Fault::memory) when the disk is full.
class SideFile {
public:
    explicit SideFile(const std::filesystem::path& output);
    SideFile(const SideFile&) = delete;
    SideFile& operator=(const SideFile&) = delete;
    SideFile(SideFile&&) = delete;
    SideFile& operator=(SideFile&&) = delete;
    ~SideFile();

    /// Appends; @return where it lies.
    std::uint64_t write(const void* data, std::size_t size_bytes);
    void read(std::uint64_t offset, void* data, std::size_t size_bytes);

private:
    std::filesystem::path output_;
    std::FILE* file_ = nullptr;
    std::uint64_t size_ = 0;
    bool at_end_ = true;
};

}  // namespace cairn
