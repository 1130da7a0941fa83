#include "app/terminal/driver.h"

#include <cstdlib>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"

namespace cairn::app {

bool wants_debugging() {
#ifdef NDEBUG
    return std::getenv("CAIRN_GL_DEBUG") != nullptr;
#else
    return true;
#endif
}

void check_debug_log(gl::Context& context) {
    const std::vector<std::string> messages = context.debug_log().take();
    if (messages.empty()) return;
    throw Error(Fault::context, gl::driver_name(),
                fmt::format("OpenGL reported {}", fmt::join(messages, "; ")),
                "a fault of cairn or of the driver: please report it");
}

Driver::Driver(const DriverOptions& options)
    : context_(gl::create_context({.kind = options.context, .debug = wants_debugging()})) {}

std::string Driver::name() const {
    return gl::driver_name();
}

std::string Driver::backend() const {
    return std::string(context_->backend());
}

void Driver::check() const {
    check_debug_log(*context_);
}

}  // namespace cairn::app
