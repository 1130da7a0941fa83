#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace cairn::test {

/// What a run of the command left behind.
struct Answer {
    int code = -1;  ///< exit code; -1: it was killed
    std::string out;
    std::string err;

    /// The JSON on stdout; a failure of the test, and null, when it is none.
    [[nodiscard]] nlohmann::json json() const;
};

std::ostream& operator<<(std::ostream& out, const Answer& answer);

struct Surroundings {
    std::filesystem::path folder = {};                    ///< working folder; empty: the test's own
    std::map<std::string, std::string> environment = {};  ///< added to the test's own
};

/// Runs `cairn ARGUMENTS...` to its end. OpenGL errors end it (CAIRN_GL_DEBUG).
[[nodiscard]] Answer cairn(const std::vector<std::string>& arguments, const Surroundings& surroundings = {});

/// The same with `--json -`; expects it to succeed.
[[nodiscard]] nlohmann::json cairn_json(std::vector<std::string> arguments,
                                        const Surroundings& surroundings = {});

}  // namespace cairn::test
