#include "app/command_line.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <system_error>

#include <cairn/version.h>
#include <fmt/format.h>

#include "app/options/options.h"
#include "app/terminal/interrupt.h"
#include "app/terminal/terminal.h"
#include "base/error.h"
#include "base/output_file.h"
#include "renderer/open_content.h"
#include "scenes/load.h"

namespace cairn::app {
namespace {

std::string footer() {
    std::string text = "Built-in scenes:\n";
    for (const scenes::Builtin& builtin : scenes::builtins()) {
        text += fmt::format("  builtin:{:<14}{}\n", builtin.name, builtin.description);
    }
    for (const renderer::BuiltinVolume& builtin : renderer::builtin_volumes()) {
        text += fmt::format("  builtin:{:<14}{}\n", builtin.name, builtin.description);
    }
    for (const renderer::BuiltinSet& builtin : renderer::builtin_sets()) {
        text += fmt::format("  builtin:{:<14}{}\n", builtin.name, builtin.description);
    }
    text +=
        "\nExit codes: 0 done, 1 a comparison found a difference, 2 wrong usage, 3 bad input file,\n"
        "4 no usable OpenGL 4.5 context, 5 out of memory, 130 interrupted.\n"
        "With CAIRN_GL_DEBUG in the environment, any error that OpenGL reports ends the work.\n"
        "\n\"cairn VERB --help\" lists the options of a verb.";
    return text;
}

/// @throws Error (Fault::usage) if the verb is missing or unknown, in clearer words than those of CLI11.
void check_verb(const CLI::App& command, const std::string* argument) {
    if (argument != nullptr && argument->starts_with('-')) return;  // an option
    std::string verbs;
    for (const CLI::App* verb : command.get_subcommands([](const CLI::App*) { return true; })) {
        if (argument != nullptr && verb->get_name() == *argument) return;
        verbs += (verbs.empty() ? "" : ", ") + verb->get_name();
    }
    throw Error(Fault::usage, "",
                argument == nullptr ? "a verb is missing" : fmt::format("there is no verb \"{}\"", *argument),
                fmt::format("verbs: {}; \"cairn --help\" describes them", verbs));
}

/// An error of CLI11 as an Error of the command.
Error usage_error(const CLI::App& command, const CLI::ParseError& error) {
    std::string asked = "cairn";
    for (const CLI::App* verb : command.get_subcommands())
        asked += " " + verb->get_name();
    std::string what = error.what();
    if (error.get_exit_code() == int(CLI::ExitCodes::ArgumentMismatch)) {
        what = what.substr(0, what.find(':')) + " takes one value, once";
    }
    return {Fault::usage, "", what, fmt::format("\"{} --help\" lists the options", asked)};
}

/// @throws Error (Fault::usage) if two outputs of a verb are one file, of which the first would be lost.
void check_outputs_differ(const CLI::App& command) {
    std::map<std::filesystem::path, std::string> outputs;
    for (const CLI::App* verb : command.get_subcommands()) {
        for (const CLI::Option* option : verb->get_options()) {
            if (option->get_type_name() != output_file || option->empty()) continue;
            const std::string name = option->get_name();
            const std::filesystem::path path(option->results().front());
            if (path == "-" || is_device(path)) continue;
            std::error_code ignored;
            const auto [other, is_new] = outputs.try_emplace(
                std::filesystem::weakly_canonical(file_behind_links(path), ignored), name);
            if (!is_new)
                throw Error(Fault::usage, path.string(),
                            fmt::format("{} and {} would both write it", other->second, name),
                            "name two files");
        }
    }
}

void add_verbs(CLI::App& command, Work& chosen, AddBench add_bench_verb) {
    add_info(command, chosen);
    add_voxelize(command, chosen);
    add_check(command, chosen);
    add_render(command, chosen);
    add_view(command, chosen);
    add_shadow(command, chosen);
    add_export(command, chosen);
    if (add_bench_verb != nullptr)
        add_bench_verb(command, chosen);
    else
        command.add_subcommand("bench", bench_description);  // for the help
}

}  // namespace

Work read_command_line(const std::vector<std::string>& arguments, AddBench add_bench_verb) {
    const auto command = std::make_shared<CLI::App>(
        "Voxelizes glTF scenes on the GPU, and renders them through a bounded voxel cache.", "cairn");
    Work chosen;
    add_verbs(*command, chosen, add_bench_verb);
    command->require_subcommand(0, 1);
    command->set_version_flag("--version", "cairn " CAIRN_VERSION);
    command->get_formatter()->column_width(38);
    command->footer(footer());
    check_verb(*command, arguments.empty() ? nullptr : &arguments.front());
    if (add_bench_verb == nullptr && !arguments.empty() && arguments.front() == "bench")
        return bench_apart({arguments.begin() + 1, arguments.end()});
    std::vector<std::string> last_first(arguments.rbegin(), arguments.rend());  // the order that CLI11 takes
    try {
        command->parse(std::move(last_first));
    } catch (const CLI::Success& asked_for_help) {
        return [command, asked_for_help] {
            command->exit(asked_for_help);  // prints it
            return ExitCode::done;
        };
    } catch (const CLI::ParseError& error) {
        throw usage_error(*command, error);
    }
    if (!chosen) check_verb(*command, nullptr);
    check_outputs_differ(*command);
    return chosen;
}

int run_command(int argc, char** argv, AddBench add_bench_verb) {
    secure_standard_streams();
    try {
        const Interrupt interrupt;
        return int(read_command_line({argv + std::min(argc, 1), argv + argc}, add_bench_verb)());
    } catch (...) {
        return int(report_current_exception());
    }
}

}  // namespace cairn::app
