// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Vectors and tensors that a file stores as scalars: VelocityX, VelocityY, VelocityZ.
#pragma once

#include <string>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/result.hpp>

namespace isotet {

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

} // namespace isotet
