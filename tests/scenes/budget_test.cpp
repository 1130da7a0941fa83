// Small files that ask for much: what they would take is counted before it is made.
#include <array>
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <zlib.h>

#include "base/error.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "scenes/volume/volume.h"
#include "tests/support/count_news.h"
#include "tests/support/gltf_file.h"
#include "tests/support/scratch_folder.h"

namespace cairn::scenes {
namespace {

using test::GltfFile;
using test::Json;
using test::ScratchFolder;

#define EXPECT_HOLDS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

constexpr std::uint64_t mib = 1ULL << 20U;

/// An accessor of zeros, which has no data in the file.
int zeros(GltfFile& file, std::uint64_t count) {
    return file.add("accessors", {{"componentType", 5126}, {"count", count}, {"type", "VEC3"}});
}

/// 448 bytes: a mesh of triangles without data, at places without data.
GltfFile instances_bomb(std::uint64_t triangles, std::uint64_t places) {
    GltfFile file;
    const int positions = zeros(file, 3 * triangles);
    const int translations = zeros(file, places);
    file.add_mesh({{"attributes", {{"POSITION", positions}}}});
    file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", translations}};
    return file;
}

/// A morphed mesh that many nodes place: each place is a copy of its vertices.
GltfFile morph_bomb(std::uint64_t vertices, int nodes) {
    GltfFile file;
    const int positions = zeros(file, vertices);
    file.add("meshes", {{"primitives",
                         {{{"attributes", {{"POSITION", positions}}},
                           {"targets", {{{"POSITION", positions}}}},
                           {"mode", 0}}}},
                        {"weights", {1}}});
    for (int node = 0; node < nodes; ++node)
        file.add_root({{"mesh", 0}});
    return file;
}

Scene load_glb(const GltfFile& file, const LoadOptions& options = {}) {
    const ScratchFolder folder;
    file.write_glb(folder.file("bomb.glb"));
    return load(folder.file("bomb.glb"), options);
}

/// The message, way out included, of the error that `work` throws after it has asked for few bytes.
template <typename Work>
std::string refusal(Fault fault, const Work& work, std::uint64_t most_mib = 200) {
    const std::size_t before = test::new_bytes();
    std::string message;
    try {
        work();
        ADD_FAILURE() << "it was not refused";
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), fault) << error.what();
        message = std::string(error.what()) + "\n" + error.way_out();
    }
    EXPECT_LT((test::new_bytes() - before) / mib, most_mib) << message;
    return message;
}

TEST(Budget, InstancesTimesTrianglesAreCountedFirst) {
    const Scene scene = load_glb(instances_bomb(300'000, 100'000));
    const std::string message = refusal(Fault::memory, [&] { (void)take_snapshot(scene); });
    EXPECT_HOLDS(message, "30000000000 triangles");
    EXPECT_HOLDS(message, "1024 MiB");  // a small file may take so much
    EXPECT_HOLDS(message, "LoadOptions::memory_bytes");
}

