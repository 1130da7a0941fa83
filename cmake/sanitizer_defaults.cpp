// Part of every program of a sanitized build: what the leak check must not blame on us.

#include <dlfcn.h>

// NOLINTBEGIN(bugprone-reserved-identifier): the sanitizers give these functions their names.
extern "C" {

/// Freed memory that is kept back to find uses of it: less than the usual 256 MiB, which would count as the
/// command's own where its memory has a limit. And what libraries keep per thread is not looked for: the
/// guess of where it lies can read a block that lies before it, and then the leak check ends the process.
const char* __asan_default_options() {
    return "quarantine_size_mb=64:intercept_tls_get_addr=0";
}

/// Mesa keeps a little to the end.
const char* __lsan_default_suppressions() {
    return "leak:libOSMesa\nleak:libLLVM\nleak:libX11\nleak:libGL\n";
}

/// EGL unloads its driver before the end, and what that leaves behind can be told from ours no longer.
int __lsan_is_turned_off() {
    return dlopen("libEGL.so.1", RTLD_LAZY | RTLD_NOLOAD) != nullptr ? 1 : 0;
}

/// Else every run ends with a list of what was suppressed, which the tests of the command would take for its
/// words.
const char* __lsan_default_options() {
    return "print_suppressions=0";
}
}
// NOLINTEND(bugprone-reserved-identifier)
