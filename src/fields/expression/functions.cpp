// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "fields/expression/functions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace isotet::core {

namespace {

constexpr std::size_t any_number = 64;

double truth(bool value) { return value ? 1 : 0; }
double sign_of(double x) { return x > 0 ? 1 : x < 0 ? -1 : x; }
double smaller(double a, double b) { return std::isnan(a) || a < b ? a : b; }
double larger(double a, double b) { return std::isnan(a) || a > b ? a : b; }
double opposite_truth(double x) { return std::isnan(x) ? x : truth(x == 0); }
/// With the sign of b, as a clock has it.
double modulo(double a, double b) { return a - b * std::floor(a / b); }
/// Small whole powers by multiplication, which rounds alike on every machine.
double power(double base, double exponent) {
    if (exponent == 2) return base * base;
    if (exponent == 3) return base * base * base;
    if (exponent == 0.5) return std::sqrt(base);
    return std::pow(base, exponent);
}

template <class Compare>
double compared(double a, double b, Compare compare) {
    return std::isnan(a) || std::isnan(b) ? std::numeric_limits<double>::quiet_NaN() : truth(compare(a, b));
}

constexpr ExpressionFunction number_function(std::string_view name, UnaryFunction function) {
    return {name, ExpressionOp::unary, 1, 1, function, nullptr, false};
}
constexpr ExpressionFunction two_numbers(std::string_view name, BinaryFunction function, std::size_t most = 2) {
    return {name, ExpressionOp::binary, 2, most, nullptr, function, false};
}
constexpr ExpressionFunction vector_function(std::string_view name, ExpressionOp op, std::size_t arguments = 1) {
    return {name, op, arguments, arguments, nullptr, nullptr, false};
}
constexpr ExpressionFunction derivative(std::string_view name, ExpressionOp op) {
    return {name, op, 1, 1, nullptr, nullptr, true};
}

const auto& all_functions() {
    static const std::array functions{
        number_function("abs", [](double x) { return std::abs(x); }),
        number_function("acos", [](double x) { return std::acos(x); }),
        number_function("asin", [](double x) { return std::asin(x); }),
        number_function("atan", [](double x) { return std::atan(x); }),
        two_numbers("atan2", [](double y, double x) { return std::atan2(y, x); }),
        number_function("ceil", [](double x) { return std::ceil(x); }),
        number_function("cos", [](double x) { return std::cos(x); }),
        number_function("cosh", [](double x) { return std::cosh(x); }),
        vector_function("cross", ExpressionOp::cross, 2),
        derivative("div", ExpressionOp::trace),
        vector_function("dot", ExpressionOp::dot, 2),
        number_function("exp", [](double x) { return std::exp(x); }),
        number_function("floor", [](double x) { return std::floor(x); }),
        vector_function("grad", ExpressionOp::gradient),
        vector_function("if", ExpressionOp::choose, 3),
        derivative("lambda2", ExpressionOp::lambda2),
        number_function("log", [](double x) { return std::log(x); }),
        number_function("log10", [](double x) { return std::log10(x); }),
        number_function("log2", [](double x) { return std::log2(x); }),
        vector_function("mag", ExpressionOp::magnitude),
        two_numbers("max", larger, any_number),
        two_numbers("min", smaller, any_number),
        vector_function("mises", ExpressionOp::mises),
        two_numbers("mod", modulo),
        number_function("not", opposite_truth),
        two_numbers("pow", power),
        derivative("qcriterion", ExpressionOp::q_criterion),
        number_function("round", [](double x) { return std::round(x); }),
        number_function("sign", sign_of),
        number_function("sin", [](double x) { return std::sin(x); }),
        number_function("sinh", [](double x) { return std::sinh(x); }),
        number_function("sqrt", [](double x) { return std::sqrt(x); }),
        number_function("tan", [](double x) { return std::tan(x); }),
        number_function("tanh", [](double x) { return std::tanh(x); }),
        vector_function("vec", ExpressionOp::vector, 3),
        derivative("vorticity", ExpressionOp::curl),
    };
    return functions;
}

} // namespace

const ExpressionFunction* find_function(std::string_view name) {
    const auto& functions = all_functions();
    const auto found = std::ranges::find(functions, name, &ExpressionFunction::name);
    return found == functions.end() ? nullptr : &*found;
}

std::string function_names() {
    std::string names;
    for (const ExpressionFunction& function : all_functions()) {
        if (!names.empty()) names += ", ";
        names += function.name;
    }
    return names;
}

BinaryFunction operator_called(std::string_view symbol) {
    static const std::array<std::pair<std::string_view, BinaryFunction>, 10> operators{{
        {"^", power},
        {"**", power},
        {"<", [](double a, double b) { return compared(a, b, std::less<>()); }},
        {"<=", [](double a, double b) { return compared(a, b, std::less_equal<>()); }},
        {">", [](double a, double b) { return compared(a, b, std::greater<>()); }},
        {">=", [](double a, double b) { return compared(a, b, std::greater_equal<>()); }},
        {"==", [](double a, double b) { return compared(a, b, std::equal_to<>()); }},
        {"!=", [](double a, double b) { return compared(a, b, std::not_equal_to<>()); }},
        {"&&", [](double a, double b) { return compared(a, b, [](double p, double q) { return p != 0 && q != 0; }); }},
        {"||", [](double a, double b) { return compared(a, b, [](double p, double q) { return p != 0 || q != 0; }); }},
    }};
    const auto found = std::ranges::find(operators, symbol, &std::pair<std::string_view, BinaryFunction>::first);
    return found == operators.end() ? nullptr : found->second;
}

} // namespace isotet::core
