#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace cairn::app {

/// Tells on stderr that work goes on, once it has lasted over a second: a bar when the share done is known,
/// else the seconds. Only on a terminal; the line is wiped when this is destroyed.
class Progress {
public:
    Progress(std::string what, bool quiet);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    Progress(Progress&&) = delete;
    Progress& operator=(Progress&&) = delete;
    ~Progress();

    /// @param done  the share done, in [0, 1].
    void set(double done) { share_.store(done); }

private:
    void draw_until_done();

    std::string what_;
    std::atomic<double> share_{-1.0};  // negative: not known
    std::mutex mutex_;
    std::condition_variable wake_;
    bool done_ = false;
    std::thread drawer_;
};

}  // namespace cairn::app
