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
    std::error_code unknown;
    const fs::path folder = fs::read_symlink("/proc/self/exe", unknown).parent_path();
    for (const fs::path& place : {folder / "cairn-bench", folder / ".." / CAIRN_LIBEXECDIR / "cairn-bench"})
        if (fs::exists(place, unknown)) return place;
    throw Error(Fault::usage, "bench", "this cairn was built without its benchmarks",
                "configure with -DCAIRN_BENCH=ON and build again");
}

/// Becomes that program.
[[noreturn]] void hand_over(const std::vector<std::string>& options) {
    const fs::path program = bench_program();
    std::vector<std::string> words{program.string(), "bench"};
    words.insert(words.end(), options.begin(), options.end());
    std::vector<char*> arguments;
    for (std::string& word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    (void)execv(program.c_str(), arguments.data());
    throw Error(Fault::usage, program.string(),
                "it cannot be run: " + std::error_code(errno, std::generic_category()).message(),
                "build or install it again");
}

}  // namespace

void add_bench_apart(CLI::App& command, Work& chosen) {
    CLI::App& verb = *command.add_subcommand("bench", bench_description);
    verb.set_help_flag();  // the program's own help has the options
    verb.prefix_command();
    verb.callback(
        [&chosen, &verb] { chosen = [options = verb.remaining()]() -> ExitCode { hand_over(options); }; });
}

}  // namespace cairn::app
