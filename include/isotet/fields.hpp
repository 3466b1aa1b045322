// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// What a name means that is both a point and a cell field.
struct FindFieldOptions {
    Association prefer = Association::point;
    bool for_pieces = false; ///< average a cell field so that pieces with a layer of ghost cells get the values of the
                             ///< whole grid, bit for bit: cells are added in the order of their values
    bool keep_cell_values = false; ///< PointField::cell_values, where a cell field is averaged
};

/// Finds the scalar field called `name` on a grid.
///
/// The name is first taken whole; only if no field has it is the part after the last colon a component: `x`, `y`, `z`,
/// `mag`, a number from 0, or of tensors `xx`, `xy` ... `zz` (6 components: XX YY ZZ XY YZ XZ; 9: row by row). A name that no field has may be that of a component group (ComponentGroup). A name
/// that is both a point and a cell field means the preferred one, with a note. If no field is meant, `x`, `y`, `z` are
/// the coordinates. An empty name means the only field there is.
/// A cell field is averaged to the points, weighted by the volumes of the cells around each; cells where it is NaN are
/// left out; a point without a cell left is NaN.
///
/// Errors   invalid_argument when there is no such field (what there is, nearest first), when it is ambiguous or has
///          several components, or when a field's length is not that of the grid
ISOTET_API Result<PointField> find_field(const Grid& grid, std::string_view name, const FindFieldOptions& options = {},
                                         const Run& run = {});

/// A field's name and the component that is meant.
struct FieldName {
    std::string field;
    std::optional<std::string> component;
    std::vector<std::string> parts = {}; ///< of a component group: the scalar fields to read in its place
};

/// The name taken apart by the rule of find_field() against a list of names; used by readers to load only what is
/// needed. A component group may be called without the "_", ".", ":" or blank at its end; one component of it is the
/// field that holds it.
ISOTET_API std::optional<FieldName> match_field_name(std::string_view name, const std::vector<std::string>& names);

/// `names`, nearest to `wanted` first (edit distance, upper and lower case alike), for error messages.
ISOTET_API std::vector<std::string> nearest_first(std::string_view wanted, std::vector<std::string> names);

// What the values of a field are like, before anything is contoured: ranges and missing values.

/// One component of a field.
struct ComponentStatistics {
    double lower = 0, upper = 0;    ///< of the finite values; lower > upper when there is none
    std::uint64_t not_a_number = 0; ///< values that are NaN
    std::uint64_t infinite = 0;
};

/// Ranges and missing values of an array, one entry for each component.
///
/// Guarantees   the same for any thread count
/// Cost         one parallel pass
/// Errors       cancelled; out_of_memory
/// Threads      safe from many threads on one array
ISOTET_API Result<std::vector<ComponentStatistics>> statistics_of(const Array& values, const Run& run = {});

/// The range of a field without its rare values: the lowest and the highest fiftieth of the values do not count, unless
/// nothing but one value is left then. Not finite values are passed over; vectors count by their magnitude.
///
/// Cost   up to 200,000 values, spread evenly, are sorted
ISOTET_API ValueRange typical_range(const Array& values);

// Vectors and tensors that a file stores as scalars: VelocityX, VelocityY, VelocityZ.

/// Scalar fields that are the components of one vector or tensor, as Exodus and CGNS store them.
struct ComponentGroup {
    std::string name;               ///< what the parts have in common, as VTK names it: "Velocity", "disp_"
    std::vector<std::string> parts; ///< 3: x, y, z; 6: xx, yy, zz, xy, yz, xz; 9: xx, xy, xz, yx and so on
};

/// The groups among names of scalar fields of one association: endings in x, y, z or in pairs of these, in capitals or
/// not, where all components are there and no field has the group's name. In the order of their first parts.
ISOTET_API std::vector<ComponentGroup> component_groups(const std::vector<std::string>& names);

/// The fields that names in packed files stand for, which have vectors as their components and their magnitude: U:x, U:y,
/// U:z, and U:mag if it is there, are U. Other names are fields themselves, of one part. In the order of their first parts.
ISOTET_API std::vector<ComponentGroup> joined_fields(const std::vector<std::string>& names);

/// The names that a vector has in a packed file: its components, and its magnitude.
ISOTET_API std::vector<std::string> packed_names_of_vector(const std::string& name);

/// The names of those that have one component.
ISOTET_API std::vector<std::string> scalar_names(const std::vector<Field>& fields);

/// The fields called `parts`, which are of one length, as one with a component each.
/// Errors   invalid_argument: one is missing, is no scalar, or has another length
ISOTET_API Result<Field> gather_components(const std::vector<Field>& fields, const std::string& name,
                                           const std::vector<std::string>& parts);

// Fields that are computed: find_field() takes an expression where no field has the name.
//
//   mag(U)   p - 0.5*rho*mag(U)^2   if(alpha.water > 0.5, T, 0)   qcriterion(U)   `wall distance` / 2
//
// docs/expressions.md has names, operators and functions. Computed in double; float32 where all that it is made of is
// float32, else float64. NaN is no data, so what has no value (sqrt(-1), 0/0) is left out. An expression of cell fields
// alone is computed in the cells and averaged to the points; where it has point fields, coordinates or derivatives, cell
// fields are averaged first.
//
// A derivative at a point is the mean over the cells around it of the derivative of the cell's linear interpolation at
// that corner: exact for linear fields. Cells that are not linear are made so first (linearize()).

/// What an expression is made of.
struct ExpressionNeeds {
    std::vector<std::string> fields; ///< to read, each once, as files call them
    bool neighbours = false;         ///< it has derivatives: the value at a point follows from all cells around it
};

/// Reads an expression.
///
/// `names`   of the fields that there are
/// Errors    invalid_argument: what is wrong and at which character; a name that no field has, and those that there are
/// Cost      O(length); texts above 4,096 bytes are refused
ISOTET_API Result<ExpressionNeeds> needs_of_expression(std::string_view text, const std::vector<std::string>& names);

/// Whether a text has what names of fields do not: operators, brackets or backquotes.
ISOTET_API bool looks_like_expression(std::string_view text) noexcept;

/// The arrays of a file that a field of find_field() is made of.
struct FieldArrays {
    std::vector<std::string> point, cell; ///< none of a coordinate. Both may have a field of the name
    bool neighbours = false;              ///< as ExpressionNeeds
    bool is_expression = false;           ///< which needs all of them, each as a point field or as a cell field
};

/// Finds them by name, before anything is read.
///
/// `point`, `cell`   names of the fields that there are
/// Errors            as needs_of_expression(); invalid_argument: no field has the name, and those that there are, nearest first
ISOTET_API Result<FieldArrays> arrays_of_field(const std::string& name, const std::vector<std::string>& point,
                                               const std::vector<std::string>& cell);

} // namespace isotet
