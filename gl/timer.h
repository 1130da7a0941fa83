#pragma once

#include "gl/handle.h"

namespace cairn::gl {

/// Measures the time between `start()` and `stop()` by the driver's clock: two GL_TIMESTAMPs, so that timers
/// may overlap. (llvmpipe answers a GL_TIME_ELAPSED that begins before the context's first draw with the time
/// since the machine started.)
class Timer {
public:
    Timer();
    void start() const;
    void stop() const;
    /// Waits for the driver to pass both points.
    [[nodiscard]] double milliseconds() const;

private:
    QueryHandle begin_;
    QueryHandle end_;
};

}  // namespace cairn::gl
