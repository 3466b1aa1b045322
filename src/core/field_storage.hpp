// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Looking at a field's values at the points that tets use, to choose how they are stored.
#pragma once

#include <isotet/array.hpp>

#include "core/packed.hpp"
#include "core/storage.hpp"

namespace isotet::core {

struct FieldStorage {
    Storage storage;
    ValueStatistics statistics;
};

/// Offset and scale for a field with any number of components (one pair for all of them), one tuple for each of the
/// user's points. Parallel; two passes over the values at packed points.
FieldStorage survey_field(const Array& values, const Packed& packed);

inline Storage choose_storage(const Array& values, const Packed& packed) { return survey_field(values, packed).storage; }

} // namespace isotet::core
