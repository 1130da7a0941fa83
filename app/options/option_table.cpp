#include "app/options/option_table.h"

#include <algorithm>

namespace cairn::app {

CLI::Option* add_parsed_option(CLI::App& verb, const std::string& name, const std::string& value_name,
                               const std::string& description,
                               const std::function<void(const std::string&)>& parse) {
    return verb.add_option_function<std::string>(name, parse, description)->type_name(value_name);
}

std::string shell_word(std::string_view text) {
    const auto plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               std::string_view("_-+=./:,@%").find(c) != std::string_view::npos;
    };
    if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return std::string(text);
    std::string word = "'";
    for (const char c : text)
        word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

}  // namespace cairn::app
