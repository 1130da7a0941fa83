// Readers of volume files: files that they read, and files that they refuse.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "base/error.h"
#include "scenes/volume/volume.h"
#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

using scenes::load_volume;
using scenes::Volume;

std::string zlib_of(const std::string& bytes) {
    uLongf size = compressBound(uLong(bytes.size()));
    std::string packed(size, '\0');
    EXPECT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size,
                       reinterpret_cast<const Bytef*>(bytes.data()), uLong(bytes.size())),
              Z_OK);
    packed.resize(size);
    return packed;
}

template <typename T>
std::string bytes_of(T value, bool big = false) {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (big) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

/// A header with its samples in another file.
std::string elsewhere(const std::string& header, const std::string& file) {
    return fmt::format("{}{}\n", header.substr(0, header.find("LOCAL")), file);
}

std::string metaimage(const std::string& size, const std::string& type, const std::string& data,
                      const std::string& more = "") {
    return fmt::format(
        "ObjectType = Image\nNDims = 3\nDimSize = {}\n{}ElementType = {}\nElementDataFile = LOCAL\n{}", size,
        more, type, data);
}

/// A header of NIfTI-1 with a test's changes.
struct Nifti {
    bool big = false;
    std::string bytes = std::string(352, '\0');

    explicit Nifti(std::array<int, 3> size, int type, bool big_endian = false) : big(big_endian) {
        put<std::int32_t>(0, 348);
        put<std::int16_t>(40, 3);
        for (std::size_t i = 0; i < 3; ++i) {
            put<std::int16_t>(42 + 2 * i, std::int16_t(size[i]));
            put<float>(80 + 4 * i, 1.0F);
        }
        put<float>(76, 1.0F);
        put<std::int16_t>(70, std::int16_t(type));
        put<float>(108, 352.0F);
        put<char>(344, 'n');
        put<char>(345, '+');
        put<char>(346, '1');
    }
    template <typename T>
    void put(std::size_t at, T value) {
        const std::string encoded = bytes_of(value, big);
        std::copy(encoded.begin(), encoded.end(), bytes.begin() + std::ptrdiff_t(at));
    }
};

class VolumeFiles : public ::testing::Test {
protected:
    std::string write(const std::string& name, const std::string& bytes) const {
        write_text(folder_.path() / name, bytes);
        return (folder_.path() / name).string();
    }
    Volume read(const std::string& name, const std::string& bytes) const {
        return load_volume(write(name, bytes));
    }
    void expect_refused(const std::string& name, const std::string& bytes, const std::string& why) const {
        try {
            (void)read(name, bytes);
            ADD_FAILURE() << "not refused: " << why;
        } catch (const Error& error) {
            EXPECT_EQ(error.fault(), Fault::input) << error.what();
            EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
            EXPECT_FALSE(error.way_out().empty()) << error.what();
        }
    }

private:
    ScratchFolder folder_;
};

/// The place in the volume of a sample of the file: axes of the file become x, -z... of the world.
std::uint16_t sample(const Volume& v, int x, int y, int z) {
    return v.samples[std::size_t(x + v.size.x * (y + v.size.y * z))];
}

TEST_F(VolumeFiles, MetaImageHasItsSamplesWhereItsHeaderSays) {
    std::string data;
    for (int i = 0; i < 2 * 3 * 4; ++i)
        data += char(10 * i);
    const std::string place = "Offset = 100 200 300\nElementSpacing = 1 2 3\n";
    for (const bool packed : {false, true}) {
        const Volume v =
            read("a.mha", metaimage("2 3 4", "MET_UCHAR", packed ? zlib_of(data) : data,
                                    fmt::format("{}{}", place, packed ? "CompressedData = True\n" : "")));
        EXPECT_EQ(v.size, glm::ivec3(2, 4, 3));  // z upwards is the world's y
        EXPECT_EQ(v.spacing, glm::dvec3(1, 3, 2));
        EXPECT_EQ(v.low, 0.0);
        EXPECT_EQ(v.high, 255.0);
        // The file's y goes back, the world's z to the front: its last row comes first.
        EXPECT_EQ(v.origin, glm::dvec3(100, 300, -204));
        for (int k = 0; k < 4; ++k)
            for (int j = 0; j < 3; ++j)
                for (int i = 0; i < 2; ++i)
                    EXPECT_EQ(sample(v, i, k, 2 - j), 257 * 10 * (i + 2 * (j + 3 * k))) << i << j << k;
        EXPECT_EQ(v.bounds().low, glm::dvec3(99.5, 298.5, -205));
        EXPECT_EQ(v.bounds().high, glm::dvec3(101.5, 310.5, -199));
        EXPECT_TRUE(v.warnings.empty());
    }
}

TEST_F(VolumeFiles, EveryTypeAndByteOrderIsRead) {
    const auto check = [&](const char* type, int nifti_type,
                           const std::function<std::string(double, bool)>& encoded) {
        for (const bool big : {false, true}) {
            const std::string data = encoded(3.0, big) + encoded(100.0, big) + encoded(27.0, big);
            Nifti nifti({3, 1, 1}, nifti_type, big);
            const bool spread = nifti_type != 2;
            for (const Volume& v :
                 {read("a.mha", metaimage("3 1 1", type, data, big ? "BinaryDataByteOrderMSB = True\n" : "")),
                  read("a.nii", nifti.bytes + data)}) {
                const bool mirrored = v.name.ends_with(".nii");  // its x goes to the other side
                const double low = spread ? 3.0 : 0.0;
                const double high = spread ? 100.0 : 255.0;
                EXPECT_EQ(v.low, low) << type;
                EXPECT_EQ(v.high, high) << type;
                const double expected[] = {3.0, 100.0, 27.0};
                for (int i = 0; i < 3; ++i)
                    EXPECT_EQ(v.samples[std::size_t(mirrored ? 2 - i : i)],
                              std::lround(65535.0 * (expected[i] - low) / (high - low)))
                        << type << " " << v.name << " " << i;
            }
        }
    };
    check("MET_UCHAR", 2, [](double v, bool b) { return bytes_of(std::uint8_t(v), b); });
    check("MET_CHAR", 256, [](double v, bool b) { return bytes_of(std::int8_t(v), b); });
    check("MET_USHORT", 512, [](double v, bool b) { return bytes_of(std::uint16_t(v), b); });
    check("MET_SHORT", 4, [](double v, bool b) { return bytes_of(std::int16_t(v), b); });
    check("MET_UINT", 768, [](double v, bool b) { return bytes_of(std::uint32_t(v), b); });
    check("MET_INT", 8, [](double v, bool b) { return bytes_of(std::int32_t(v), b); });
    check("MET_ULONG_LONG", 1280, [](double v, bool b) { return bytes_of(std::uint64_t(v), b); });
    check("MET_LONG_LONG", 1024, [](double v, bool b) { return bytes_of(std::int64_t(v), b); });
    check("MET_FLOAT", 16, [](double v, bool b) { return bytes_of(float(v), b); });
    check("MET_DOUBLE", 64, [](double v, bool b) { return bytes_of(v, b); });
}

TEST_F(VolumeFiles, NiftiFollowsItsMatrixAndItsScale) {
    Nifti nifti({2, 2, 2}, 4);
    nifti.put<float>(112, 2.0F);
    nifti.put<float>(116, -5.0F);
    nifti.put<std::int16_t>(254, 1);
    // x from the file's k, y from its i, z from its j, at (10, 20, 30).
    const float rows[3][4] = {{0, 0, 3, 10}, {1, 0, 0, 20}, {0, 2, 0, 30}};
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 4; ++c)
            nifti.put<float>(280 + 16 * r + 4 * c, rows[r][c]);
    std::string data;
    for (int i = 0; i < 8; ++i)
        data += bytes_of(std::int16_t(i));
    const Volume v = read("a.nii", nifti.bytes + data);
    EXPECT_EQ(v.low, -5.0);
    EXPECT_EQ(v.high, 9.0);
    EXPECT_EQ(v.spacing, glm::dvec3(3, 2, 1));
    EXPECT_EQ(v.origin, glm::dvec3(-13, 30, 20));  // world: -x, z, y
    for (int i = 0; i < 8; ++i)
        EXPECT_EQ(sample(v, 1 - (i >> 2), i >> 1 & 1, i & 1), std::lround(65535.0 * i / 7.0)) << i;
}

