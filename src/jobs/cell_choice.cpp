// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/cell_choice.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <isotet/fields.hpp>
#include <isotet/jobs/grid_source.hpp>
#include <isotet/jobs/number_text.hpp>
#include <isotet/jobs/output_names.hpp>

#include "grid/cells.hpp"
#include "grid/patches.hpp"
#include "grid/points/used_points.hpp"
#include "grid/values/values_in_ranges.hpp"
#include "jobs/refuse.hpp"

namespace isotet::jobs {

namespace {

/// Of a list: a number, a range or a region.
struct Item {
    std::string text;
    double lower = 0, upper = 0;
};

std::optional<double> number_in(std::string_view text) {
    double number = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc{} || rest != end || std::isnan(number)) return std::nullopt;
    return number;
}

/// "3", "3:5", "3:" or ":5".
std::optional<Item> number_or_range(const std::string& text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) {
        const auto number = number_in(text);
        return number ? std::optional(Item{text, *number, *number}) : std::nullopt;
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const std::string_view low = std::string_view(text).substr(0, colon),
                           high = std::string_view(text).substr(colon + 1);
    const auto lower = low.empty() ? std::optional(-infinity) : number_in(low);
    const auto upper = high.empty() ? std::optional(infinity) : number_in(high);
    if (text.size() == 1 || !lower || !upper || *lower > *upper) return std::nullopt;
    return Item{text, *lower, *upper};
}

Error no_such_item(const CellChoice& choice, const std::string& item, const std::vector<RegionName>& regions) {
    std::vector<std::string> names;
    for (const RegionName& region : regions)
        if (region.field == choice.field) names.push_back(region.name);
    return refusal("`cells` got '{}', but '{}' is no number, no range A:B that ascends and no region: the file {}",
                   choice.text, item,
                   names.empty() ? fmt::format("names none of '{}'", choice.field)
                                 : "has " + quoted_list(nearest_first(item, std::move(names))));
}

/// Names of regions may have commas.
Result<std::vector<Item>> items_of(const CellChoice& choice, const std::vector<RegionName>& regions) {
    std::vector<std::size_t> ends; // of the parts between commas
    for (std::size_t at = 0; at <= choice.list.size(); ++at)
        if (at == choice.list.size() || choice.list[at] == ',') ends.push_back(at);
    std::vector<Item> items;
    for (std::size_t i = 0, begin = 0; i < ends.size(); begin = ends[i++] + 1) {
        std::string part = choice.list.substr(begin, ends[i] - begin);
        bool found = false; // names first: some are numbers of other regions
        for (std::size_t last = ends.size(); last-- > i && !found;) {
            const std::string name = choice.list.substr(begin, ends[last] - begin);
            for (const RegionName& region : regions) {
                if (region.field != choice.field || region.name != name) continue;
                const auto number = static_cast<double>(region.number);
                items.push_back({name, number, number});
                found = true;
            }
            if (found) i = last;
        }
        if (found) continue;
        std::optional<Item> item = number_or_range(part);
        if (!item) return no_such_item(choice, part, regions);
        items.push_back(*std::move(item));
    }
    return items;
}

std::vector<std::array<double, 2>> ranges_of(const std::vector<Item>& items) {
    std::vector<std::array<double, 2>> ranges;
    for (const Item& item : items) ranges.push_back({item.lower, item.upper});
    return ranges;
}

/// "1, 2, 5", or "0.25 to 17" where they are many.
std::string values_there(const Array& values) {
    constexpr std::size_t max_shown = 12;
    std::set<double> some;
    double lower = std::numeric_limits<double>::infinity(), upper = -lower;
    for (std::size_t cell = 0; cell < values.tuples(); ++cell) {
        const double value = values.at(cell);
        if (std::isnan(value)) continue;
        lower = std::min(lower, value);
        upper = std::max(upper, value);
        if (some.size() <= max_shown) some.insert(value);
    }
    if (some.empty()) return "none";
    if (some.size() > max_shown) return fmt::format("{} to {}", shortest(lower), shortest(upper));
    std::vector<std::string> list;
    for (const double value : some) list.push_back(shortest(value));
    return fmt::format("{}", fmt::join(list, ", "));
}

/// Clears `chosen` where the choice does not hold.
Result<void> restrict_to(const CellChoice& choice, const Grid& grid, const std::vector<RegionName>& regions,
                         std::vector<std::uint8_t>& chosen, std::vector<std::string>& missing) {
    const auto field = std::ranges::find(grid.cell_fields, choice.field, &Field::name);
    if (field == grid.cell_fields.end())
        return refusal("`cells` got '{}', but this step has no cell field '{}'", choice.text, choice.field);
    const Array& values = field->values;
    if (values.components() != 1)
        return refusal("`cells` got '{}', but '{}' has {} components: cells are chosen by a field of one", choice.text,
                       choice.field, values.components());
    Result<std::vector<Item>> items = items_of(choice, regions);
    if (!items) return items.error();
    const std::vector<bool> is_there = core::restrict_to_ranges(values, ranges_of(*items), choice.others, {}, chosen);
    for (std::size_t i = 0; i < items->size(); ++i)
        if (!is_there[i])
            missing.push_back(fmt::format("`cells` got '{}', but no cell has {}: '{}' has {}", choice.text,
                                          (*items)[i].text, choice.field, values_there(values)));
    return {};
}

std::vector<std::uint8_t> types_of(const Cells& cells) {
    if (cells.types.empty()) return std::vector(cells.count(), static_cast<std::uint8_t>(cells.uniform_type));
    const auto types = cells.types.as<std::uint8_t>();
    return {types.begin(), types.end()};
}

/// Offsets that cells of several types must have.
void add_offsets(Cells& cells) {
    if (!cells.offsets.empty()) return;
    std::vector<std::uint64_t> offsets(cells.count() + 1);
    const std::uint64_t corners = cells.connectivity.tuples() / cells.count();
    for (std::size_t cell = 0; cell < offsets.size(); ++cell) offsets[cell] = corners * cell;
    cells.offsets = Array::own(std::move(offsets));
}

/// Points have a value where a cell uses it, one with a volume if `solid`: ranges and shares are of the cells that are left.
void leave_values_of_cells(Grid& grid, bool solid) {
    const auto cells = core::CellReader::open(grid);
    if (!cells) return; // the checks of the grid say why
    std::vector<std::uint8_t> used(grid.points.tuples());
    const auto counts = [&](std::size_t cell) {
        return cells->type(cell) != 0 && (!solid || core::has_a_volume(cells->type(cell)));
    };
    for (std::size_t cell = 0; cell < cells->count(); ++cell) {
        if (!counts(cell)) continue;
        const std::uint64_t first = cells->first(cell), end = first + cells->corners(cell);
        for (std::uint64_t i = first; i < end && i < cells->connectivity_size(); ++i)
            if (const std::uint64_t point = cells->corner(i); point < used.size()) used[point] = 1;
    }
    core::mark_points_of_faces(grid.cells, used, counts);
    for (Field& field : grid.point_fields) field.values = core::without_unused(field.values, used);
}

} // namespace

