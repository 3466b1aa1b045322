// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "info_chart.hpp"

#include <isotet/jobs/field_choice.hpp>
#include <isotet/jobs/number_text.hpp>

#include "report.hpp"

namespace isotet::cli {

Result<std::optional<InfoChart>> make_chart(const InfoCommand& command, const Grid& grid, Console& console) {
    if (!command.chart) return std::optional<InfoChart>();
    std::string name = command.field.name;
    if (name.empty()) name = default_field(grid).name;
    if (name.empty())
        return Error{
            ErrorCode::invalid_data,
            "no field has two different values: there is nothing to chart; `field` x, y or z charts a coordinate"};
    const Result<PointField> field = find_chosen(grid, name, command.field, console);
    if (!field) return field.error();
    Result<ContourSpectrum> spectrum = contour_spectrum_over_range(grid, *field, *command.chart, console.run());
    if (!spectrum) return spectrum.error();
    return std::optional(InfoChart{name, *std::move(spectrum)});
}

std::string chart_table(const InfoChart& chart) {
    using enum Table::Align;
    const ContourSpectrum& spectrum = chart.spectrum;
    Table table({right, right, right});
    table.row({chart.field, "area", "volume below"});
    const std::vector<std::string> isovalues = told_apart(spectrum.isovalues);
    for (std::size_t i = 0; i < isovalues.size(); ++i)
        table.row({isovalues[i], rounded(spectrum.area[i]), rounded(spectrum.volume_below[i])});
    Table total = facts();
    total.row({"volume", rounded(spectrum.volume)});
    if (spectrum.no_data_tets > 0) total.row({"tets without data", grouped(spectrum.no_data_tets)});
    return table.text() + total.text();
}

Json json_of(const InfoChart& chart) {
    const ContourSpectrum& spectrum = chart.spectrum;
    return {{"field", json_text(chart.field)},       {"isovalues", spectrum.isovalues}, {"area", spectrum.area},
            {"volume_below", spectrum.volume_below}, {"volume", spectrum.volume},       {"tets", spectrum.tets},
            {"no_data_tets", spectrum.no_data_tets}};
}

} // namespace isotet::cli
