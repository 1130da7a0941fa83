#include "gl/shader_source.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "gl/macro_check.h"
#include "shaders/embedded.h"

namespace cairn::gl {
namespace {

/// The quoted name of an #include line, if it is one.
std::optional<std::string_view> included_name(std::string_view line) {
    const std::size_t start = line.find_first_not_of(" \t");
    if (start == std::string_view::npos || !line.substr(start).starts_with("#include")) return std::nullopt;
    const std::size_t open = line.find('"', start);
    const std::size_t close = open == std::string_view::npos ? open : line.find('"', open + 1);
    if (close == std::string_view::npos) return std::nullopt;
    return line.substr(open + 1, close - open - 1);
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

}  // namespace

std::optional<std::string> ShaderSource::text_of(std::string_view name) const {
    if (folder_) {
        std::ifstream file(*folder_ / name, std::ios::binary);
        if (!file) return std::nullopt;
        std::ostringstream text;
        text << file.rdbuf();
        return text.str();
    }
    for (const shaders::EmbeddedFile& file : shaders::embedded_files()) {
        if (file.name == name) return std::string(file.text);
    }
    return std::nullopt;
}

void ShaderSource::append(std::string_view name, const std::string& from, MacroCheck& check,
                          ResolvedSource& out) const {
    if (std::find(out.files.begin(), out.files.end(), name) != out.files.end()) return;
    const std::optional<std::string> text = text_of(name);
    if (!text) {
        throw Error(Fault::input, from.empty() ? std::string("shader") : from,
                    fmt::format("there is no shader file \"{}\"{}", name,
                                folder_ ? " in " + folder_->string() : std::string()),
                    folder_ ? "name the shaders/ folder of the sources" : "");
    }
    const std::size_t index = out.files.size();
    out.files.emplace_back(name);
    out.included_from.push_back(from);
    out.text += fmt::format("#line 1 {}\n", index);

    const std::vector<std::string> lines = lines_of(*text);
    const std::vector<bool> for_cpp = lines_for_cpp(lines);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::string place = fmt::format("{}:{}", name, i + 1);
        if (for_cpp[i]) {
            out.text += '\n';
        } else if (const auto included = included_name(lines[i])) {
            append(*included, place, check, out);
            out.text += fmt::format("#line {} {}\n", i + 2, index);
        } else {
            const auto fault = check.fault_of(lines[i], i + 1 < lines.size() ? lines[i + 1] : std::string());
            if (fault) throw Error(Fault::input, place, *fault);
            out.text += lines[i];
            out.text += '\n';
        }
    }
}

ResolvedSource ShaderSource::resolve(std::string_view name, const Defines& defines) const {
    ResolvedSource out;
    out.text = "#version 450 core\n";
    for (const auto& [key, value] : defines)
        out.text += fmt::format("#define {} {}\n", key, value);
    MacroCheck check(defines);
    append(name, "", check, out);
    return out;
}

}  // namespace cairn::gl
