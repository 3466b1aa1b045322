// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/extract_notes.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>

namespace isotet::jobs {

namespace {

/// As a program wrote it that has single precision, if it is of that.
std::string as_written(double value) {
    const auto single = static_cast<float>(value);
    return static_cast<double>(single) == value ? fmt::format("{}", single) : shortest(value);
}

/// An expression that has no value where a field has one of these; empty where the name cannot stand in one as it is.
std::string without_fill(const std::string& field, const FillValues& fill) {
    const auto is_plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == ':'; };
    if (!std::ranges::all_of(field, is_plain)) return {};
    const auto middle = [](double a, double b) { return fmt::format("{:.2g}", a / 2 + b / 2); };
    std::string condition;
    if (const double least = fill.numbers.front().value; least < fill.others.lower)
        condition = fmt::format("{} > {}", field, middle(least, fill.others.lower));
    if (const double most = fill.numbers.back().value; most > fill.others.upper)
        condition += fmt::format("{}{} < {}", condition.empty() ? "" : " && ", field, middle(fill.others.upper, most));
    return fmt::format("if({}, {}, 0/0)", condition, field);
}

} // namespace

const char* fill_is_of(const PointField& field) { return field.cell_fill.numbers.empty() ? "point" : "cell"; }

std::string fill_note(const std::string& field, const FillValues& fill, const char* of) {
    if (fill.numbers.empty()) return {};
    std::string list;
    for (const FillValues::Number& one : fill.numbers)
        list += fmt::format("{}{} {} {}", list.empty() ? "" : ", ", grouped(one.count), one.count == 1 ? "has" : "have",
                            as_written(one.value));
    const std::string expression = without_fill(field, fill);
    return fmt::format(
        "of the {} of '{}' {}, far from all others ({}), as where there is no value: isovalues are chosen "
        "without {}{}",
        counted(fill.values, of), field, list, rounded_range(fill.others.lower, fill.others.upper),
        fill.numbers.size() == 1 ? "it" : "them",
        expression.empty() ? ""
                           : fmt::format("; `field` '{}' {}", expression,
                                         std::string_view(of) == "cell" ? "takes means without these cells, too"
                                                                        : "leaves out the cells there, too"));
}

/// After the surfaces of a step: what was left out, and what rounding did.
void note_what_the_step_holds(const ExtractNumbers& numbers, const Grid& grid, std::uint64_t coarse_tets,
                              Caller& caller) {
    if (const std::string note = cells_left_out_note(grid, caller.run()); numbers.cells_left_out > 0 && !note.empty())
        caller.note(note);
    if (numbers.field.flushed > 0) {
        caller.note(fmt::format("{} of '{}' {} too small beside the others to be told from 0",
                                counted(numbers.field.flushed, "value"), numbers.field.name,
                                numbers.field.flushed == 1 ? "is" : "are"));
    }
    std::string where;
    if (numbers.pack && numbers.pack->coarse_clusters > 0)
        where = fmt::format("in {} of {} clusters", grouped(numbers.pack->coarse_clusters),
                            grouped(numbers.pack->clusters));
    else if (coarse_tets > 0) where = fmt::format("in {} active tets", grouped(coarse_tets));
    if (where.empty()) return;
    caller.note(
        where +
        " rounding to float32 moves points by over a thousandth of the shortest edge; `precision` double keeps them");
}

std::string why_empty(const FieldReport& field, double isovalue) {
    const std::string value = shortest(isovalue);
    if (!(field.lower <= field.upper))
        return fmt::format("isovalue {} gives no surface: field '{}' has no finite value", value, field.name);
    if (isovalue == field.lower)
        return fmt::format("{} is the smallest value of '{}': nothing is below it, the surface is empty", value,
                           field.name);
    const double beyond = std::max(field.lower - isovalue, isovalue - field.upper);
    double apart = (field.upper - field.lower) / 1000;
    if (beyond > 0 && (beyond < apart || apart == 0)) apart = beyond;
    const std::string range = fmt::format("the range of '{}', {} to {}", field.name, rounded(field.lower, apart),
                                          rounded(field.upper, apart));
    if (beyond > 0) return fmt::format("isovalue {} is outside {}: the surface is empty", value, range);
    return fmt::format("isovalue {} is within {}, but no tet has values on both sides of it: the surface is empty",
                       value, range);
}