Result<std::vector<CellChoice>> parse_cell_choices(const std::vector<std::string>& texts,
                                                   const std::vector<std::string>& fields) {
    std::vector<CellChoice> choices;
    for (const std::string& text : texts) {
        const bool others = text.starts_with('!');
        const std::string rest = text.substr(others ? 1 : 0);
        std::size_t equals = rest.find('=');
        if (equals == std::string::npos || equals + 1 == rest.size())
            return refusal("`cells` got '{}', but takes FIELD=NUMBERS, such as region=2,5, or FIELD=A:B", text);
        const std::size_t first = equals;
        const auto is_field = [&] { return std::ranges::find(fields, rest.substr(0, equals)) != fields.end(); };
        while (equals != std::string::npos && !is_field()) equals = rest.find('=', equals + 1);
        if (equals == std::string::npos) {
            const std::string name = rest.substr(0, first);
            return refusal("`cells` got '{}', but there is no cell field '{}': the grid has {}", text, name,
                           fields.empty() ? "none" : quoted_list(nearest_first(name, fields)));
        }
        choices.push_back({text, others, rest.substr(0, equals), rest.substr(equals + 1)});
    }
    return choices;
}

Result<void> check_cell_choices(std::span<const CellChoice> choices, const std::vector<RegionName>& regions) {
    for (const CellChoice& choice : choices)
        if (const auto items = items_of(choice, regions); !items) return items.error();
    return {};
}

Result<std::vector<CellCondition>> conditions_of(std::span<const CellChoice> choices,
                                                 const std::vector<RegionName>& regions) {
    std::vector<CellCondition> conditions;
    for (const CellChoice& choice : choices) {
        const auto items = items_of(choice, regions);
        if (!items) return items.error();
        conditions.push_back({choice.field, ranges_of(*items), choice.others});
    }
    return conditions;
}

Result<ChosenCells> choose_cells(Grid grid, std::span<const CellChoice> choices,
                                 const std::vector<RegionName>& regions) {
    ChosenCells result;
    std::vector<std::uint8_t> chosen(grid.cells.count(), 1);
    for (const Field& field : grid.cell_fields)
        if (field.values.tuples() != chosen.size())
            return Error{ErrorCode::invalid_data,
                         fmt::format("cell field '{}' has {} tuples, but the grid has {} cells", field.name,
                                     field.values.tuples(), chosen.size())};
    for (const CellChoice& choice : choices)
        if (auto done = restrict_to(choice, grid, regions, chosen, result.missing); !done) return done.error();
    std::vector<std::uint8_t> types = types_of(grid.cells);
    std::size_t solid = 0, chosen_solid = 0, chosen_in_all = 0;
    for (std::size_t cell = 0; cell < types.size(); ++cell) {
        solid += core::has_a_volume(types[cell]);
        chosen_solid += chosen[cell] && core::has_a_volume(types[cell]);
        chosen_in_all += chosen[cell];
    }
    result.count = chosen_solid > 0 ? chosen_solid : chosen_in_all;
    result.of = chosen_solid > 0 ? solid : types.size();
    if (result.count == 0 && !result.missing.empty()) return Error{ErrorCode::invalid_argument, result.missing.front()};
    if (result.count == 0)
        return refusal("`cells`: none of {} is in {}", counted(types.size(), "cell"), text_of(choices));
    result.grid = std::move(grid);
    if (result.count == result.of) return result;
    for (std::size_t cell = 0; cell < types.size(); ++cell)
        if (!chosen[cell] && (chosen_solid == 0 || core::has_a_volume(types[cell]))) types[cell] = 0;
    add_offsets(result.grid.cells);
    result.grid.cells.types = Array::own(std::move(types));
    leave_values_of_cells(result.grid, chosen_solid > 0);
    return result;
}

std::string text_of(std::span<const CellChoice> choices) {
    std::vector<std::string> texts;
    for (const CellChoice& choice : choices) texts.push_back(choice.text);
    return fmt::format("{}", fmt::join(texts, " and "));
}

} // namespace isotet::jobs
