#pragma once

#include <mutex>
#include <string>
#include <vector>

namespace cairn::gl {

/// The messages of KHR_debug about errors and undefined behaviour in the current context.
class DebugLog {
public:
    DebugLog() = default;
    DebugLog(const DebugLog&) = delete;
    DebugLog& operator=(const DebugLog&) = delete;
    DebugLog(DebugLog&&) = delete;
    DebugLog& operator=(DebugLog&&) = delete;
    ~DebugLog() = default;

    /// Starts listening to the current context; the log must outlive it.
    void attach();

    /// Returns and removes the messages gathered so far, and the errors that glGetError still holds.
    [[nodiscard]] std::vector<std::string> take();

    void add(std::string message);

private:
    std::mutex mutex_;  // a driver may report from a thread of its own
    std::vector<std::string> messages_;
};

}  // namespace cairn::gl