TEST_F(VolumeFiles, WhatIsNotFollowedIsWarnedOf) {
    const double c = std::sqrt(0.5);
    const Volume turned =
        read("a.mha", metaimage("1 1 1", "MET_UCHAR", "\x01",
                                fmt::format("TransformMatrix = {0} {0} 0 -{0} {0} 0 0 0 1\n", c)));
    EXPECT_EQ(turned.warnings.size(), 1U);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Volume odd =
        read("b.mha", metaimage("3 1 1", "MET_FLOAT", bytes_of(nan) + bytes_of(1.0F) + bytes_of(2.0F)));
    EXPECT_EQ(odd.warnings.size(), 1U);
    EXPECT_EQ(odd.samples, (std::vector<std::uint16_t>{0, 0, 65535}));
    Nifti series({1, 1, 1}, 2);
    series.put<std::int16_t>(40, 4);
    series.put<std::int16_t>(48, 5);
    EXPECT_EQ(read("c.nii", series.bytes + "abcde").warnings.size(), 1U);
}

TEST_F(VolumeFiles, DataInAFileBesideTheHeaderIsRead) {
    write("a.raw", "skip\x01\x02");
    const std::string header = elsewhere(metaimage("2 1 1", "MET_UCHAR", "", "HeaderSize = -1\n"), "a.raw");
    EXPECT_EQ(read("a.mhd", header).samples, (std::vector<std::uint16_t>{257, 514}));
    for (const std::string other : {"../a.raw", "/a.raw", "b%03d.raw", "LIST", ""}) {
        const std::string bad = elsewhere(metaimage("2 1 1", "MET_UCHAR", ""), other);
        EXPECT_THROW((void)read("b.mhd", bad), Error) << other;
    }
}

