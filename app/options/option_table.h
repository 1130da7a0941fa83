#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/options/names.h"
#include "app/options/parse.h"

/// Options of the command line as rows of a table. A row says how its option is read, what the help says of
/// it, and how it is written into a command line. To add an option, add a row.
namespace cairn::app {

/// One option, whose value lies somewhere in an `Options`.
template <typename Options>
struct OptionRow {
    /// The name as it is typed: "--size", or "-r,--resolution".
    std::string name;
    /// The word for the value in the help, "WxH" for instance; empty if the option is a flag, without a
    /// value.
    std::string value_name;
    /// The help. "{default}" is replaced by what `print` returns before anything is parsed.
    std::string description;
    /// Reads `text`, which is empty for a flag. `option` is the long name, for errors.
    /// @throws Error (Fault::usage) if the text is not a value of the option.
    std::function<void(Options&, const char* option, const std::string& text)> parse;
    /// A text that `parse` reads as the same value; none if the option was not given.
    std::function<std::optional<std::string>(const Options&)> print;

    [[nodiscard]] std::string long_name() const { return name.substr(name.rfind(',') + 1); }
    [[nodiscard]] bool is_flag() const { return value_name.empty(); }
};

template <typename Options>
using OptionTable = std::vector<OptionRow<Options>>;

/// Rows of usual kinds. `member` takes the options, const or not, and returns a reference to the value in
/// them: `[](auto& options) -> auto& { return options.tree.n; }`. The value may be a std::optional of its
/// type.
/// @{

/// A whole number within [low, high].
template <typename Options, typename Member>
[[nodiscard]] OptionRow<Options> whole_row(const char* name, const char* value_name, std::string description,
                                           int low, int high, Member member) {
    return {name, value_name, std::move(description),
            [=](Options& options, const char* option, const std::string& text) {
                member(options) = parse_int(option, text, low, high);
            },
            [=](const Options& options) -> std::optional<std::string> {
                const std::optional<int> value = member(options);
                if (!value) return std::nullopt;
                return std::to_string(*value);
            }};
}

/// A number within [low, high].
template <typename Options, typename Member>
[[nodiscard]] OptionRow<Options> number_row(const char* name, const char* value_name, std::string description,
                                            double low, double high, Member member) {
    return {name, value_name, std::move(description),
            [=](Options& options, const char* option, const std::string& text) {
                const double value = parse_number(option, text);
                if (value < low || value > high) {
                    throw Error(Fault::usage, option,
                                fmt::format("{} is not between {} and {}", value, low, high));
                }
                member(options) = value;
            },
            [=](const Options& options) -> std::optional<std::string> {
                const std::optional<double> value = member(options);
                if (!value) return std::nullopt;
                return fmt::format("{}", *value);
            }};
}

/// A text that is taken as it stands.
template <typename Options, typename Member>
[[nodiscard]] OptionRow<Options> text_row(const char* name, const char* value_name, std::string description,
                                          Member member) {
    return {name, value_name, std::move(description),
            [=](Options& options, const char*, const std::string& text) { member(options) = text; },
            [=](const Options& options) -> std::optional<std::string> { return member(options); }};
}

/// One of several values that have names.
template <typename Options, typename Value, typename Member>
[[nodiscard]] OptionRow<Options> named_row(const char* name, std::string description,
                                           const Names<Value>& names, Member member) {
    return {name, joined(names, "|", "|"), std::move(description),
            [=](Options& options, const char* option, const std::string& text) {
                member(options) = named(option, text, names);
            },
            [=](const Options& options) -> std::optional<std::string> {
                const std::optional<Value> value = member(options);
                if (!value) return std::nullopt;
                return name_of(*value, names);
            }};
}

/// A flag: true if it is given.
template <typename Options, typename Member>
[[nodiscard]] OptionRow<Options> flag_row(const char* name, std::string description, Member member) {
    return {name, "", std::move(description),
            [=](Options& options, const char*, const std::string&) { member(options) = true; },
            [=](const Options& options) -> std::optional<std::string> {
                if (!member(options)) return std::nullopt;
                return "";
            }};
}
/// @}

/// Adds an option whose text `parse` reads. An exception of `parse` ends the parsing.
CLI::Option* add_parsed_option(CLI::App& verb, const std::string& name, const std::string& value_name,
                               const std::string& description,
                               const std::function<void(const std::string&)>& parse);

/// Adds the options of a table to a verb. `options` must live until the command line has been read.
template <typename Options>
void add_table(CLI::App& verb, const OptionTable<Options>& table, Options& options,
               const std::string& group = "Options") {
    for (const OptionRow<Options>& row : table) {
        const std::string help = fmt::format(fmt::runtime(row.description),
                                             fmt::arg("default", row.print(options).value_or("none")));
        CLI::Option* option = nullptr;
        if (row.is_flag()) {
            option = verb.add_flag_callback(
                row.name, [&options, row] { row.parse(options, row.long_name().c_str(), ""); }, help);
        } else {
            option = add_parsed_option(verb, row.name, row.value_name, help,
                                       [&options, row](const std::string& text) {
                                           row.parse(options, row.long_name().c_str(), text);
                                       });
        }
        option->group(group);
    }
}

/// A word of a command line for a POSIX shell: bare if no character has a meaning for the shell, else quoted.
[[nodiscard]] std::string shell_word(std::string_view text);

/// The options of a table as part of a command line: " --name=value" for each that differs from `Options{}`.
template <typename Options>
[[nodiscard]] std::string command_line(const OptionTable<Options>& table, const Options& options) {
    const Options defaults{};
    std::string line;
    for (const OptionRow<Options>& row : table) {
        const std::optional<std::string> value = row.print(options);
        if (!value || value == row.print(defaults)) continue;
        line += " " + row.long_name();
        // With "=", a value may begin with a minus.
        if (!row.is_flag()) line += "=" + shell_word(*value);
    }
    return line;
}

}  // namespace cairn::app
