#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <utility>

#include "gl/program.h"

namespace cairn::gl {

/// The programs that are built from one source with different definitions, by a key for each. A program is
/// built when it is first asked for.
///
/// @tparam Key  the features of a program: a struct of named values with `auto operator<=>`.
template <typename Key>
class ProgramFamily {
public:
    using Build = std::function<Program(const Key&)>;

    /// @param build  must not refer to objects that are moved or destroyed before the family is.
    explicit ProgramFamily(Build build) : build_(std::move(build)) {}

    /// @throws Error  as build_compute() and build_raster() do; the family is then unchanged.
    [[nodiscard]] const Program& get(const Key& key) {
        auto found = programs_.find(key);
        if (found == programs_.end()) found = programs_.emplace(key, build_(key)).first;
        return found->second;
    }

    /// Number of programs that have been built.
    [[nodiscard]] std::size_t size() const { return programs_.size(); }

private:
    Build build_;
    std::map<Key, Program> programs_;
};

}  // namespace cairn::gl
