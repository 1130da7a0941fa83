#include "gl/macro_check.h"

#include <cctype>

#include <fmt/format.h>

namespace cairn::gl {
namespace {

bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

/// The next word, number or single sign of `text`, which loses it; empty at the end or at a comment.
std::string_view next_token(std::string_view& text) {
    while (!text.empty() && is_space(text.front()))
        text.remove_prefix(1);
    if (text.empty() || text.starts_with("//")) return {};
    std::size_t length = 1;
    if (is_word(text.front())) {
        while (length < text.size() && is_word(text[length]))
            ++length;
    }
    const std::string_view token = text.substr(0, length);
    text.remove_prefix(length);
    return token;
}

/// "if" of "#if A"; empty where the line is no directive. `line` keeps what follows.
std::string_view directive_of(std::string_view& line) {
    std::string_view rest = line;
    if (next_token(rest) != "#") return {};
    const std::string_view directive = next_token(rest);
    line = rest;
    return directive;
}

}  // namespace

MacroCheck::MacroCheck(const Defines& defines) {
    for (const auto& define : defines)
        defined_.insert(define.first);
}

std::optional<std::string> MacroCheck::fault_of(std::string_view line, std::string_view next) {
    const std::string_view directive = directive_of(line);
    if (directive == "define") {
        defined_.insert(std::string(next_token(line)));
    } else if (directive == "ifdef") {
        return fmt::format("\"{}\" is tested by #ifdef: a feature is always defined, and tested by #if",
                           next_token(line));
    } else if (directive == "ifndef") {
        const std::string_view guard = next_token(line);
        if (directive_of(next) == "define" && next_token(next) == guard) return std::nullopt;
        return fmt::format("\"{}\" is tested by #ifndef, and guards no file", guard);
    } else if (directive == "if" || directive == "elif") {
        for (std::string_view token = next_token(line); !token.empty(); token = next_token(line)) {
            const bool is_name = is_word(token.front()) && std::isdigit(token.front()) == 0;
            if (is_name && !defined_.contains(token)) return fmt::format("\"{}\" is not defined", token);
        }
    }
    return std::nullopt;
}

std::vector<bool> lines_for_cpp(const std::vector<std::string>& lines) {
    std::vector<bool> for_cpp;
    int depth = 0;  // of conditions, from that one on
    for (const std::string& text : lines) {
        std::string_view line = text;
        const std::string_view directive = directive_of(line);
        if (depth == 0) {
            if (directive == "ifdef" && next_token(line) == "__cplusplus") depth = 1;
            for_cpp.push_back(depth != 0);
            continue;
        }
        for_cpp.push_back(true);
        if (directive.starts_with("if")) ++depth;
        if (directive == "endif") --depth;
    }
    return for_cpp;
}

}  // namespace cairn::gl
