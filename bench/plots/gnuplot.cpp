#include "bench/plots/gnuplot.h"

#include <array>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include "base/output_file.h"

extern char** environ;

namespace cairn::bench {

std::string run_gnuplot(const std::string& script, const std::filesystem::path& folder) {
    const std::filesystem::path path = folder / "chart.gnuplot";
    {
        OutputFile file(path);
        file.write(script.data(), script.size());
        file.commit();
    }
    std::string program = "gnuplot";
    std::string argument = path.string();
    const std::array<char*, 3> arguments = {program.data(), argument.data(), nullptr};
    pid_t child = 0;
    const int failed = posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments.data(), environ);
    int status = 0;
    if (failed == 0) {
        while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
        }
    }
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    if (failed == ENOENT) return "gnuplot is not installed (package gnuplot-nox)";
    if (failed != 0) return fmt::format("gnuplot cannot start: {}", std::strerror(failed));
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return "gnuplot failed";
    return {};
}

}  // namespace cairn::bench