TEST(Budget, InstancesThatFitArePlaced) {
    const Snapshot snapshot = take_snapshot(load_glb(instances_bomb(1000, 16'000)));
    EXPECT_EQ(snapshot.triangle_count, 16'000'000U);
    EXPECT_EQ(snapshot.items.size(), 16'000U);
}

TEST(Budget, PosedCopiesAreCountedFirst) {
    const Scene scene = load_glb(morph_bomb(1'000'000, 1000));
    EXPECT_HOLDS(refusal(Fault::memory, [&] { (void)take_snapshot(scene); }), "posed copies");
    EXPECT_EQ(take_snapshot(load_glb(morph_bomb(1'000'000, 3))).point_count, 3'000'000U);
}

TEST(Budget, TheMemoryOfAFileIsTheCallersChoice) {
    const GltfFile file = morph_bomb(1'000'000, 6);
    const std::string message =
        refusal(Fault::memory, [&] { (void)load_glb(file, {.memory_bytes = 20 * mib}); });
    EXPECT_HOLDS(message, "its geometry");
    EXPECT_HOLDS(message, "20 MiB");
    // What a caller allows replaces what files of this size may take.
    const Scene bomb = load_glb(instances_bomb(300'000, 100'000), {.memory_bytes = 4000 * mib});
    EXPECT_HOLDS(refusal(Fault::memory, [&] { (void)take_snapshot(bomb); }), "of 4000 MiB");
    // Enough to load, and too little to place six copies of 12 MB.
    const Scene scene = load_glb(file, {.memory_bytes = 60 * mib});
    EXPECT_HOLDS(refusal(Fault::memory, [&] { (void)take_snapshot(scene); }), "of 60 MiB");
}

TEST(Budget, JointsAreComputedOncePerSkinAndNotPerNode) {
    constexpr int count = 20'000;
    GltfFile file;
    const int positions = file.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int joints = file.add_accessor(std::vector<std::uint8_t>(12), "VEC4");
    const int weights = file.add_accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    file.add("meshes",
             {{"primitives",
               {{{"attributes", {{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}}}}}});
    Json all = Json::array();
    for (int node = 0; node < count; ++node) {
        all.push_back(node);
        file.add("nodes", {{"mesh", 0}, {"skin", 0}});
    }
    file.json["scenes"] = {{{"nodes", all}}};
    file.add("skins", {{"joints", all}});
    const Scene scene = load_glb(file);
    const std::size_t before = test::new_bytes();
    EXPECT_EQ(take_snapshot(scene).triangle_count, std::uint64_t(count));
    // One matrix per joint and node would be 51 GB.
    EXPECT_LT((test::new_bytes() - before) / mib, 100U);
}

class VolumeBudget : public testing::Test {
protected:
    std::string write(const char* name, const std::string& bytes) {
        test::write_text(folder_.file(name), bytes);
        return folder_.file(name);
    }
    ScratchFolder folder_;
};

/// A gzip member (RFC 1952).
std::string gzip_of(const std::string& bytes) {
    z_stream stream{};
    EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 9, Z_DEFAULT_STRATEGY), Z_OK);
    std::string packed(deflateBound(&stream, uLong(bytes.size())), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = uInt(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = uInt(packed.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

/// NIfTI-1 in one file: so many bytes along each axis.
std::string nifti(std::array<std::int16_t, 3> size, const std::string& samples) {
    std::string bytes(352, '\0');
    const auto put = [&](std::size_t at, auto value) { std::memcpy(&bytes[at], &value, sizeof(value)); };
    put(0, std::int32_t(348));
    put(40, std::int16_t(3));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        put(42 + 2 * axis, size[axis]);
        put(80 + 4 * axis, 1.0F);
    }
    put(70, std::int16_t(2));
    put(72, std::int16_t(8));
    put(108, 352.0F);
    std::memcpy(&bytes[344], "n+1", 4);
    return bytes + samples;
}

TEST_F(VolumeBudget, ATinyStreamCannotHoldWhatItsHeaderSays) {
    const std::string path = write("a.nii.gz", gzip_of(nifti({1290, 1290, 1290}, "")));
    EXPECT_HOLDS(refusal(
                     Fault::input, [&] { (void)load_volume(path); }, 10),
                 "cannot hold so many");
}

TEST_F(VolumeBudget, TheMemoryOfAVolumeIsTheCallersChoice) {
    // Zeros shrink a thousandfold, so the stream may hold them.
    const std::string path = write("a.nii.gz", gzip_of(nifti({200, 200, 200}, std::string(8'000'000, '\0'))));
    EXPECT_EQ(load_volume(path).samples.size(), 8'000'000U);
    const std::string message = refusal(
        Fault::memory, [&] { (void)load_volume(path, {.memory_bytes = 20 * mib}); }, 10);
    EXPECT_HOLDS(message, "200 x 200 x 200 samples");
    EXPECT_HOLDS(message, "LoadOptions::memory_bytes");
    const std::string huge = write("b.nii.gz", gzip_of(nifti({30'000, 30'000, 30'000}, "")));
    EXPECT_HOLDS(refusal(
                     Fault::memory, [&] { (void)load_volume(huge); }, 10),
                 "30000");
}

TEST_F(VolumeBudget, AGzipFileMayHaveSeveralMembers) {
    const std::string whole = nifti({4, 4, 4}, std::string(64, '\x07'));
    for (const std::size_t cut : {1, 200, 352, 400}) {
        const std::string path =
            write("a.nii.gz", gzip_of(whole.substr(0, cut)) + gzip_of("") + gzip_of(whole.substr(cut)));
        const Volume volume = load_volume(path);
        ASSERT_EQ(volume.samples.size(), 64U);
        EXPECT_EQ(volume.samples.back(), 7 * 257) << cut;
        // What follows that is no member is padding.
        const std::string padded = write("b.nii.gz", gzip_of(whole) + std::string(cut, '\0'));
        EXPECT_EQ(load_volume(padded).samples.size(), 64U);
    }
    const std::string cut_short = write("c.nii.gz", gzip_of(whole.substr(0, 380)));
    EXPECT_HOLDS(refusal(Fault::input, [&] { (void)load_volume(cut_short); }), "take 64 bytes");
}

TEST_F(VolumeBudget, APipeAFolderOrALinkElsewhereIsNotRead) {
    ASSERT_EQ(mkfifo(folder_.file("pipe.mha").c_str(), 0600), 0);
    EXPECT_HOLDS(refusal(Fault::input, [&] { (void)load_volume(folder_.file("pipe.mha")); }), "a pipe");
    std::filesystem::create_directory(folder_.file("in"));
    std::filesystem::create_directory(folder_.file("in/sub"));
    ASSERT_EQ(mkfifo(folder_.file("in/pipe.raw").c_str(), 0600), 0);
    write("out.raw", "12345678");
    std::filesystem::create_symlink("../out.raw", folder_.file("in/link.raw"));
    const auto header = [&](const std::string& data_file) {
        return write("in/a.mhd", fmt::format("NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"
                                             "ElementDataFile = {}\n",
                                             data_file));
    };
    const auto refused = [&](const std::string& data_file) {
        const std::string path = header(data_file);
        return refusal(Fault::input, [&] { (void)load_volume(path); });
    };
    EXPECT_HOLDS(refused("."), "a folder");
    EXPECT_HOLDS(refused("sub"), "a folder");
    EXPECT_HOLDS(refused("pipe.raw"), "a pipe");
    EXPECT_HOLDS(refused("link.raw"), "a link out of the folder");
    EXPECT_EQ(load_volume(header("link.raw"), {.trust_paths = true}).samples.size(), 8U);
}

}  // namespace
}  // namespace cairn::scenes
