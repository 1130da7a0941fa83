#pragma once

#include "gl/handle.h"

namespace cairn::gl {

/// Measures what the driver does between `start()` and `stop()` on its own clock (GL_TIME_ELAPSED).
/// Timers of one context cannot overlap.
class Timer {
public:
    Timer();
    void start() const;
    void stop() const;
    [[nodiscard]] double milliseconds() const;  ///< waits for the driver

private:
    QueryHandle query_;
};

}  // namespace cairn::gl
