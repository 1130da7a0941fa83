#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"

/// Values that have names on the command line.
namespace cairn::app {

template <typename Value>
using Names = std::vector<std::pair<std::string_view, Value>>;

/// The names, separated by `separator`, and the last one by `last_separator`: "none, hard or soft".
template <typename Value>
[[nodiscard]] std::string joined(const Names<Value>& names, std::string_view separator,
                                 std::string_view last_separator) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) text += i + 1 < names.size() ? separator : last_separator;
        text += names[i].first;
    }
    return text;
}

/// The value of a name; none if no value has that name.
template <typename Value>
[[nodiscard]] std::optional<Value> find_named(std::string_view name, const Names<Value>& names) {
    for (const auto& [known, value] : names) {
        if (known == name) return value;
    }
    return std::nullopt;
}

/// @throws Error (Fault::usage) if no value has that name: the error names `option` and lists all names.
template <typename Value>
[[nodiscard]] Value named(std::string_view option, std::string_view name, const Names<Value>& names) {
    if (const std::optional<Value> value = find_named(name, names)) return *value;
    throw Error(Fault::usage, std::string(option), "there is no \"" + std::string(name) + "\"",
                "choose " + joined(names, ", ", " or "));
}

/// The name of a value.
/// @throws Error (Fault::internal) if the value has no name.
template <typename Value>
[[nodiscard]] std::string name_of(const Value& value, const Names<Value>& names) {
    for (const auto& [name, known] : names) {
        if (known == value) return std::string(name);
    }
    throw Error(Fault::internal, "options", "a value has no name");
}

}  // namespace cairn::app
