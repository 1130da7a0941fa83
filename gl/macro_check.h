#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "gl/shader_source.h"

namespace cairn::gl {

/// Holds shaders to one convention for features: a feature is a macro that is always defined, as 0 or 1 (or
/// another number), and is tested by #if alone. So a name that is misspelt, or that an includer forgot to
/// define, is an error; the preprocessor would take it for 0.
///
/// A name counts as defined from its first #define on, whichever branch of an #if that is in. Branches that
/// are not taken are checked too.
class MacroCheck {
public:
    explicit MacroCheck(const Defines& defines);

    /// Checks one line; to be called for each line of the text, in order.
    /// @param next  the line after it in the same file.
    /// @return what is wrong with the line, or nothing.
    [[nodiscard]] std::optional<std::string> fault_of(std::string_view line, std::string_view next);

private:
    std::set<std::string, std::less<>> defined_;
};

/// Marks the lines from `#ifdef __cplusplus` to its `#endif`, both included: a header that C++ and GLSL share
/// has these lines for C++ alone.
[[nodiscard]] std::vector<bool> lines_for_cpp(const std::vector<std::string>& lines);

}  // namespace cairn::gl