TEST_F(VolumeFiles, DamagedOnesAreRefusedWithTheReason) {
    expect_refused("a.mha", "", "ElementDataFile");
    expect_refused("a.mha", "glTF", "ElementDataFile");
    expect_refused("a.mha", "no equals sign\n", "without \"=\"");
    expect_refused("a.mha", metaimage("2 2 2", "MET_UCHAR", "1234567"), "take 8 bytes, and it holds 7");
    expect_refused("a.mha", metaimage("0 2 2", "MET_UCHAR", ""), "DimSize 0");
    expect_refused("a.mha", metaimage("-1 2 2", "MET_UCHAR", ""), "DimSize -1");
    expect_refused("a.mha", metaimage("2 2", "MET_UCHAR", ""), "DimSize is not 3 numbers");
    expect_refused("a.mha", metaimage("nan 2 2", "MET_UCHAR", ""), "DimSize nan");
    expect_refused("a.mha", metaimage("1048577 1 1", "MET_UCHAR", ""), "1048577 samples along axis i");
    expect_refused("a.mha", metaimage("90 90 90", "MET_DOUBLE", zlib_of("x"), "CompressedData = True\n"),
                   "cannot hold so many");
    expect_refused("a.mha", metaimage("9 9 9", "MET_DOUBLE", zlib_of("x"), "CompressedData = True\n"),
                   "holds 1");
    expect_refused("a.mha", metaimage("2 1 1", "MET_UCHAR", "zz", "CompressedData = True\n"),
                   "compressed data is broken");
    expect_refused("a.mha", metaimage("1 1 1", "MET_UCHAR_ARRAY", "1"), "ElementType");
    expect_refused("a.mha", metaimage("1 1 1", "MET_UCHAR", "1", "ElementSpacing = 0 1 1\n"),
                   "distance between its samples");
    expect_refused("a.mha", metaimage("1 1 1", "MET_UCHAR", "1", "ElementNumberOfChannels = 3\n"),
                   "more than one value");
    expect_refused("a.mha", metaimage("1 1 1", "MET_UCHAR", "1", "BinaryData = False\n"), "text");
    expect_refused("a.mha", metaimage("1 1 1", "MET_UCHAR", "1", "TransformMatrix = 1 0 0 1 0 0 0 0 1\n"),
                   "do not span");
    expect_refused("a.mha", metaimage("1 1 1", "MET_FLOAT", bytes_of(std::nanf(""))), "none of its values");
    expect_refused("a.nii", "", "holds 0 bytes");
    expect_refused("a.nii", std::string(400, '\0'), "number of dimensions");
    Nifti pair({1, 1, 1}, 2);
    pair.bytes[345] = 'i';
    expect_refused("a.nii", pair.bytes, "one file");
    expect_refused("a.nii", Nifti({1, 1, 1}, 128).bytes + "123", "data type 128");
    expect_refused("a.nii", Nifti({-3, 1, 1}, 2).bytes, "samples along axis");
    expect_refused("a.nii", Nifti({30, 30, 30}, 2).bytes, "take 27000 bytes");
    Nifti far({1, 1, 1}, 2);
    far.put<float>(108, 1e30F);
    expect_refused("a.nii", far.bytes, "start at byte");
    expect_refused("a.xyz", "", "no volume format");
    EXPECT_THROW((void)load_volume("/nowhere/at/all.mha"), Error);
}

