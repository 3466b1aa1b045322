// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Tables for people.
#pragma once

#include <string>
#include <vector>

namespace isotet::cli {

/// Rows of text in aligned columns. Cells may hold names from files: they are escaped.
class Table {
public:
    enum class Align { left, right };

    /// One column for each entry.
    explicit Table(std::vector<Align> columns) : columns_(std::move(columns)) {}

    /// A row; missing cells are empty, as many as there are columns count.
    void row(std::vector<std::string> cells);
    bool empty() const noexcept { return rows_.empty(); }

    /// All rows, each with its newline, without spaces at line ends.
    std::string text() const;

private:
    std::vector<Align> columns_;
    std::vector<std::vector<std::string>> rows_;
};

/// Names on the left, values on the right: the head of every report.
inline Table facts() { return Table({Table::Align::left, Table::Align::left}); }

} // namespace isotet::cli
