#include "app/verbs/verbs.h"
#include "base/error.h"

// Takes the place of verb_view.cpp in a build with -DCAIRN_VIEWER=OFF.

namespace cairn::app {

void add_view(CLI::App& command, Work& chosen) {
    CLI::App& verb = *command.add_subcommand("view", "Explore a scene in a window (not in this build)");
    verb.allow_extras();
    verb.callback([&chosen] {
        chosen = []() -> ExitCode {
            throw Error(Fault::usage, "view", "this cairn was built without windows",
                        "install GLFW and Dear ImGui (scripts/setup.sh --all), configure with "
                        "-DCAIRN_VIEWER=ON and build again");
        };
    });
}

}  // namespace cairn::app
