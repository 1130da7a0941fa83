#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "gl/shader_source.h"

namespace cairn::gl {

/// An entry point (<verb>.<stage>.glsl), and the sets of definitions with which programs are built from it.
/// Each library lists its entry points, so that a test can compile all variants.
struct ShaderVariants {
    std::string name;
    std::vector<Defines> defines = {{}};
};

/// One set of definitions per value of one macro.
[[nodiscard]] inline std::vector<Defines> each_value(const std::string& macro,
                                                     std::initializer_list<int> values) {
    std::vector<Defines> sets;
    for (const int value : values)
        sets.push_back({{macro, std::to_string(value)}});
    return sets;
}

}  // namespace cairn::gl