std::string why_all_are_empty(const FieldReport& field, std::span<const double> isovalues,
                              std::optional<double> decimal_comma) {
    const auto is_outside = [&](double value) { return !(value >= field.lower && value <= field.upper); };
    const auto gives_none = [&](double value) { return is_outside(value) || value == field.lower; };
    if (!(field.lower <= field.upper) || !std::ranges::all_of(isovalues, gives_none) ||
        std::ranges::none_of(isovalues, is_outside))
        return {};
    std::string sentence = why_empty(field, isovalues.front());
    if (isovalues.size() == 2) sentence += ", and so is the other one";
    if (isovalues.size() > 2) sentence += fmt::format(", and so are the other {}", isovalues.size() - 1);
    if (decimal_comma && !is_outside(*decimal_comma))
        sentence += fmt::format("; did you mean {}? Commas separate isovalues", shortest(*decimal_comma));
    return sentence;
}

std::string why_solid_is_empty(const FieldReport& field, const SolidRange& range) {
    const std::string values = std::isinf(range.upper) ? fmt::format("{} or more", shortest(range.lower))
                               : std::isinf(range.lower)
                                   ? fmt::format("below {}", shortest(range.upper))
                                   : fmt::format("from {} to {}", shortest(range.lower), shortest(range.upper));
    const std::string has =
        field.lower <= field.upper ? rounded_range(field.lower, field.upper) : std::string("no finite value");
    return fmt::format("the solid is empty: it has values of '{}' {}, but the field has {}", field.name, values, has);
}

void note_what_a_solid_is(const ExtractNumbers& numbers, const SurfaceNumbers& surface, Caller& caller) {
    const SolidRange& range = surface.solid->range;
    if (surface.triangles == 0) caller.note(why_solid_is_empty(numbers.field, range));
    if (surface.solid->seam_edges > 0)
        caller.note(fmt::format(
            "the grid's boundary is open to itself: points are doubled, so the isosurface has {} open edges "
            "inside the grid, and walls close the solid there; `merge_points` 0 makes it one body",
            grouped(surface.solid->seam_edges)));
    if (surface.solid->unfit_edges > 0)
        caller.note(
            fmt::format("the grid's boundary is open to itself: cells of different sizes do not fit together, so the "
                        "isosurface has {} open edges inside the grid, and walls close the solid there; hanging points "
                        "that cover the larger face are joined by `hanging_points` close, others need another mesh",
                        grouped(surface.solid->unfit_edges)));
    if (surface.solid->open_edges > 0)
        caller.note(
            fmt::format("the solid is open at {} edges, as where cells are repeated: isotet info `survey` counts "
                        "these",
                        grouped(surface.solid->open_edges)));
}

void note_what_extracting_found(const ExtractNumbers& numbers, const SurfaceNumbers& surface, Caller& caller) {
    const FieldReport& field = numbers.field;
    if (surface.triangles == 0) caller.note(why_empty(field, surface.isovalue));
    if (const std::uint64_t ties = surface.report.false_ties.value_or(0); ties > 0) {
        const bool double_helps = numbers.precision == Precision::float32 && !field.unchanged;
        caller.note(fmt::format("isovalue {}: {} point{} tied (equal to it) only by rounding{}",
                                shortest(surface.isovalue), grouped(ties), ties == 1 ? " is" : "s are",
                                double_helps ? "; `precision` double keeps them apart" : ""));
    }
    if (surface.report.near_tie) {
        caller.note(fmt::format(
            "no point has the value {}, but points have the nearest one that the type of '{}' can hold; `snap` "
            "takes that",
            shortest(surface.isovalue), field.name));
    }
}

} // namespace isotet::jobs
