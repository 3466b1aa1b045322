// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "output/info_chart.hpp"

#include <isotet/jobs/number_text.hpp>

#include "output/report.hpp"

namespace isotet::cli {

std::string chart_table(const FieldChart& chart) {
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

Json json_of(const FieldChart& chart) {
    const ContourSpectrum& spectrum = chart.spectrum;
    return {{"field", json_text(chart.field)},       {"isovalues", spectrum.isovalues}, {"area", spectrum.area},
            {"volume_below", spectrum.volume_below}, {"volume", spectrum.volume},       {"tets", spectrum.tets},
            {"no_data_tets", spectrum.no_data_tets}};
}

} // namespace isotet::cli
