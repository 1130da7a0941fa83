#include <filesystem>
#include <string>
#include <vector>

#include "app/command_line.h"
#include "base/error.h"
#include "fuzz/scratch.h"
#include "fuzz/targets.h"

namespace cairn::fuzz {

void options(Bytes lines) {
    // Some options look at the file that they name. A fuzzer must stay in its folder.
    std::filesystem::current_path(scratch_folder());
    std::vector<std::string> arguments(1);
    for (const std::uint8_t byte : lines) {
        if (byte == '/') return;
        if (byte == '\n')
            arguments.emplace_back();
        else if (byte != 0)
            arguments.back() += char(byte);
    }
    if (arguments.back().empty()) arguments.pop_back();
    try {
        if (!app::read_command_line(arguments)) broken_promise("a command line that is right is work");
    } catch (const Error& error) {
        if (error.fault() != Fault::usage) broken_promise("a wrong command line is Fault::usage");
    }
}

}  // namespace cairn::fuzz
