#pragma once

#include <initializer_list>
#include <string>

#include <dlfcn.h>

#include "base/error.h"

namespace cairn::gl {

/// A shared library that is opened at run time. It stays loaded until the process ends: drivers keep threads
/// and thread-local destructors that must not outlive their code.
class DynamicLibrary {
public:
    DynamicLibrary(std::initializer_list<const char*> names, const std::string& package) {
        for (const char* name : names) {
            handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
            if (handle_ != nullptr) return;
        }
        throw Error(Fault::context, *names.begin(), "the library is not installed",
                    "install it (Debian: " + package + ") or choose another ContextOptions::kind");
    }

    /// @throws Error (Fault::context) if the library has no such function.
    template <typename Function>
    [[nodiscard]] Function function(const char* name) const {
        void* const address = dlsym(handle_, name);
        if (address == nullptr) {
            throw Error(Fault::context, name, "missing in the installed library",
                        "update the library, or choose another ContextOptions::kind");
        }
        return reinterpret_cast<Function>(address);
    }

private:
    void* handle_ = nullptr;
};

}  // namespace cairn::gl
