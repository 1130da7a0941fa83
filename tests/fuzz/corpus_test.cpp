// Runs every file of fuzz/corpus through the entry point that fuzzers call, so that a crash that was mended
// stays mended. A file that breaks a promise ends the program, after its name was printed.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include <gtest/gtest.h>

#include "fuzz/targets.h"

namespace cairn::fuzz {
namespace {

struct Target {
    const char* name;  ///< name of the fuzzer and of its corpus' folder
    void (*run)(Bytes);
    std::size_t least_files;
};

class Corpus : public testing::TestWithParam<Target> {};

std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(folder))
        files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

TEST_P(Corpus, IsUnderstoodOrRefused) {
    const std::filesystem::path folder = std::filesystem::path(CAIRN_FUZZ_CORPUS) / GetParam().name;
    const std::vector<std::filesystem::path> files = files_of(folder);
    ASSERT_GE(files.size(), GetParam().least_files) << folder;
    for (const std::filesystem::path& file : files) {
        (void)std::fprintf(stderr, "%s\n", file.c_str());
        std::ifstream stream(file, std::ios::binary);
        const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
        GetParam().run({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Corpus,
                         testing::Values(Target{"gltf", gltf, 20}, Target{"volume", volume, 12},
                                         Target{"uri", uri, 12}, Target{"options", options, 12},
                                         Target{"transfer", transfer, 8}),
                         [](const auto& target) { return target.param.name; });

// A fuzzer finds only broken promises, so a broken promise must end the program.
TEST(CorpusDeathTest, BrokenPromisesEndTheProgram) {
    EXPECT_DEATH(broken_promise("none"), "broken promise: none");
}

}  // namespace
}  // namespace cairn::fuzz
