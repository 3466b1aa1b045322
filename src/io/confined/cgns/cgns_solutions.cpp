// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/cgns/cgns_solutions.hpp"

#include <algorithm>
#include <set>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "io/files/escape.hpp"
#include "io/reader.hpp"

namespace isotet::io::confined {
namespace {

/// Values of elements of all dimensions: those of the cells.
Array values_of_cells(const Array& values, const CgnsCells& cells) {
    return values.visit([&](auto all) {
        std::vector<std::remove_const_t<typename decltype(all)::value_type>> kept;
        for (const CgnsCells::Numbers& run : cells.numbers) {
            const auto from = all.begin() + (run.first - 1);
            kept.insert(kept.end(), from, from + static_cast<std::ptrdiff_t>(run.count));
        }
        return Array::own(std::move(kept));
    });
}

bool numbers_fit(const CgnsCells& cells) {
    return !cells.numbers.empty() && std::ranges::all_of(cells.numbers, [&](const CgnsCells::Numbers& run) {
        return static_cast<std::uint64_t>(run.first - 1) + run.count <= cells.elements;
    });
}

} // namespace

CgnsSolutions::CgnsSolutions(const CgnsTree& tree, const CgnsZone& zone, std::size_t steps, const CgnsCounts& counts)
    : tree_(tree), zone_(zone), steps_(steps), counts_(counts) {
    for (const char* label : {"FlowSolution_t", "DiscreteData_t"}) // a solution keeps its names
        for (const CgnsNode& node : zone.parts)
            if (node.label == label) add(node);
    read_pointers();
}

void CgnsSolutions::add(const CgnsNode& node) {
    Solution solution{node, tree_.children(node), Association::point, {}};
    const auto place = child_labelled(solution.parts, "GridLocation_t");
    const std::string location = place ? tree_.text(*place) : "Vertex";
    if (location.starts_with("CellCenter")) solution.association = Association::cell;
    else if (!location.starts_with("Vertex"))
        solution.problem = fmt::format("its values are at \"{}\"", escaped(location));
    if (child_named(solution.parts, "PointList") || child_named(solution.parts, "PointRange"))
        solution.problem = "it has values of a part of the zone only";
    solutions_.push_back(std::move(solution));
}

void CgnsSolutions::read_pointers() {
    constexpr std::size_t letters_of_name = 32;
    const auto iterative = child_labelled(zone_.parts, "ZoneIterativeData_t");
    if (!iterative || steps_ == 0) return;
    for (const CgnsNode& node : tree_.children(*iterative)) {
        if (node.label != "DataArray_t") continue;
        std::vector<std::string> names = tree_.texts(node, letters_of_name);
        names.resize(steps_);
        if (node.name == "GridCoordinatesPointers") coordinates_ = names;
        if (node.name.ends_with("SolutionPointers")) pointers_.push_back(std::move(names));
    }
}

std::string CgnsSolutions::coordinates_at(std::size_t step) const {
    return step < coordinates_.size() ? coordinates_[step] : std::string();
}

bool CgnsSolutions::holds(const Solution& solution, std::size_t step) const {
    bool named = false, any_named = false;
    for (const std::vector<std::string>& names : pointers_) {
        if (step < names.size() && names[step] == solution.node.name) return true;
        named = named || std::ranges::find(names, solution.node.name) != names.end();
        for (const Solution& other : solutions_)
            any_named = any_named || std::ranges::find(names, other.node.name) != names.end();
    }
    if (named) return false;
    if (any_named) return true; // of all steps
    std::vector<std::string> alike;
    for (const Solution& other : solutions_)
        if (other.association == solution.association && other.node.label == solution.node.label &&
            other.problem.empty())
            alike.push_back(other.node.name);
    return steps_ < 2 || alike.size() != steps_ || !solution.problem.empty() || alike[step] == solution.node.name;
}

std::vector<std::uint64_t> CgnsSolutions::size_for(const Solution& solution) const {
    if (solution.association == Association::point) return zone_.points;
    if (zone_.is_structured) return zone_.cells;
    return {counts_.cells};
}

std::string CgnsSolutions::problem_of(const Solution& solution, const CgnsNode& node, ScalarType& type) const {
    const auto shape = tree_.shape(node);
    if (!shape) return "it cannot be read";
    if (!shape->scalar) return fmt::format("it is of type \"{}\"", escaped(shape->type));
    type = *shape->scalar;
    if (!solution.problem.empty()) return solution.problem;
    const std::uint64_t needed = count_with_rind(tree_, solution.parts, size_for(solution));
    const bool of_elements =
        solution.association == Association::cell && !zone_.is_structured && shape->count == counts_.elements;
    if (shape->count == needed || of_elements) return {};
    return fmt::format("there are {} values, but {} are needed", shape->count, needed);
}

std::vector<CgnsSolutions::Named> CgnsSolutions::fields_at(std::size_t step) const {
    std::vector<Named> fields;
    std::set<std::pair<Association, std::string>> taken;
    for (const Solution& solution : solutions_) {
        if (!holds(solution, step)) continue;
        for (const CgnsNode& node : solution.parts) {
            if (node.label != "DataArray_t") continue;
            Named field{node.name, &solution, &node, ScalarType::float64, {}};
            field.problem = problem_of(solution, node, field.type);
            if (field.problem.empty() && !taken.emplace(solution.association, node.name).second)
                field.name = solution.node.name + "/" + node.name;
            fields.push_back(std::move(field));
        }
    }
    return fields;
}

void CgnsSolutions::announce(FileInfo& info, std::optional<std::size_t> only) const {
    for (std::size_t step = 0; step < std::max<std::size_t>(steps_, 1); ++step) {
        if (only && *only != step) continue;
        for (const Named& field : fields_at(step)) {
            if (field.problem.empty())
                isotet::io::announce(info, {field.name, field.solution->association, field.type, 1});
            else leave_out_field(info, field, field.problem);
        }
    }
}

void CgnsSolutions::leave_out_field(FileInfo& info, const Named& field, const std::string& reason) const {
    const char* const what = !field.solution->problem.empty()                    ? "field"
                             : field.solution->association == Association::point ? "point field"
                                                                                 : "cell field";
    leave_out(info,
              {what, field.name, fmt::format("{} (solution \"{}\")", reason, escaped(field.solution->node.name))});
}

Result<Array> CgnsSolutions::values_of(const Named& field, const CgnsCells& cells) const {
    const auto values = tree_.numbers(*field.node);
    if (!values) return values;
    const std::vector<std::uint64_t> size = size_for(*field.solution);
    if (field.solution->association == Association::cell && !zone_.is_structured && values->size() == cells.elements &&
        values->size() != count_with_rind(tree_, field.solution->parts, size)) {
        if (!numbers_fit(cells)) return invalid_data("has values of all elements, whose numbers have gaps");
        return values_of_cells(*values, cells);
    }
    return without_rind(tree_, field.solution->parts, *values, size);
}

void CgnsSolutions::read(const ReadOptions& options, std::size_t step, const CgnsCells& cells, Grid& grid,
                         FileInfo& info) const {
    for (const Named& field : fields_at(step)) {
        const Association association = field.solution->association;
        if (!field.problem.empty() || !wanted(options, association, field.name)) continue;
        if (association == Association::cell && grid.cells.count() == 0) continue;
        auto values = values_of(field, cells);
        if (!values) leave_out_field(info, field, values.error().message);
        else if (association == Association::point) grid.point_fields.push_back({field.name, *std::move(values)});
        else grid.cell_fields.push_back({field.name, *std::move(values)});
    }
}

} // namespace isotet::io::confined
