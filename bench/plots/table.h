#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace cairn::bench {

/// Nothing where a figure does not exist: a method without voxels has no error.
using Cell = std::variant<std::monostate, std::string, std::int64_t, double>;

struct Table {
    std::vector<std::string> columns;  ///< named as in JSON: `..._ms` or `ms` are milliseconds
    std::vector<std::vector<Cell>> rows;
};

/// Comma-separated, a line of names first; text in quotes where it needs them (RFC 4180).
[[nodiscard]] std::string csv_of(const Table& table);

}  // namespace cairn::bench
