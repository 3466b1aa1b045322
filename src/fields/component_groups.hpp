// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Scalar fields that are components of one vector: their names.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>

namespace isotet::core {

/// "Velocity", "disp:mag", "disp_:1" where no field has that name; nothing where no group has it either. A component is
/// given by the name of its field, and found without the others of its group.
std::optional<FieldName> match_component_group(std::string_view name, const std::vector<std::string>& names);

} // namespace isotet::core
