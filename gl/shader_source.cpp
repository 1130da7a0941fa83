#include "gl/shader_source.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "base/error.h"
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

void ShaderSource::append(std::string_view name, const std::string& from, ResolvedSource& out) const {
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

    std::istringstream lines(*text);
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        if (const auto included = included_name(line)) {
            append(*included, fmt::format("{}:{}", name, number), out);
            out.text += fmt::format("#line {} {}\n", number + 1, index);
        } else {
            out.text += line;
            out.text += '\n';
        }
    }
}

ResolvedSource ShaderSource::resolve(std::string_view name, const Defines& defines) const {
    ResolvedSource out;
    out.text = "#version 450 core\n";
    for (const auto& [key, value] : defines)
        out.text += fmt::format("#define {} {}\n", key, value);
    append(name, "", out);
    return out;
}

}  // namespace cairn::gl
