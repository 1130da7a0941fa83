#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string_view>

namespace cairn {

/// A file that appears whole or not at all: the bytes go to a file without a name in the same folder, which
/// `commit()` gives its name. Without `commit()`, and when the process is killed, nothing is left, and a file
/// of that name from before stays. A symbolic link stays a link: the file that it names is replaced, by one
/// with the same mode. A device or a pipe (/dev/null) cannot be replaced, so it is written in place.
///
/// Where a file system has no files without a name, the bytes go to one with a name that
/// is_unfinished_output() knows. A killed process leaves it behind; the next OutputFile of the same path
/// removes it.
///
/// @throws Error (Fault::usage) if the folder is missing or not writable, (Fault::memory) if the disk is
/// full.
class OutputFile {
public:
    /// @param nameless  false: as on a file system without nameless files.
    explicit OutputFile(std::filesystem::path path, bool nameless = true);
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
    void open_beside(bool nameless);
    void remove_leftovers() const;
    void settle_zeros();
    void take_name(int file);
    void discard();

    std::filesystem::path path_;
    std::filesystem::path temporary_;  // where the bytes have a name; empty: they have none, or are in place
    bool in_place_ = false;
    std::FILE* file_ = nullptr;
    std::uint64_t zeros_ = 0;  // zeros that were skipped since the last write
};

/// The file that an OutputFile of this path replaces: the path itself, or what it links to, which need not be
/// there yet.
/// @throws Error (Fault::usage) if the links lead in a circle.
[[nodiscard]] std::filesystem::path file_behind_links(const std::filesystem::path& path);

/// Whether a file's name, without its folder, is one that an OutputFile gives to bytes that are not whole
/// yet.
[[nodiscard]] bool is_unfinished_output(std::string_view name);

}  // namespace cairn
