#pragma once

#include "base/error.h"

namespace cairn::app {

/// Exit codes of the process; docs/manual/README.md lists them.
enum class ExitCode : int {
    done = 0,
    differs = 1,  ///< a comparison found a difference
    usage = 2,    ///< wrong usage, or an output that cannot be written
    input = 3,    ///< a bad input file
    context = 4,  ///< no usable OpenGL 4.5
    memory = 5,   ///< not enough memory
    /// Stopped by Ctrl-C or SIGTERM: 128 + SIGINT, as shells count it.
    interrupted = 130,
    /// A fault of cairn itself (EX_SOFTWARE of sysexits.h); never expected.
    internal = 70,
};

[[nodiscard]] constexpr ExitCode exit_code(Fault fault) {
    switch (fault) {
        case Fault::usage:
            return ExitCode::usage;
        case Fault::input:
            return ExitCode::input;
        case Fault::context:
            return ExitCode::context;
        case Fault::memory:
            return ExitCode::memory;
        case Fault::interrupted:
            return ExitCode::interrupted;
        case Fault::internal:
            break;
    }
    return ExitCode::internal;
}

}  // namespace cairn::app
