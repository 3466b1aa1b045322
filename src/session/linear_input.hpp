// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a session is given, with linear cells: everything behind it sees no others.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/fields.hpp>
#include <isotet/linear_cells.hpp>

#include "base/array_identity.hpp"
#include "session/fingerprint.hpp"

namespace isotet::session {

/// A grid that was made linear, known again by its cells. Copying shares it.
class LinearInput {
public:
    /// The input with linear cells: fields continued for derived points and cells; itself where all cells are linear. The
    /// same cells as before keep their derived points, also when the user's points moved.
    ///
    /// Errors   as linearize() and LinearGrid::extend()
    Result<ContourInput> make(ContourInput input, const Run& run);

    /// Null where all cells of the last input were linear.
    const std::shared_ptr<const LinearGrid>& grid() const { return linear_; }
    /// True when the last input was the first with its cells.
    bool is_new() const { return is_new_; }

private:
    bool knows(const Grid& grid) const;

    std::shared_ptr<const LinearGrid> linear_;
    std::vector<core::ArrayIdentity> arrays_; ///< of the user's cells and point numbers
    Fingerprint cells_print_, numbers_print_;
    std::optional<core::ArrayIdentity> points_;
    bool is_new_ = false;
};

/// What extraction of some isovalues needs of an input with polyhedra. Copying shares it. Empty: there is none.
class MetInput {
public:
    /// Whether the polyhedra that isovalues do not meet can be left out: nothing needs them, and coordinates and values are
    /// stored without a change of scale, whatever the other cells have. Cost: a pass over the values
    static bool suits(const ContourInput& input, const ContourOptions& options);

    /// The input with linear cells, where the expected isovalues of the options are; nothing where they meet no cell, or where
    /// coordinates or values would be rounded in another way: offset and origin come from the ends of their ranges, so
    /// polyhedra that have these stay, too, unless they are open.
    /// Errors   as linearize() and LinearGrid::extend()
    Result<std::optional<ContourInput>> make(const ContourInput& input, const ContourOptions& options, const Run& run);

    explicit operator bool() const { return user_.has_value(); }
    bool is_good_for(std::span<const double> isovalues) const;
    const std::shared_ptr<const LinearGrid>& grid() const { return linear_; }
    const ContourInput& user() const { return *user_; }

    /// Of the field's finite values at the points of all cells.
    ValueRange range() const { return range_; }

private:
    std::optional<ContourInput> user_;
    std::vector<double> isovalues_;
    ValueRange range_;
    std::shared_ptr<const LinearGrid> linear_;
};

/// The input on a linear grid that was made of its grid: fields are continued for derived points and cells.
/// Errors   as LinearGrid::extend()
Result<ContourInput> on_linear_grid(ContourInput input, const LinearGrid& linear, const Run& run);

/// Errors   invalid_argument: GridPart::cell_numbers do not fit the cells
Result<void> check_cell_numbers(const ContourInput& input);

/// The input with the cells that it lacks.
/// Errors   those of GridPart::whole
Result<ContourInput> with_all_cells(ContourInput input, const Run& run);

/// Writes LinearGrid::derived_numbers over the edge ends that are derived points. Empty: they are the same.
void map_edge_ends(std::uint64_t user_points, const Array& numbers, std::vector<Extraction>& surfaces);

} // namespace isotet::session
