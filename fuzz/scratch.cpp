#include "fuzz/scratch.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace cairn::fuzz {
namespace {

class ScratchFolder {
public:
    ScratchFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "cairn-fuzz-XXXXXX").string();
        if (mkdtemp(pattern.data()) == nullptr) broken_promise("there is no folder for scratch files");
        path_ = pattern;
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ScratchFolder(ScratchFolder&&) = delete;
    ScratchFolder& operator=(ScratchFolder&&) = delete;
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

}  // namespace

const std::filesystem::path& scratch_folder() {
    static const ScratchFolder folder;
    return folder.path();
}

std::string scratch_file(const std::string& name, Bytes bytes) {
    const std::filesystem::path path = scratch_folder() / name;
    std::filesystem::remove(path);  // writing over a file waits for the disk on some file systems
    std::ofstream stream(path, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) broken_promise("a scratch file could not be written");
    return path.string();
}

void broken_promise(const char* what) {
    (void)std::fprintf(stderr, "broken promise: %s\n", what);
    std::abort();
}

}  // namespace cairn::fuzz
