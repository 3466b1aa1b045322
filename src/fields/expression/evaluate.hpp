// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The values of an expression, from those of its fields.
#pragma once

#include <functional>

#include <isotet/array.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "fields/expression/tree.hpp"

namespace isotet::core {

/// Where an expression's values come from.
struct ExpressionSource {
    std::size_t tuples = 0; ///< of each array
    /// The values of a node that is a field or a coordinate.
    std::function<Result<Array>(const ExpressionNode&)> values_of;
    /// The gradient of float64 values, three components for each of theirs.
    std::function<Result<Array>(const Array&)> gradient_of;
};

/// One scalar a tuple: float32 where all arrays of the source are, else float64.
///
/// Guarantees   the same bytes for any thread count
/// Cost         one pass for each derivative and one for the whole, in blocks of 512 values
/// Errors       invalid_argument where numbers of components do not fit; of the source; cancelled
Result<Array> evaluate_expression(const ExpressionTree& tree, const ExpressionSource& source, const Progress& progress);

} // namespace isotet::core
