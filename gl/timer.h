#pragma once

#include "gl/handle.h"

namespace cairn::gl {

/// Measures what the driver does between `start()` and `stop()` on its own clock: two GL_TIMESTAMPs, so that
/// timers may overlap. (llvmpipe answers a GL_TIME_ELAPSED that begins before the context's first draw with
/// the time since the machine started.)
class Timer {
public:
    Timer();
    void start() const;
    void stop() const;
    [[nodiscard]] double milliseconds() const;  ///< waits for the driver

private:
    QueryHandle begin_;
    QueryHandle end_;
};

}  // namespace cairn::gl
