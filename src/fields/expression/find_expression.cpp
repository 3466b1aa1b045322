// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "fields/expression/find_expression.hpp"

#include <isotet/fields.hpp>

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "base/buffer.hpp"
#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "fields/expression/evaluate.hpp"
#include "fields/expression/point_gradients.hpp"
#include "fields/fill_values.hpp"
#include "fields/one_field.hpp"

namespace isotet::core {

namespace {

/// Each component averaged.
Result<Array> average_components(const Grid& grid, const Field& field, bool by_value, const Progress& progress) {
    const std::size_t components = field.values.components(), points = grid.points.tuples();
    if (components == 1) return average_field(grid, field, {}, by_value, progress);
    Buffer<double> all(points * components);
    bool is_narrow = false;
    for (std::size_t c = 0; c < components; ++c) {
        const auto averaged = average_field(grid, field, {c, false}, by_value, progress);
        if (!averaged) return averaged;
        is_narrow = averaged->type() == ScalarType::float32;
        averaged->visit([&](auto values) {
            parallel_each(points, std::size_t{1} << 14,
                          [&](std::size_t i) { all[i * components + c] = static_cast<double>(values[i]); });
        });
    }
    if (!is_narrow) return std::move(all).to_array(components);
    Buffer<float> narrow(all.size());
    parallel_each(all.size(), std::size_t{1} << 14, [&](std::size_t i) { narrow[i] = static_cast<float>(all[i]); });
    return std::move(narrow).to_array(components);
}

class Finder {
public:
    /// `cells`   of the grid
    Finder(const Grid& grid, std::size_t cells, const ExpressionTree& tree, const FindFieldOptions& options,
           const Progress& progress)
        : grid_(grid), cells_(cells), tree_(tree), options_(options), progress_(progress) {}

    Result<PointField> find() {
        if (is_of_cells()) return average_cells();
        const ExpressionSource source{grid_.points.tuples(),
                                      [&](const ExpressionNode& node) { return values_at_points(node); },
                                      [&](const Array& values) { return point_gradients(grid_, values, progress_); }};
        auto values = evaluate_expression(tree_, source, progress_);
        if (!values) return values.error();
        return PointField{tree_.text, *std::move(values), false, {}};
    }

    /// Nothing where it is not one of cells.
    Result<std::optional<Field>> find_in_cells() {
        if (!is_of_cells()) return std::optional<Field>();
        auto values = evaluate_in_cells();
        if (!values) return values.error();
        return std::optional(Field{tree_.text, *std::move(values)});
    }

private:
    Result<Array> evaluate_in_cells() {
        const ExpressionSource source{cells_, [&](const ExpressionNode& node) { return values_in_cells(node); }, {}};
        return evaluate_expression(tree_, source, progress_);
    }

    Result<PointField> average_cells() {
        auto values = evaluate_in_cells();
        if (!values) return values.error();
        auto averaged = average_field(grid_, {tree_.text, *values}, {}, options_.for_pieces, progress_);
        if (!averaged) return averaged.error();
        PointField found{tree_.text, *std::move(averaged), true, {}};
        auto fill = find_fill_values(*values, {.progress = progress_});
        if (!fill) return fill.error();
        found.cell_fill = *std::move(fill);
        if (options_.keep_cell_values) found.cell_values = *std::move(values);
        return found;
    }

    /// Whether all fields are to be taken from the cells, and nothing needs points.
    bool is_of_cells() const {
        bool has_fields = false;
        for (const ExpressionNode& node : tree_.nodes) {
            if (node.op == ExpressionOp::coordinate || node.op == ExpressionOp::gradient) return false;
            if (node.op != ExpressionOp::field) continue;
            has_fields = true;
            const auto in_cells = find_or_gather(grid_.cell_fields, node.field);
            if (!in_cells || !*in_cells) return false;
            const auto at_points = find_or_gather(grid_.point_fields, node.field);
            if (at_points && *at_points && options_.prefer == Association::point) return false;
        }
        return has_fields;
    }

    Result<Array> values_in_cells(const ExpressionNode& node) const {
        const auto field = find_or_gather(grid_.cell_fields, node.field);
        if (!field) return field.error();
        if (auto fits = check_length(**field, "cell", cells_); !fits) return fits.error();
        return (*field)->values;
    }

    Result<Array> values_at_points(const ExpressionNode& node) const {
        if (node.op == ExpressionOp::coordinate) {
            if (!is_floating(grid_.points.type()) || grid_.points.components() != 3)
                return invalid_data(
                    fmt::format("points are {} with {} components, but must be float32 or float64 with 3",
                                name_of(grid_.points.type()), grid_.points.components()));
            return scalar_of(grid_.points, {node.component, false});
        }
        auto at_points = find_or_gather(grid_.point_fields, node.field);
        if (!at_points) return at_points.error();
        auto in_cells = find_or_gather(grid_.cell_fields, node.field);
        if (!in_cells) return in_cells.error();
        if (!*at_points && !*in_cells)
            return invalid_argument(fmt::format("the components of '{}' are of points and of cells", node.field.field));
        if (*in_cells && (!*at_points || options_.prefer == Association::cell))
            return average_components(grid_, **in_cells, options_.for_pieces, progress_);
        if (auto fits = check_length(**at_points, "point", grid_.points.tuples()); !fits) return fits.error();
        return (*at_points)->values;
    }

    const Grid& grid_;
    std::size_t cells_;
    const ExpressionTree& tree_;
    const FindFieldOptions& options_;
    const Progress& progress_;
};

} // namespace

Result<PointField> find_expression(const Grid& grid, std::string_view text, const std::vector<std::string>& names,
                                   const FindFieldOptions& options, const Progress& progress) {
    const auto tree = parse_expression(text, names);
    if (!tree) return tree.error();
    return Finder(grid, grid.cells.count(), *tree, options, progress).find();
}

Result<std::optional<Field>> expression_in_cells(const std::vector<Field>& cell_fields, std::size_t cells,
                                                 std::string_view text, const Progress& progress) {
    std::vector<std::string> names;
    for (const Field& field : cell_fields) names.push_back(field.name);
    const auto tree = parse_expression(text, names);
    if (!tree) return tree.error();
    const Grid grid{{}, {}, {}, cell_fields};
    return Finder(grid, cells, *tree, {}, progress).find_in_cells();
}

} // namespace isotet::core
