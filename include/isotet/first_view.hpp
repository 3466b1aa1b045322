// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What to show of a grid where no field is named: which one, and as what.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/read.hpp>

namespace isotet {

enum class FirstDraw : std::uint8_t {
    isosurfaces,
    field_on_boundary,   ///< the field jumps from cell to cell, or the grid is one cell thick or of flat cells
    regions_on_boundary, ///< there are only numbers of regions, materials and so on
    boundary             ///< no field varies
};

enum class FirstReason : std::uint8_t {
    marked,    ///< the file says which array to show
    name,      ///< it is called as something that people contour
    variation, ///< it varies smoothly, and its values are spread most evenly over their range
    only,      ///< nothing better varies
    nothing    ///< no field varies
};

/// What to show first.
struct FirstView {
    FirstDraw draw = FirstDraw::boundary;
    std::string field; ///< for find_field(): "p", "velocity:mag" of a vector; empty: none varies
    Association association = Association::point;
    FirstReason reason = FirstReason::nothing;
    bool rough = false; ///< the field varies as much within cells as over the grid
    bool flat = false;  ///< the grid has flat cells alone
    bool empty = false; ///< the grid has no cell that is contoured, and others than flat ones: nothing can be shown
    bool walls = false; ///< the field varies at the boundary alone: the cell field of the same name does not
};

/// "its name", "the file marks it", ...: why a field was chosen, to complete "'p' is shown first: ".
ISOTET_API std::string_view text_of(FirstReason reason) noexcept;

/// A field that may be shown, and the arrays that it takes.
struct FirstCandidate {
    std::string name; ///< for find_field()
    Association association = Association::point;
    std::vector<std::string> arrays; ///< to read: several of a component group
    FirstReason reason = FirstReason::variation;
};

/// The fields that first_view() judges, in the order in which it prefers them, by what a file announces alone: first
/// what the file marks, then names that people contour (phases and levels, temperature, concentration, speed, pressure,
/// potentials, von Mises stress, displacement, stress, density, others), then the rest, and tensors (6 or 9 components) where
/// nothing else varies. Vectors and tensors, also those stored as components, count by their magnitude. Names of ids, ranks, owners, weights, sizes, centres, errors and numbers of
/// regions are left out.
///
/// The first of them that varies and is not rough is shown if its reason is `marked` or `name`: readers may stop there.
ISOTET_API std::vector<FirstCandidate> first_candidates(const std::vector<FieldInfo>& fields);

/// What a grid in memory announces; nothing is marked.
ISOTET_API std::vector<FieldInfo> describe_fields(const Grid& grid);

/// Chooses what to show of a grid: the first candidate that varies and is a field, not noise; of those with reason
/// `variation` the one whose values are spread most evenly over their range (entropy of a histogram of 64 bins).
/// A field is noise, rough, where it varies as much within cells as over the grid: it colours the boundary, if it has a
/// reason or there is no better one. A point field whose values vary while those of the cell field of the same name do
/// not (OpenFOAM's first step: the walls differ) comes last. Fields with values beyond 1e100 do not count. Without any
/// field numbers of regions colour the boundary.
///
/// `fields`  as announced; those that the grid does not hold are passed over
///
/// Guarantees  the same on every machine and for any number of threads
/// Cost        up to 200,000 values of a field, and corners of 16,384 cells
/// Threads     safe from many threads on one grid
ISOTET_API FirstView first_view(const Grid& grid, const std::vector<FieldInfo>& fields);

/// Whether a field that find_field() knows has two different values, and not at the boundary alone (FirstView::walls).
///
/// Cost  as first_view()
ISOTET_API bool field_varies(const Grid& grid, std::string_view name);

} // namespace isotet
