// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The functions that expressions have.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "fields/expression/tree.hpp"

namespace isotet::core {

struct ExpressionFunction {
    std::string_view name;
    ExpressionOp op;
    std::size_t least = 1, most = 1; ///< arguments
    UnaryFunction unary = nullptr;
    BinaryFunction binary = nullptr;
    bool of_gradient = false; ///< the argument is the gradient of what is written
};

/// Nothing where there is none of the name.
const ExpressionFunction* find_function(std::string_view name);

/// "abs, acos, ..."
std::string function_names();

/// Of the operators that take numbers only, as written: "<", "&&", "^" ...
BinaryFunction operator_called(std::string_view symbol);

} // namespace isotet::core
