// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/contour.hpp>

#include <algorithm>
#include <utility>

#include <isotet/fields.hpp>

namespace isotet {

Result<ContourInput> contour_input(const Grid& grid, const std::string& field, const std::vector<std::string>& carried,
                                   const Run& run) {
    Result<PointField> found = find_field(grid, field, {}, run);
    if (!found) return found.error();
    ContourInput input{grid, *std::move(found), {}, {}};
    for (const std::string& name : carried) {
        const auto add_of = [&](const std::vector<Field>& from, std::vector<Field>& to) {
            const auto at = std::ranges::find(from, name, &Field::name);
            if (at == from.end()) return false;
            to.push_back(*at);
            return true;
        };
        if (add_of(grid.point_fields, input.point_fields) || add_of(grid.cell_fields, input.cell_fields)) continue;
        Result<PointField> computed = find_field(grid, name, {}, run);
        if (!computed) return computed.error();
        input.point_fields.push_back({name, std::move(computed->values)});
    }
    return input;
}

} // namespace isotet
