#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace cairn::bench {

/// Nothing where a figure does not exist: a method without voxels has no error.
using Cell = std::variant<std::monostate, std::string, std::int64_t, double>;

struct Table {
    /// Named as in JSON: `..._ms` or `ms` are milliseconds.
    std::vector<std::string> columns;
    std::vector<std::vector<Cell>> rows;
    /// The table's file without its ending; for errors.
    std::string name = "table";

    /// @throws Error (Fault::internal) if the table has no such row or column: names the table, what was
    /// asked for, and the columns there are.
    [[nodiscard]] const Cell& at(std::size_t row, std::string_view column) const;
};

/// One row of a table, by the names and the types of its cells.
///
/// Every function throws Error (Fault::internal) as Table::at() does, or if the cell is of another type.
class Row {
public:
    /// `table` must outlive the row.
    Row(const Table& table, std::size_t row) : table_(&table), row_(row) {}

    [[nodiscard]] const std::string& text(std::string_view column) const;
    [[nodiscard]] std::int64_t whole(std::string_view column) const;
    /// A number of either type.
    [[nodiscard]] double number(std::string_view column) const;
    [[nodiscard]] bool is_empty(std::string_view column) const;

private:
    const Table* table_;
    std::size_t row_;
};

[[nodiscard]] std::vector<Row> rows_of(const Table& table);

/// Comma-separated, a line of names first; text in quotes where it needs them (RFC 4180).
[[nodiscard]] std::string csv_of(const Table& table);

}  // namespace cairn::bench
