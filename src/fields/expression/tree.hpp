// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// An expression of fields as a tree.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>
#include <isotet/result.hpp>

namespace isotet::core {

enum class ExpressionOp : std::uint8_t {
    number,
    field,
    coordinate, ///< x, y or z: `component` of the points
    component,
    choose, ///< if(c, a, b)
    vector, ///< of three numbers
    unary,  ///< of one number, and the sign of vectors
    binary, ///< of two numbers
    add,
    subtract,
    multiply,
    divide,
    magnitude,
    dot,
    cross,
    gradient,
    trace, ///< div(U) is the trace of grad(U), and so on
    curl,
    q_criterion,
    lambda2,
    mises
};

/// Of numbers; NaN where there is no value.
using UnaryFunction = double (*)(double);
using BinaryFunction = double (*)(double, double);

struct ExpressionNode {
    ExpressionOp op = ExpressionOp::number;
    double number = 0;
    FieldName field = {};          ///< of `field`
    std::size_t component = 0;     ///< of `component` and `coordinate`
    bool of_tensor = false;        ///< `component` is as in core::Scalar
    UnaryFunction unary = nullptr; ///< of `unary`; none: the sign
    BinaryFunction binary = nullptr;
    std::vector<std::size_t> arguments = {}; ///< nodes before this one
    std::size_t begin = 0, end = 0;          ///< where it stands in the text
};

struct ExpressionTree {
    std::string text;
    std::vector<ExpressionNode> nodes; ///< arguments first; the last is the whole

    std::string_view text_of(const ExpressionNode& node) const {
        return std::string_view(text).substr(node.begin, node.end - node.begin);
    }
};

/// Errors   as needs_of_expression()
Result<ExpressionTree> parse_expression(std::string_view text, const std::vector<std::string>& names);

} // namespace isotet::core
