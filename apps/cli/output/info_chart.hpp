// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet info --chart`: area and volume of a field's isosurfaces.
#pragma once

#include <string>

#include <isotet/jobs/look_into.hpp>

#include "output/json_output.hpp"

namespace isotet::cli {

std::string chart_table(const FieldChart& chart);
Json json_of(const FieldChart& chart);

} // namespace isotet::cli
