// SPDX-License-Identifier: Apache-2.0
// Reads the text tables under tables/: one row a line, columns between bars, the first row names them, # begins a
// comment.
#pragma once

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace dpchip::checks {

/// One row; cells are found by the name of their column.
class Row {
public:
    Row(const std::vector<std::string>& columns, std::vector<std::string> cells, int line)
        : columns_{&columns}, cells_{std::move(cells)}, line_{line} {}
    const std::string& operator[](std::string_view column) const {
        for (std::size_t i = 0; i < columns_->size(); ++i)
            if ((*columns_)[i] == column) return cells_.at(i);
        throw std::out_of_range{"no column " + std::string{column}};
    }
    int line() const { return line_; }

private:
    const std::vector<std::string>* columns_;
    std::vector<std::string> cells_;
    int line_;
};

/// Words of a cell, separated by blanks. A dash is no word.
inline std::vector<std::string> words(const std::string& cell) {
    std::vector<std::string> out;
    for (std::size_t i = 0; i < cell.size();) {
        const std::size_t end = std::min(cell.find(' ', i), cell.size());
        if (end > i && cell.substr(i, end - i) != "-") out.push_back(cell.substr(i, end - i));
        i = end + 1;
    }
    return out;
}

/// A table as read from its file. Throws std::runtime_error when the file is missing or a row has the wrong width.
class TextTable {
public:
    explicit TextTable(const std::string& path) : path_{path} {
        std::ifstream in{path};
        if (!in) throw std::runtime_error{"cannot read " + path};
        std::string line;
        for (int number = 1; std::getline(in, line); ++number) add(line.substr(0, line.find('#')), number);
    }
    TextTable(const TextTable&) = delete;
    TextTable& operator=(const TextTable&) = delete;
    const std::vector<Row>& rows() const { return rows_; }

private:
    static std::string trimmed(std::string_view s) {
        const std::size_t begin = s.find_first_not_of(" \t\r");
        if (begin == std::string_view::npos) return {};
        return std::string{s.substr(begin, s.find_last_not_of(" \t\r") - begin + 1)};
    }
    void add(const std::string& line, int number) {
        if (trimmed(line).empty()) return;
        std::vector<std::string> cells;
        for (std::size_t i = 0; i <= line.size();) {
            const std::size_t end = std::min(line.find('|', i), line.size());
            cells.push_back(trimmed(std::string_view{line}.substr(i, end - i)));
            i = end + 1;
        }
        if (columns_.empty()) {
            columns_ = std::move(cells);
            return;
        }
        if (cells.size() != columns_.size())
            throw std::runtime_error{path_ + ":" + std::to_string(number) + ": wrong number of columns"};
        rows_.emplace_back(columns_, std::move(cells), number);
    }

    std::string path_;
    std::vector<std::string> columns_;
    std::vector<Row> rows_;
};

}  // namespace dpchip::checks
