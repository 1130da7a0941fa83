#pragma once

namespace cairn::app {

/// While an object lives, the first Ctrl-C (SIGINT) or SIGTERM sets asked(), so that the work can stop and
/// leave nothing half written. A second one ends the process as usual.
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
