#include "bench/plots/table.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"

namespace cairn::bench {
namespace {

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text)
        out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + '"';
}

std::string text_of(const Cell& cell) {
    if (const auto* text = std::get_if<std::string>(&cell)) return quoted(*text);
    if (const auto* whole = std::get_if<std::int64_t>(&cell)) return fmt::format("{}", *whole);
    if (const auto* number = std::get_if<double>(&cell)) return fmt::format("{:.6g}", *number);
    return {};
}

[[noreturn]] void refuse_type(const Table& table, std::string_view column, const char* wanted) {
    throw Error(Fault::internal, table.name, fmt::format("a cell of \"{}\" is no {}", column, wanted));
}

}  // namespace

const Cell& Table::at(std::size_t row, std::string_view column) const {
    const auto found = std::find(columns.begin(), columns.end(), column);
    if (found == columns.end()) {
        throw Error(Fault::internal, name,
                    fmt::format("there is no column \"{}\" among {}", column, fmt::join(columns, ", ")));
    }
    const auto place = std::size_t(found - columns.begin());
    if (row >= rows.size() || place >= rows[row].size()) {
        throw Error(Fault::internal, name,
                    fmt::format("row {} of {} has no \"{}\" of {}", row, rows.size(), column,
                                fmt::join(columns, ", ")));
    }
    return rows[row][place];
}

const std::string& Row::text(std::string_view column) const {
    const auto* const text = std::get_if<std::string>(&table_->at(row_, column));
    if (text == nullptr) refuse_type(*table_, column, "text");
    return *text;
}

std::int64_t Row::whole(std::string_view column) const {
    const auto* const whole = std::get_if<std::int64_t>(&table_->at(row_, column));
    if (whole == nullptr) refuse_type(*table_, column, "whole number");
    return *whole;
}

double Row::number(std::string_view column) const {
    const Cell& cell = table_->at(row_, column);
    if (const auto* const whole = std::get_if<std::int64_t>(&cell)) return double(*whole);
    const auto* const number = std::get_if<double>(&cell);
    if (number == nullptr) refuse_type(*table_, column, "number");
    return *number;
}

bool Row::is_empty(std::string_view column) const {
    return table_->at(row_, column).index() == 0;
}

std::vector<Row> rows_of(const Table& table) {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < table.rows.size(); ++i)
        rows.emplace_back(table, i);
    return rows;
}

std::string csv_of(const Table& table) {
    std::string out;
    for (std::size_t i = 0; i < table.columns.size(); ++i)
        out += (i == 0 ? "" : ",") + table.columns[i];
    out += '\n';
    for (const std::vector<Cell>& row : table.rows) {
        for (std::size_t i = 0; i < row.size(); ++i)
            out += (i == 0 ? "" : ",") + text_of(row[i]);
        out += '\n';
    }
    return out;
}

}  // namespace cairn::bench
