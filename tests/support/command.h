#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace cairn::test {

/// Exit code and output of a run of the command.
struct Answer {
    int code = -1;  ///< exit code; -1 if it was killed
    std::string out;
    std::string err;

    /// The JSON on stdout. If stdout is not JSON, the test fails and the result is null.
    [[nodiscard]] nlohmann::json json() const;
};

std::ostream& operator<<(std::ostream& out, const Answer& answer);

struct Surroundings {
    std::filesystem::path folder = {};                    ///< working folder; empty: that of the test
    std::map<std::string, std::string> environment = {};  ///< variables added to those of the test
    std::string redirections = {};  ///< of the shell, as "2>&-": instead of those of the test
    std::string limits = {};        ///< what the shell does before, as "ulimit -v 262144"
};

/// Runs `cairn ARGUMENTS...` to its end. OpenGL errors end it (CAIRN_GL_DEBUG).
[[nodiscard]] Answer cairn(const std::vector<std::string>& arguments, const Surroundings& surroundings = {});

/// Runs `cairn ARGUMENTS... --json -` and returns the JSON. The test fails if the command does.
[[nodiscard]] nlohmann::json cairn_json(std::vector<std::string> arguments,
                                        const Surroundings& surroundings = {});

}  // namespace cairn::test
