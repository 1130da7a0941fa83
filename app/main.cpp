#include <string>

#include <fmt/format.h>

#include "app/terminal/exit_code.h"
#include "app/terminal/terminal.h"
#include "app/verbs/verbs.h"
#include "base/error.h"
#include "renderer/open_content.h"
#include "scenes/builtin/builtin.h"

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
    text +=
        "\nExit codes: 0 done, 1 a comparison found a difference, 2 wrong usage, 3 bad input file,\n"
        "4 no usable OpenGL 4.5 context, 5 out of memory, 130 interrupted.\n"
        "With CAIRN_GL_DEBUG in the environment, any error that OpenGL reports ends the work.\n"
        "\n\"cairn VERB --help\" lists what a verb takes.";
    return text;
}

/// Refuses a missing or unknown verb, for which CLI11 has odd words.
void check_verb(const CLI::App& command, const char* argument) {
    if (argument != nullptr && argument[0] == '-') return;  // an option
    std::string verbs;
    for (const CLI::App* verb : command.get_subcommands([](const CLI::App*) { return true; })) {
        if (argument != nullptr && verb->get_name() == argument) return;
        verbs += (verbs.empty() ? "" : ", ") + verb->get_name();
    }
    throw Error(Fault::usage, "",
                argument == nullptr ? "a verb is missing" : fmt::format("there is no verb \"{}\"", argument),
                fmt::format("verbs: {}; \"cairn --help\" tells more", verbs));
}

ExitCode report_usage(const CLI::App& command, const CLI::ParseError& error) {
    std::string asked = "cairn";
    for (const CLI::App* verb : command.get_subcommands())
        asked += " " + verb->get_name();
    std::string what = error.what();
    if (error.get_exit_code() == int(CLI::ExitCodes::ArgumentMismatch)) {
        what = what.substr(0, what.find(':')) + " takes one value, once";
    }
    print_error(what, fmt::format("\"{} --help\" lists what it takes", asked));
    return ExitCode::usage;
}

ExitCode run(int argc, char** argv) {
    CLI::App command("Voxelizes glTF scenes on the GPU, and renders them through a bounded voxel cache.",
                     "cairn");
    Work chosen;
    add_info(command, chosen);
    add_voxelize(command, chosen);
    add_check(command, chosen);
    add_render(command, chosen);
    add_view(command, chosen);
    add_shadow(command, chosen);
    add_export(command, chosen);
    add_bench(command, chosen);
    command.require_subcommand(0, 1);
    command.set_version_flag("--version", "cairn " CAIRN_VERSION);
    command.get_formatter()->column_width(38);
    command.footer(footer());
    check_verb(command, argc > 1 ? argv[1] : nullptr);
    try {
        command.parse(argc, argv);
    } catch (const CLI::Success& asked_for_help) {
        command.exit(asked_for_help);  // prints it
        return ExitCode::done;
    } catch (const CLI::ParseError& error) {
        return report_usage(command, error);
    }
    if (!chosen) check_verb(command, nullptr);
    return chosen();
}

}  // namespace
}  // namespace cairn::app

int main(int argc, char** argv) {
    try {
        return int(cairn::app::run(argc, argv));
    } catch (...) {
        return int(cairn::app::report_current_exception());
    }
}
