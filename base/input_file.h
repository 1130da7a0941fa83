#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace cairn {

/// A regular file that is open for reading. What was opened is what is checked: nothing waits for the writer
/// of a pipe, and no link leads anywhere unseen.
class InputFile {
public:
    /// @param where   the place that asks for the file, for messages: "ear.gltf: buffer 0"; empty: the path
    /// @param folder  the folder that the file must lie in, once links are followed; empty: any
    /// @throws Error (Fault::input) if there is no such file, it may not be read, it is a folder, a pipe or a
    ///               device, or it lies outside the folder.
    explicit InputFile(std::string where, const std::filesystem::path& path,
                       const std::filesystem::path& folder = {});
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;
    InputFile(InputFile&&) = delete;
    InputFile& operator=(InputFile&&) = delete;
    ~InputFile();

    [[nodiscard]] std::uint64_t size_bytes() const { return size_bytes_; }
    /// Reads the next bytes.
    /// @throws Error (Fault::input) if there are fewer: another program shortened the file, or the disk
    /// failed.
    void read(void* data, std::size_t count_bytes);

private:
    [[noreturn]] void fail(const std::string& what, const std::string& way_out) const;
    void check_inside(const std::filesystem::path& path, const std::filesystem::path& folder) const;

    std::string where_;
    std::string name_;
    int file_ = -1;
    std::uint64_t size_bytes_ = 0;
};

}  // namespace cairn
