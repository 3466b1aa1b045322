// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "read_field.hpp"

#include <utility>

#include <fmt/format.h>

#include "field_choice.hpp"
#include "varied_field.hpp"

namespace isotet::cli {

Result<PointField> read_field(const GridSource& source, std::size_t step, const FieldChoice& choice,
                              const std::string& beside, int threads, Console& console, Grid& grid) {
    FieldsToRead read;
    std::string name = choice.name;
    const std::size_t fields = source.info().fields.size();
    if (!name.empty() || fields <= 1) {
        const Result<FoundField> found = choose_field(source, choice);
        if (!found) return found.error();
        name = found->name;
        read = {found->point, found->cell};
        if (!beside.empty()) {
            const Result<FoundField> other = choose_field(source, {beside, false});
            if (!other) return other.error();
            add_names(*read.point, other->point);
            add_names(*read.cell, other->cell);
        }
    }
    Result<Grid> all = source.read(read, step, console);
    if (!all) return all.error();
    grid = *std::move(all);
    if (name.empty()) {
        name = most_varied_field(grid);
        if (name.empty()) {
            return Error{ErrorCode::invalid_data,
                         fmt::format("none of the {} fields has two different values: there is nothing to contour; "
                                     "-f x, y or z contours a coordinate",
                                     fields)};
        }
        console.note(fmt::format("no field was named: '{}', which varies most, was taken; -f names another", name));
    }
    const auto prefer = choice.cell_field ? Association::cell : Association::point;
    Result<PointField> field = find_field(grid, name, {prefer}, {threads, {}});
    if (field) console.note(field->note);
    return field;
}

} // namespace isotet::cli
