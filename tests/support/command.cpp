#include "tests/support/command.h"

#include <cstdlib>
#include <ostream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "tests/support/scratch_folder.h"

namespace cairn::test {
namespace {

/// A word for the shell: between single quotes, everything but the quote itself is literal.
std::string quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) {
        if (c == '\'') out += "'\\'";
        out += c;
    }
    out += '\'';
    return out;
}

}  // namespace

nlohmann::json Answer::json() const {
    nlohmann::json parsed = nlohmann::json::parse(out, nullptr, false);
    if (!parsed.is_discarded()) return parsed;
    ADD_FAILURE() << "stdout is no JSON" << *this;
    return {};
}

std::ostream& operator<<(std::ostream& out, const Answer& answer) {
    return out << fmt::format("\nexit code {}\nstdout: {}\nstderr: {}\n", answer.code, answer.out,
                              answer.err);
}

Answer cairn(const std::vector<std::string>& arguments, const Surroundings& surroundings) {
    const ScratchFolder scratch;
    std::string line;
    if (!surroundings.folder.empty()) line += fmt::format("cd {} && ", quoted(surroundings.folder.string()));
    if (!surroundings.limits.empty()) line += surroundings.limits + " && ";
    line += "env CAIRN_GL_DEBUG=1";
    for (const auto& [name, value] : surroundings.environment) {
        line += fmt::format(" {}={}", name, quoted(value));
    }
    line += fmt::format(" {}", quoted(CAIRN_COMMAND));
    for (const std::string& argument : arguments)
        line += fmt::format(" {}", quoted(argument));
    line += fmt::format(" >{} 2>{} </dev/null {}", quoted(scratch.file("out")), quoted(scratch.file("err")),
                        surroundings.redirections);
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(scratch.file("out")),
            read_text(scratch.file("err"))};
}

nlohmann::json cairn_json(std::vector<std::string> arguments, const Surroundings& surroundings) {
    arguments.insert(arguments.end(), {"--json", "-"});
    const Answer answer = cairn(arguments, surroundings);
    EXPECT_EQ(answer.code, 0) << answer;
    return answer.json();
}

}  // namespace cairn::test
