#include "app/terminal/measure.h"

#include <fstream>
#include <limits>
#include <string>

namespace cairn::app {

std::uint64_t peak_rss_bytes() {
    std::ifstream status("/proc/self/status");
    for (std::string key; status >> key; status.ignore(std::numeric_limits<std::streamsize>::max(), '\n')) {
        std::uint64_t kib = 0;
        if (key == "VmHWM:" && status >> kib) return kib * 1024;
    }
    return 0;
}

}  // namespace cairn::app
