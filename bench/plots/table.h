#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace cairn::bench {

/// A cell of a table. It holds nothing if there is no such figure: a method without voxels has no error.
using Cell = std::variant<std::monostate, std::string, std::int64_t, double>;

struct Table {
    /// Names of the columns, as in JSON: `..._ms` or `ms` are milliseconds.
    std::vector<std::string> columns;
    std::vector<std::vector<Cell>> rows;
    /// Name of the table's file without its ending, also for errors.
    std::string name = "table";

    /// @throws Error (Fault::internal) if the table has no such row or column. The error names the table, the
    /// row or column, and the columns of the table.
    [[nodiscard]] const Cell& at(std::size_t row, std::string_view column) const;
};

/// One row of a table, read by columns' names and with cells' types.
///
/// Every function throws Error (Fault::internal) as Table::at() does, and if the cell is of another type.
class Row {
public:
    /// `table` must outlive the row.
    Row(const Table& table, std::size_t row) : table_(&table), row_(row) {}

    [[nodiscard]] const std::string& text(std::string_view column) const;
    [[nodiscard]] std::int64_t whole(std::string_view column) const;
    /// A number, whole or not.
    [[nodiscard]] double number(std::string_view column) const;
    [[nodiscard]] bool is_empty(std::string_view column) const;

private:
    const Table* table_;
    std::size_t row_;
};

[[nodiscard]] std::vector<Row> rows_of(const Table& table);

/// The table as comma-separated values (RFC 4180): a line of names first; texts are quoted if they need it.
[[nodiscard]] std::string csv_of(const Table& table);

}  // namespace cairn::bench
