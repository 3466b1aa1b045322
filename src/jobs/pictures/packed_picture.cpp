// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/pictures/packed_picture.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <isotet/text.hpp>

namespace isotet::jobs {

bool needs_cells(const DrawJob& job) {
    const bool shares = !job.shares.empty() || job.sweep_shares.lower || job.sweep_shares.upper;
    return shares || !job.stretch.empty() || job.solid || job.contour.split_cells || !job.dirac_shares.empty() ||
           job.method.draw || job.method.extract == Method::direct || job.engine == EngineChoice::vulkan ||
           job.grid.merge_points || !job.grid.displace.empty() || !job.grid.blocks.empty() || !job.grid.cells.empty();
}

std::string note_of_unpacking(const PackedFileInfo& file) {
    return fmt::format(
        "all of the packed file is read and unpacked, which takes {} of memory: what was asked for needs its "
        "cells, or is not packed",
        format_bytes(file.unpacked_bytes));
}

const PackedFieldInfo* packed_field(const PackedFileInfo& file, std::string_view name, std::size_t step,
                                    bool with_gradients) {
    const auto found = std::ranges::find_if(file.fields, [&](const PackedFieldInfo& field) {
        return field.step == step && field.report.name == name && (field.gradients || !with_gradients);
    });
    return found == file.fields.end() ? nullptr : &*found;
}

Result<FoundColors> colors_of_report(const FieldReport& report, const ColorOptions& options, const Run& run) {
    std::vector<double> ends;
    if (report.lower <= report.upper) ends = {report.lower, report.upper};
    if (report.no_data > 0 || ends.empty()) ends.push_back(NAN);
    Grid grid;
    grid.points = Array::own(std::vector<double>(3 * ends.size()), 3);
    grid.point_fields = {{report.name, Array::own(std::move(ends))}};
    return find_colors(grid, report.name, options, run);
}

} // namespace isotet::jobs
