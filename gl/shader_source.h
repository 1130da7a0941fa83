#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cairn::gl {

/// Preprocessor definitions put before a shader's text: {"TREE_N", "4"}.
using Defines = std::vector<std::pair<std::string, std::string>>;

class MacroCheck;

/// A shader with its #includes resolved: one text for the driver, and the names of the files whose numbers
/// are in its #line directives.
struct ResolvedSource {
    std::string text;
    std::vector<std::string> files;  ///< file i of "#line n i"
    /// Per file the line that includes it ("march/shadow.comp.glsl:1"); empty for the first file.
    std::vector<std::string> included_from;
};

/// Where shader text comes from: the copies inside the library, or a folder that is read anew each time.
class ShaderSource {
public:
    ShaderSource() = default;
    explicit ShaderSource(std::optional<std::filesystem::path> folder) : folder_(std::move(folder)) {}

    /// Resolves `#include "folder/file.glsl"` (each file once, names relative to shaders/), leaves out the
    /// lines under `#ifdef __cplusplus`, and adds #version 450 core.
    /// @throws Error (Fault::input) naming file and line if a file does not exist, if #if names a macro that
    /// is not defined, or if a feature is tested by #ifdef (gl/macro_check.h).
    [[nodiscard]] ResolvedSource resolve(std::string_view name, const Defines& defines = {}) const;

private:
    void append(std::string_view name, const std::string& from, MacroCheck& check, ResolvedSource& out) const;
    [[nodiscard]] std::optional<std::string> text_of(std::string_view name) const;

    std::optional<std::filesystem::path> folder_;
};

}  // namespace cairn::gl
