// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/contour.hpp>

#include <utility>

namespace isotet {

Result<Surface> contour(const Array& points, const Cells& cells, const Array& values, double isovalue, const Run& run) {
    ContourInput input;
    input.grid.points = points;
    input.grid.cells = cells;
    input.field.name = "values";
    input.field.values = values;
    ContourOptions options;
    options.surfaces = 1;
    options.expected_isovalues = {isovalue};
    Result<Contour> session = Contour::create(std::move(input), options, run);
    if (!session) return session.error();
    Result<ContourResult> result = session->extract(isovalue, run);
    if (!result) return result.error();
    return std::move(result->surfaces[0].surface);
}

} // namespace isotet
