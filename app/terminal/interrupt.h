#pragma once

namespace cairn::app {

/// While one lives, the first Ctrl-C (SIGINT) or SIGTERM asks the work to stop, so that nothing half written
/// stays behind; a second one ends the process as ever.
class Interrupt {
public:
    Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;
    Interrupt(Interrupt&&) = delete;
    Interrupt& operator=(Interrupt&&) = delete;
    ~Interrupt();

    [[nodiscard]] static bool asked();
};

}  // namespace cairn::app
