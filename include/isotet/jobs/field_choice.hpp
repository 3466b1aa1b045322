// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which fields a command needs: decided by name before anything is read, where a name was given.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/jobs/grid_source.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>
#include <isotet/slice.hpp>

namespace isotet::jobs {

/// A field's name, and what it is when a point field and a cell field have it.
struct FieldChoice {
    std::string name; ///< empty: the only one there is
    bool cell_field = false;
    bool own_centres = false;             ///< of a cell field: points inside polyhedra have the values of their cells
    std::optional<SliceShape> shape = {}; ///< slice_field() in place of a field of the grid
};

/// A field as find_field() will look for it, and the arrays that it is made of.
struct FoundField {
    std::string name;                     ///< for find_field(); empty only for "no field"
    std::vector<std::string> point, cell; ///< to read; none for a coordinate
    bool neighbours = false;              ///< its values follow from all cells around a point
    bool is_expression = false;           ///< which needs all of `point` and `cell`, each from one of them
};

/// The field to contour. An empty name means the only one there is.
/// Errors   invalid_argument: no such field (what there is, nearest first), or no name and not just one field
Result<FoundField> choose_field(const GridSource& source, const FieldChoice& choice);

/// Whether it is a field of cells, a component of one, or an expression of some, which can be averaged while they go by
/// (ReadActiveCells::averages).
bool is_averaged_while_read(const FoundField& field, const FieldChoice& choice);

/// Names of fields by texts as --fields takes them: each a field as choose_field() finds it, else a list of these
/// separated by commas.
///
/// `choice`   of all of them, but for the name
/// Errors     as choose_field()
Result<std::vector<std::string>> choose_field_names(const GridSource& source, const std::vector<std::string>& texts,
                                                    FieldChoice choice);

/// "'p' is not in 2 of the 5 time steps, which are skipped: 0, 3".
std::string skipped_note(const std::string& field, const std::vector<std::size_t>& skipped, std::size_t steps);

/// Those of several time steps that have all these fields, each a name or an expression; the others are noted. A single
/// step is not looked at.
/// Errors   as choose_field(), where no step has one of them; invalid_argument: no step has all of them
Result<std::vector<std::size_t>> steps_with_fields(GridSource& source, std::vector<std::size_t> steps,
                                                   const std::vector<std::string>& names, Caller& caller);

/// The fields to carry onto a surface.
struct CarriedFields {
    std::vector<std::string> point;     ///< whole point fields
    std::vector<std::string> cell;      ///< whole cell fields
    std::vector<FoundField> components; ///< components of point fields, and expressions
};

/// What --with names; each a point field, else a cell field, else a component of a point field, else a list of these
/// separated by commas, else an expression. Empty names are no field.
Result<CarriedFields> choose_carried(const GridSource& source, const std::vector<std::string>& names);

/// The fields of one read: without repetition.
void add_names(std::vector<std::string>& names, const std::vector<std::string>& more);

/// find_field() as a FieldChoice means it, with its note.
/// Errors   as find_field(); invalid_argument: own values of centres are asked for of a point field
Result<PointField> find_chosen(const Grid& grid, const std::string& name, const FieldChoice& choice, Caller& caller);

/// Reads a time step into `grid`: what the field needs, and `beside`; all fields where none is named, of which that of
/// first_view() is taken, with a note.
///
/// `beside`   the name of another field, or empty
/// Errors     as choose_field() and find_field(); invalid_data when none is named and none varies
Result<PointField> read_field(const GridSource& source, std::size_t step, const FieldChoice& choice,
                              const std::string& beside, Caller& caller, Grid& grid);

} // namespace isotet::jobs
