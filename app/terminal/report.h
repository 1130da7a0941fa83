#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "app/options/options.h"

namespace cairn::app {

using Json = nlohmann::ordered_json;

/// The figures of one run. The text on stdout and the JSON are made of the same entries, so that neither
/// shows what the other hides.
///
/// The end of a key is its unit: `..._ms` milliseconds, `..._bytes` bytes (shown as MiB in the text).
class Report {
public:
    explicit Report(const ReportOptions& options) : options_(options) {}

    void add(const std::string& key, Json value) { figures_[key] = std::move(value); }

    /// Prints the text and writes the JSON.
    /// @throws Error (Fault::usage) if either cannot be written.
    void finish() const;

private:
    ReportOptions options_;
    Json figures_ = Json::object();
};

/// A glm vector as [x, y, z].
template <typename Vector>
[[nodiscard]] Json json_of(const Vector& v) {
    Json array = Json::array();
    for (int i = 0; i < Vector::length(); ++i)
        array.push_back(v[i]);
    return array;
}

}  // namespace cairn::app
