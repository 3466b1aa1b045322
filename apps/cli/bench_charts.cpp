// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <fmt/format.h>

#include "bench_report.hpp"
#include "chart.hpp"

namespace isotet::cli {

namespace {

/// Figure 4 as far as its text has numbers: GPU(R) on a card of 256 MB. It gives GPU(T) twice the speed of the CPU,
/// both constant up to 5 million tets, but no number for them.
ChartLine registers_in_the_paper() {
    return {"GPU(R) in the paper, 2006", {{1e5, 6.7e6}, {6e5, 6.7e6}, {1e6, 4e6}}, true};
}

std::string name_in_chart(const BenchPair& pair) {
    std::string name = pair.name();
    if (pair.method == BenchMethod::registers) name += ", GPU(R)";
    if (pair.method == BenchMethod::textures) name += ", GPU(T)";
    return name;
}

/// Tets a second against tets.
void add_sizes(Chart& chart, const std::vector<BenchRow>& rows) {
    for (const BenchRow& row : rows) {
        const std::string name = name_in_chart(row.pair);
        auto line = std::ranges::find(chart.lines, name, &ChartLine::name);
        if (line == chart.lines.end()) line = chart.lines.insert(line, {name, {}, false});
        if (row.missing.empty()) line->points.push_back({static_cast<double>(row.tets), row.tets_per_second()});
    }
}

/// Seconds against surfaces of the one grid.
void add_surfaces(Chart& chart, const std::vector<BenchRow>& rows) {
    for (const BenchRow& row : rows) {
        ChartLine line{row.pair.name(), {}, false};
        for (double surfaces = 1; surfaces <= 10'000 && row.missing.empty(); surfaces *= 10)
            line.points.push_back({surfaces, row.costs.prepare_seconds + surfaces * row.median.total()});
        chart.lines.push_back(std::move(line));
    }
}

} // namespace

std::string bench_svg(const BenchNumbers& numbers) {
    Chart chart;
    const std::string device = numbers.device ? numbers.device->name : "no device";
    chart.subtitle = fmt::format("{}; {} thread{}", device, numbers.threads, numbers.threads == 1 ? "" : "s");
    if (numbers.command->paper) {
        chart.title = "Isovalue to picture, as Figure 4 of Buatois, Caumon, Lévy (2006)";
        chart.x_title = "tets of the grid";
        chart.y_title = "tets a second";
        add_sizes(chart, numbers.rows);
        chart.lines.push_back(registers_in_the_paper());
    } else {
        chart.title = numbers.rows.empty() ? "" : fmt::format("{}: {}", numbers.rows.front().grid, numbers.field);
        chart.x_title = "surfaces";
        chart.y_title = "seconds in all, with preparing";
        add_surfaces(chart, numbers.rows);
    }
    return chart.svg();
}

} // namespace isotet::cli
