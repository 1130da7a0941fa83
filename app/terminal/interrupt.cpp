#include "app/terminal/interrupt.h"

#include <csignal>

namespace cairn::app {
namespace {

volatile std::sig_atomic_t stop = 0;

constexpr int signals[] = {SIGINT, SIGTERM};

void ask_to_stop(int /*signal*/) {
    stop = 1;
}

}  // namespace

Interrupt::Interrupt() {
    struct sigaction action {};
    action.sa_handler = ask_to_stop;
    action.sa_flags = SA_RESETHAND | SA_RESTART;
    for (const int signal : signals) {
        // A signal that the parent process ignores (nohup, a shell's background job) stays ignored.
        struct sigaction before {};
        sigaction(signal, nullptr, &before);
        if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
    }
}

Interrupt::~Interrupt() {
    for (const int signal : signals) {
        struct sigaction now {};
        sigaction(signal, nullptr, &now);
        if (now.sa_handler == ask_to_stop) std::signal(signal, SIG_DFL);
    }
}

bool Interrupt::asked() {
    return stop != 0;
}

}  // namespace cairn::app