TEST_F(VolumeFiles, AnyDamageEndsInAnErrorOrAVolume) {
    Nifti nifti({4, 3, 2}, 4);
    const std::string data(48, 'd');
    const std::string files[] = {
        metaimage("4 3 2", "MET_SHORT", zlib_of(data), "CompressedData = True\nOffset = 1 2 3\n"),
        nifti.bytes + data};
    std::mt19937 rng(31);
    int read_anyway = 0;
    for (int turn = 0; turn < 3000; ++turn) {
        const bool is_nifti = turn % 2 == 1;
        std::string bytes = files[is_nifti ? 1 : 0];
        const int faults = 1 + int(rng() % 3);
        for (int i = 0; i < faults; ++i)
            bytes[rng() % bytes.size()] = char(rng());
        if (rng() % 4 == 0) bytes.resize(rng() % bytes.size());
        try {
            const Volume v = read(is_nifti ? "a.nii" : "a.mha", bytes);
            EXPECT_EQ(v.samples.size(), std::size_t(v.size.x) * std::size_t(v.size.y) * std::size_t(v.size.z))
                << "seed 31, turn " << turn;
            ++read_anyway;
        } catch (const Error& error) {
            const bool expected = error.fault() == Fault::input || error.fault() == Fault::memory;
            EXPECT_TRUE(expected) << error.what() << ", seed 31, turn " << turn;
        }
    }
    EXPECT_GT(read_anyway, 100);
}

#ifdef CAIRN_SCENE_DATA
TEST_F(VolumeFiles, RealScansAreReadUpright) {
    const std::string folder = CAIRN_SCENE_DATA "/volumes/";
    const Volume chest = load_volume(folder + "LIDC_chest_CT_256x256x133_u8.mha");
    EXPECT_EQ(chest.size, glm::ivec3(256, 133, 256));
    EXPECT_NEAR(chest.spacing.y, 2.5, 1e-9);
    EXPECT_TRUE(chest.warnings.empty());
    const Volume head = load_volume(folder + "ICBM152_T1_MRI_207x256x215_u8.nii.gz");
    EXPECT_EQ(head.size, glm::ivec3(207, 215, 256));
    EXPECT_NEAR(head.spacing.x, 0.737463, 1e-5);
    EXPECT_TRUE(head.warnings.empty());
    // Its face looks to +z, so the lower front (the nose) is there, and the lower back is the neck.
    EXPECT_NEAR(head.bounds().high.y, -71.76 + 215 * 0.737, 1.0);
}
#endif

}  // namespace
}  // namespace cairn::test
