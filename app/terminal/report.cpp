#include "app/terminal/report.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>

#include "app/terminal/terminal.h"
#include "base/error.h"
#include "base/output_file.h"

namespace cairn::app {
namespace {

constexpr int label_width = 20;

bool ends_in(std::string_view key, std::string_view unit) {
    return key == unit.substr(1) || key.ends_with(unit);
}

/// "brick_pool_bytes" becomes "brick pool".
std::string label_of(std::string_view key) {
    for (const std::string_view unit : {"_ms", "_bytes"}) {
        if (key.ends_with(unit)) key.remove_suffix(unit.size());
    }
    std::string label(key == "milliseconds" ? "time" : key);
    std::replace(label.begin(), label.end(), '_', ' ');
    return label;
}

std::string text_of(std::string_view key, const Json& value) {
    if (value.is_null()) return "none";
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    if (value.is_string()) {
        const std::string text = printable(value.get<std::string>());
        return text.empty() ? "\"\"" : text;
    }
    if (value.is_number() && (ends_in(key, "_ms") || key == "milliseconds")) {
        return fmt::format("{:.{}f} ms", value.get<double>(), value.get<double>() < 10.0 ? 2 : 1);
    }
    if (value.is_number() && ends_in(key, "_bytes"))
        return fmt::format("{:.1f} MiB", value.get<double>() / 0x1p20);
    if (value.is_number_float()) return fmt::format("{:.9g}", value.get<double>());
    if (!value.is_structured()) return value.dump();
    std::string joined;
    for (const auto& [name, item] : value.items()) {
        if (!joined.empty()) joined += ", ";
        if (value.is_object()) joined += label_of(name) + " ";
        joined += text_of(value.is_object() ? name : key, item);
    }
    return joined.empty() ? "none" : joined;
}

bool is_list_of_objects(const Json& value) {
    return value.is_array() && !value.empty() && value[0].is_object();
}

std::string as_text(const Json& figures) {
    std::string text;
    for (const auto& [key, value] : figures.items()) {
        std::string label = label_of(key);
        for (const Json& line : is_list_of_objects(value) ? value : Json::array({value})) {
            text += fmt::format("{:<{}}{}\n", label, label_width, text_of(key, line));
            label.clear();  // only the first line of a list has a label
        }
    }
    return text;
}

void print(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
        throw Error(Fault::usage, "stdout", std::string("cannot write: ") + std::strerror(errno));
    }
}

}  // namespace

void Report::finish() const {
    // Names come from files: bytes that are not UTF-8 are replaced, because dump() would throw.
    const std::string json = figures_.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    if (options_.json == "-") {
        print(json);
        return;
    }
    if (options_.json) {
        OutputFile file(*options_.json);
        file.write(json.data(), json.size());
        file.commit();
    }
    if (!options_.quiet) print(as_text(figures_));
}

}  // namespace cairn::app
