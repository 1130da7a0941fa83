#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>

namespace cairn {

/// A file without a name, for data that does not fit in memory until an output is written. The file lies in
/// the output's folder or, if that takes no files, in the folder for temporary files. It is removed when the
/// SideFile is destroyed or the program ends.
///
/// @throws Error (Fault::usage) if neither folder takes files, (Fault::memory) if the disk is full.
class SideFile {
public:
    explicit SideFile(const std::filesystem::path& output);
    SideFile(const SideFile&) = delete;
    SideFile& operator=(const SideFile&) = delete;
    SideFile(SideFile&&) = delete;
    SideFile& operator=(SideFile&&) = delete;
    ~SideFile();

    /// Appends bytes. @return their offset, for read().
    std::uint64_t write(const void* data, std::size_t size_bytes);
    void read(std::uint64_t offset, void* data, std::size_t size_bytes);

private:
    std::filesystem::path output_;
    std::FILE* file_ = nullptr;
    std::uint64_t size_ = 0;
    bool at_end_ = true;
};

}  // namespace cairn
