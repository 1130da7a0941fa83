#include "voxelizer/files/voxel_writer.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "voxelizer/files/write_binvox.h"
#include "voxelizer/files/write_npy.h"
#include "voxelizer/files/write_vdb.h"
#include "voxelizer/files/write_vox.h"

namespace cairn::voxelizer {
namespace {

struct Format {
    std::string_view ending;
    std::unique_ptr<VoxelWriter> (*make)(const std::filesystem::path&, const Grid&);
};

constexpr std::array<Format, 4> formats = {{{".npy", make_npy_writer},
                                            {".vdb", make_vdb_writer},
                                            {".binvox", make_binvox_writer},
                                            {".vox", make_vox_writer}}};

}  // namespace

std::vector<std::string> voxel_file_endings() {
    std::vector<std::string> endings;
    endings.reserve(formats.size());
    for (const Format& format : formats)
        endings.emplace_back(format.ending);
    return endings;
}

std::unique_ptr<VoxelWriter> make_voxel_writer(const std::filesystem::path& path, const Grid& grid) {
    std::string ending = path.extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    for (const Format& format : formats)
        if (format.ending == ending) return format.make(path, grid);
    throw Error(Fault::usage, path.string(),
                ending.empty() ? "a voxel file needs an ending that says its format"
                               : fmt::format("voxels are not written as \"{}\"", ending),
                fmt::format("choose one of: {}", fmt::join(voxel_file_endings(), ", ")));
}

}  // namespace cairn::voxelizer
