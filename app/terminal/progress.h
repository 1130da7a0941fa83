#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace cairn::app {

/// Shows on stderr that work goes on, once it has lasted for over a second: as a bar if the share done is
/// known, else as seconds. Only on a terminal. The destructor wipes the line.
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
    std::atomic<double> share_{-1.0};  // negative if not known
    std::mutex mutex_;
    std::condition_variable wake_;
    bool done_ = false;
    std::thread drawer_;
};

}  // namespace cairn::app
