// Thousands of mutated files: each loads, or gives a cairn::Error of Fault::input; nothing crashes or hangs.
#include <filesystem>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "tests/support/count_news.h"
#include "tests/support/rich_gltf_file.h"
#include "tests/support/scratch_folder.h"

namespace cairn::scenes {
namespace {

using test::Bytes;
using test::GltfFile;
using test::Json;

class Fuzz : public testing::Test {
protected:
    /// A number below `bound`; the same stream on every standard library.
    std::uint32_t below(std::size_t bound) { return static_cast<std::uint32_t>(rng_() % bound); }

    /// Loads a file and plays its animations. The test fails if anything but a cairn::Error is thrown, or if
    /// it allocates more than such a small file can mean.
    void expect_survived(const Bytes& file, int round) {
        // Some file systems wait for the disk when a file is written over.
        std::filesystem::remove(path_);
        test::write_bytes(path_, file.data(), file.size());
        const std::size_t bytes_before = test::new_bytes();
        try {
            const Scene scene = load(path_);
            (void)take_snapshot(scene);
            for (int a = 0; a < static_cast<int>(scene.animations.size()); ++a)
                (void)take_snapshot(scene, {0.5, a, std::nullopt});
            ++loaded_;
        } catch (const Error& error) {
            EXPECT_EQ(error.fault(), Fault::input) << "round " << round << ": " << error.what();
            ++refused_;
        }
        EXPECT_LT((test::new_bytes() - bytes_before) >> 20U, 2000U) << "round " << round;
    }

    std::mt19937 rng_{20090701};
    test::ScratchFolder folder_;
    std::string path_ = folder_.file("fuzz.glb");
    int loaded_ = 0;
    int refused_ = 0;
};

constexpr int rounds = 1500;

TEST_F(Fuzz, BytesOfTheFile) {
    const Bytes good = test::rich_gltf_file().glb();
    for (int round = 0; round < rounds && !HasFailure(); ++round) {
        Bytes file = good;
        for (std::uint32_t change = below(4); change < 4; ++change)
            file[below(file.size())] = static_cast<std::uint8_t>(below(256));
        if (below(10) == 0) file.resize(below(file.size()));
        expect_survived(file, round);
    }
    EXPECT_GT(loaded_, rounds / 20);
    EXPECT_GT(refused_, rounds / 20);
}

TEST_F(Fuzz, BytesOfTheBinaryChunk) {
    const GltfFile good = test::rich_gltf_file();
    for (int round = 0; round < rounds && !HasFailure(); ++round) {
        GltfFile file = good;
        for (std::uint32_t change = below(8); change < 8; ++change)
            file.binary[below(file.binary.size())] = static_cast<std::uint8_t>(below(256));
        expect_survived(file.glb(), round);
    }
    EXPECT_GT(loaded_, rounds / 20);
    EXPECT_GT(refused_, rounds / 20);
}

/// Collects a pointer to every value of a document.
void collect(Json& value, std::vector<Json*>& values) {
    values.push_back(&value);
    if (value.is_structured())
        for (Json& inner : value)
            collect(inner, values);
}

TEST_F(Fuzz, ValuesOfTheJson) {
    const GltfFile good = test::rich_gltf_file();
    const std::vector<Json> replacements = {0,
                                            1,
                                            2,
                                            5,
                                            -1,
                                            255,
                                            4096,
                                            2147483647,
                                            -2.5,
                                            1e30,
                                            1e308,
                                            (1ULL << 52U),
                                            nullptr,
                                            true,
                                            "",
                                            "MASK",
                                            "..",
                                            "VEC3",
                                            Json::array(),
                                            Json::object(),
                                            5126,
                                            5123,
                                            5121,
                                            (1ULL << 63U),
                                            Json::array({0, 0}),
                                            Json::array({3})};
    for (int round = 0; round < rounds && !HasFailure(); ++round) {
        GltfFile file = good;
        file.json = file.with_buffer("");
        for (std::uint32_t change = below(3); change < 3; ++change) {
            std::vector<Json*> values;
            collect(file.json, values);
            Json& victim = *values[below(values.size())];
            Json& donor = *values[below(values.size())];
            if (below(2) == 0)
                victim = replacements[below(replacements.size())];
            else
                victim = Json(donor);
        }
        expect_survived(file.glb(), round);
    }
    EXPECT_GT(loaded_, rounds / 50);
    EXPECT_GT(refused_, rounds / 20);
}

}  // namespace
}  // namespace cairn::scenes
