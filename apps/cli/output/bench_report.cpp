// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "output/bench_report.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>

#include "output/report.hpp"

namespace isotet::cli {

namespace {

std::string milliseconds(double seconds) { return fmt::format("{:.2f}", 1e3 * seconds); }

std::string count_or_nothing(std::optional<std::uint64_t> count) { return count ? grouped(*count) : ""; }

Json count_or_null(std::optional<std::uint64_t> count) { return count ? Json(*count) : Json(nullptr); }

Table rows_table(const BenchJob& job, const BenchNumbers& numbers) {
    using enum Table::Align;
    Table table({left, right, right, right, right, right, right, right, right, right, right, right, right});
    table.row({job.paper ? "tets, method" : "method", "prepare", "stays here", "on the device", "tets cut", "triangles",
               "bytes sent", "search, ms", "extract, ms", numbers.device ? "draw, ms" : "", "all, ms", "best, ms",
               "tets a second"});
    for (const BenchRow& row : numbers.rows) {
        const std::string name = job.paper ? fmt::format("{} {}", grouped(row.tets), row.pair.name()) : row.pair.name();
        if (!row.missing.empty()) {
            table.row({name, "not measured"});
            continue;
        }
        table.row({name, seconds_text(row.costs.prepare_seconds), format_bytes(row.costs.host_bytes),
                   format_bytes(row.costs.device_bytes), count_or_nothing(row.outcome.tets_looked_at),
                   count_or_nothing(row.outcome.triangles), grouped(row.outcome.sent_bytes + row.costs.crossing_bytes),
                   milliseconds(row.median.search), milliseconds(row.median.extract),
                   numbers.device ? milliseconds(row.median.draw) : "", milliseconds(row.median.total()),
                   milliseconds(row.best.total()), grouped(static_cast<std::uint64_t>(row.tets_per_second()))});
    }
    return table;
}

/// Why rows are missing, a line each.
std::string missing_text(const BenchNumbers& numbers) {
    std::string text;
    for (const BenchRow& row : numbers.rows)
        if (!row.missing.empty())
            text += fmt::format("not measured: {} on {}: {}\n", row.pair.name(), row.grid, row.missing);
    return text;
}

std::string advice_text(const BenchNumbers& numbers) {
    std::string text;
    double from = 1;
    for (const BenchAdvice& one : advice_of(numbers.rows)) {
        const std::string range = std::isinf(one.upto)
                                      ? fmt::format("from {:.0f} surface{} on", from, from == 1 ? "" : "s")
                                      : fmt::format("up to {:.0f} surface{}", one.upto, one.upto == 1 ? "" : "s");
        text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", range, numbers.rows[one.row].pair.name());
        from = one.upto + 1;
    }
    return text.empty() ? "nothing was measured" : text;
}

std::string gains_text(const std::vector<BenchRow>& rows) {
    std::string text;
    for (const BenchMethod method : all_bench_methods)
        if (const std::optional<double> gain = gain_of_interval_tree(rows, method))
            text += fmt::format("{}{} {:.2f} times as fast", text.empty() ? "" : ", ", name_of(method), *gain);
    return text;
}

Json json_of(const BenchTimes& times) {
    return {{"search", times.search}, {"extract", times.extract}, {"draw", times.draw}, {"all", times.total()}};
}

} // namespace

std::string bench_table(const BenchJob& job, const BenchNumbers& numbers) {
    Table table = facts();
    if (job.paper) table.row({"grids", "regular, six tets a cube (make:kuhn), field gyroid"});
    else if (!numbers.rows.empty()) {
        table.row({"grid", numbers.rows.front().grid});
        const BenchRow& first = numbers.rows.front();
        table.row({"tets", first.dropped_tets == 0 ? grouped(first.tets)
                                                   : fmt::format("{}, {} repeated or collapsed ones dropped",
                                                                 grouped(first.tets), grouped(first.dropped_tets))});
        table.row({"field", numbers.field});
    }
    std::string isovalues;
    for (const double isovalue : numbers.isovalues) isovalues += (isovalues.empty() ? "" : ", ") + shortest(isovalue);
    table.row({"isovalues", isovalues});
    table.row({"threads", std::to_string(numbers.threads)});
    table.row({"device", numbers.device
                             ? fmt::format("{} ({}); pictures of {} x {}", numbers.device->name,
                                           name_of(numbers.device->kind), bench_picture().width, bench_picture().height)
                             : "none: nothing is drawn"});
    const std::string gains = gains_text(numbers.rows);
    std::string text = table.text() + "\n" + rows_table(job, numbers).text() + "\n" + missing_text(numbers);
    if (!job.paper) text += "fastest: " + advice_text(numbers) + "\n";
    if (!gains.empty())
        text += fmt::format("with the interval tree: {}{}\n", gains, job.paper ? ", the mean over the grids" : "");
    return text;
}

Json bench_json(const BenchJob& job, const BenchNumbers& numbers) {
    Json report = json_report("bench");
    report["paper"] = job.paper;
    report["field"] = json_text(numbers.field);
    report["isovalues"] = numbers.isovalues;
    report["threads"] = numbers.threads;
    report["device"] = nullptr;
    if (numbers.device)
        report["device"] = {{"name", json_text(numbers.device->name)}, {"kind", name_of(numbers.device->kind)}};
    Json rows = Json::array();
    for (const BenchRow& row : numbers.rows) {
        Json one = {{"grid", json_text(row.grid)},
                    {"tets", row.tets},
                    {"dropped_tets", row.dropped_tets},
                    {"points", row.points},
                    {"method", name_of(row.pair.method)},
                    {"index", draw_method_of(row.pair.method) ? Json(name_of(row.pair.index)) : Json(nullptr)}};
        one["missing"] = row.missing.empty() ? Json(nullptr) : json_text(row.missing);
        if (row.missing.empty()) {
            one["prepare_seconds"] = row.costs.prepare_seconds;
            one["bytes"] = {{"host", row.costs.host_bytes},
                            {"device", row.costs.device_bytes},
                            {"crossing", row.costs.crossing_bytes},
                            {"sent", row.outcome.sent_bytes}};
            one["tets_looked_at"] = count_or_null(row.outcome.tets_looked_at);
            one["triangles"] = count_or_null(row.outcome.triangles);
            one["seconds"] = json_of(row.median);
            one["best_seconds"] = json_of(row.best);
            one["tets_per_second"] = row.tets_per_second();
        }
        rows.push_back(std::move(one));
    }
    report["rows"] = std::move(rows);
    Json advice = Json::array();
    if (!job.paper)
        for (const BenchAdvice& one : advice_of(numbers.rows))
            advice.push_back(
                {{"row", one.row}, {"up_to_surfaces", std::isinf(one.upto) ? Json(nullptr) : Json(one.upto)}});
    report["advice"] = std::move(advice);
    Json gains = Json::object();
    for (const BenchMethod method : all_bench_methods)
        if (const std::optional<double> gain = gain_of_interval_tree(numbers.rows, method))
            gains[name_of(method)] = *gain;
    report["gain_of_interval_tree"] = std::move(gains);
    return report;
}

} // namespace isotet::cli
