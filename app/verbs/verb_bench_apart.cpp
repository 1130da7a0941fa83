// The verb "bench" of the command, which hands its line over to the program cairn-bench: the charts link the
// peers that they measure, and these have no place in the process of any other verb.
#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include <unistd.h>

#include "app/verbs/verbs.h"
#include "base/error.h"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;

/// Where the program lies: beside the command in a build, in the folder of internal programs once installed.
fs::path bench_program() {
    std::error_code failed;
    const fs::path folder = fs::read_symlink("/proc/self/exe", failed).parent_path();
    if (failed) {  // never a program of the working folder
        throw Error(Fault::usage, "/proc/self/exe", failed.message(),
                    "mount /proc, or run cairn-bench where it is installed");
    }
    const fs::path beside = folder / "cairn-bench";
    const fs::path installed = folder.parent_path() / CAIRN_LIBEXECDIR / "cairn-bench";
    for (const fs::path& place : {beside, installed})
        if (fs::exists(place, failed)) return place;
    throw Error(Fault::usage, "bench",
                "there is neither \"" + beside.string() + "\" nor \"" + installed.string() + "\"",
                "configure with -DCAIRN_BENCH=ON, then build, and install if you do");
}

/// Becomes that program.
[[noreturn]] void hand_over(const std::vector<std::string>& options) {
    const fs::path program = bench_program();
    std::vector<std::string> words{program.string(), "bench"};
    words.insert(words.end(), options.begin(), options.end());
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    (void)execv(program.c_str(), arguments.data());
    throw Error(Fault::usage, program.string(),
                "it cannot be run: " + std::error_code(errno, std::generic_category()).message(),
                "build or install it again");
}

}  // namespace

Work bench_apart(const std::vector<std::string>& options) {
    return [options]() -> ExitCode { hand_over(options); };
}

}  // namespace cairn::app
