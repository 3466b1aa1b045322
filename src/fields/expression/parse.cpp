// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Expressions by recursive descent: or, and, comparison, sum, product, sign, power, component, value.
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <isotet/fields.hpp>

#include "base/errors.hpp"
#include "fields/expression/functions.hpp"
#include "fields/expression/tree.hpp"
#include "grid/values/scalar_of.hpp"

namespace isotet {

namespace core {

namespace {

constexpr std::size_t longest_expression = 4096, deepest_expression = 100;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool begins_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}
bool is_of_name(char c) { return begins_name(c) || is_digit(c) || c == '.'; }

using NodeNumber = std::size_t;

class Parser {
public:
    Parser(std::string_view text, const std::vector<std::string>& names) : names_(names) { tree_.text = text; }

    Result<ExpressionTree> parse() {
        if (tree_.text.size() > longest_expression)
            return invalid_argument(fmt::format("an expression of {} characters is given, but {} are the most",
                                                tree_.text.size(), longest_expression));
        const auto whole = parse_level(0);
        if (!whole) return whole.error();
        skip_blanks();
        if (place_ < tree_.text.size()) return expected("an operator");
        return std::move(tree_);
    }

private:
    using Parsed = Result<NodeNumber>;

    // Operators that stand between two values, those that bind least first; longer ones before their beginnings.
    static constexpr std::size_t levels = 5;
    static constexpr std::array<std::array<std::string_view, 6>, levels> operators{{
        {"||"},
        {"&&"},
        {"<=", ">=", "==", "!=", "<", ">"},
        {"+", "-"},
        {"*", "/"},
    }};

    Parsed parse_level(std::size_t level) {
        if (level == levels) return parse_sign();
        Parsed left = parse_level(level + 1);
        while (left) {
            const std::string_view symbol = take_operator(level);
            if (symbol.empty()) break;
            const Parsed right = parse_level(level + 1);
            if (!right) return right;
            left = join(symbol, *left, *right);
        }
        return left;
    }

    std::string_view take_operator(std::size_t level) {
        skip_blanks();
        if (rest().starts_with("**")) return {}; // of parse_power()
        for (const std::string_view symbol : operators[level])
            if (!symbol.empty() && take(symbol)) return symbol;
        return {};
    }

    Parsed parse_sign() {
        if (++depth_ > deepest_expression)
            return invalid_argument(fmt::format("the expression is nested deeper than {} times", deepest_expression));
        Parsed out = parse_sign_here();
        --depth_;
        return out;
    }

    Parsed parse_sign_here() {
        skip_blanks();
        const std::size_t begin = place_;
        if (take("+")) return parse_sign();
        const bool minus = take("-");
        if (!minus && (rest().starts_with("!=") || !take("!"))) return parse_power();
        const Parsed value = parse_sign();
        if (!value) return value;
        ExpressionNode node{.op = ExpressionOp::unary, .arguments = {*value}, .begin = begin, .end = place_};
        if (!minus) node.unary = find_function("not")->unary;
        return add(std::move(node));
    }

    Parsed parse_power() {
        const Parsed base = parse_component();
        skip_blanks();
        if (!base || !(take("**") || take("^"))) return base;
        const Parsed exponent = parse_sign(); // 2^-x^2
        return exponent ? join("^", *base, *exponent) : exponent;
    }

    Parsed parse_component() {
        const Parsed value = parse_value();
        if (!value || !take(":")) return value;
        const std::size_t begin = place_;
        while (place_ < tree_.text.size() && is_of_name(tree_.text[place_])) ++place_;
        const std::string_view name = std::string_view(tree_.text).substr(begin, place_ - begin);
        const auto scalar = parse_scalar(name);
        if (!scalar)
            return wrong_at(
                begin,
                fmt::format("a component is x, y, z, of tensors xx and so on, mag or a number from 0, not '{}'", name));
        return add({.op = scalar->magnitude ? ExpressionOp::magnitude : ExpressionOp::component,
                    .component = scalar->component,
                    .of_tensor = scalar->of_tensor,
                    .arguments = {*value},
                    .begin = tree_.nodes[*value].begin,
                    .end = place_});
    }

    Parsed parse_value() {
        skip_blanks();
        const std::size_t begin = place_;
        if (take("(")) {
            Parsed inner = parse_level(0);
            if (!inner) return inner;
            skip_blanks();
            if (!take(")")) return expected("')'");
            tree_.nodes[*inner].begin = begin;
            tree_.nodes[*inner].end = place_;
            return inner;
        }
        if (take("`")) {
            const std::size_t close = tree_.text.find('`', place_);
            if (close == std::string::npos) return wrong_at(begin, "a backquote is not closed");
            const std::string name = tree_.text.substr(place_, close - place_);
            place_ = close + 1;
            return field_or_constant(name, begin);
        }
        const char next = begin < tree_.text.size() ? tree_.text[begin] : '\0';
        if (is_digit(next) || (next == '.' && begin + 1 < tree_.text.size() && is_digit(tree_.text[begin + 1])))
            return parse_number();
        if (!begins_name(next)) return expected("a value");
        while (place_ < tree_.text.size() && is_of_name(tree_.text[place_])) ++place_;
        const std::string name = tree_.text.substr(begin, place_ - begin);
        skip_blanks();
        if (take("(")) return parse_call(name, begin);
        return field_or_constant(name, begin);
    }

    Parsed parse_number() {
        const std::size_t begin = place_;
        ExpressionNode node{.op = ExpressionOp::number, .begin = begin};
        const char* first = tree_.text.data() + begin;
        const auto [stopped, fault] = std::from_chars(first, tree_.text.data() + tree_.text.size(), node.number);
        if (fault != std::errc{}) return wrong_at(begin, "the number is too large or too small for a double");
        place_ += static_cast<std::size_t>(stopped - first);
        node.end = place_;
        return add(std::move(node));
    }

    Parsed parse_call(const std::string& name, std::size_t begin) {
        const ExpressionFunction* function = find_function(name);
        if (!function)
            return wrong_at(begin, fmt::format("there is no function '{}': there are {}", name, function_names()));
        std::vector<NodeNumber> arguments;
        do {
            const Parsed argument = parse_level(0);
            if (!argument) return argument;
            arguments.push_back(*argument);
            skip_blanks();
        } while (take(","));
        if (!take(")")) return expected("',' or ')'");
        if (arguments.size() < function->least || arguments.size() > function->most)
            return wrong_at(begin,
                            fmt::format("{}() takes {}, but {} given", name, counted(*function),
                                        arguments.size() == 1 ? "one is" : fmt::format("{} are", arguments.size())));
        if (function->of_gradient)
            arguments = {add({.op = ExpressionOp::gradient, .arguments = arguments, .begin = begin, .end = place_})};
        ExpressionNode node{.op = function->op, .unary = function->unary, .binary = function->binary, .begin = begin};
        node.end = place_;
        if (function->op != ExpressionOp::binary) {
            node.arguments = std::move(arguments);
            return add(std::move(node));
        }
        NodeNumber joined = arguments.front(); // min(a, b, c) is min(min(a, b), c)
        for (std::size_t i = 1; i < arguments.size(); ++i) {
            node.arguments = {joined, arguments[i]};
            joined = add(node);
        }
        return joined;
    }

    static std::string counted(const ExpressionFunction& function) {
        if (function.most > function.least) return fmt::format("{} or more values", function.least);
        return function.least == 1 ? "one value" : fmt::format("{} values", function.least);
    }

    Parsed field_or_constant(const std::string& name, std::size_t begin) {
        ExpressionNode node{.op = ExpressionOp::field, .begin = begin, .end = place_};
        if (auto match = match_field_name(name, names_)) {
            node.field = *std::move(match);
        } else if (name == "x" || name == "y" || name == "z") {
            node.op = ExpressionOp::coordinate;
            node.component = static_cast<std::size_t>(name[0] - 'x');
        } else if (name == "pi") {
            node.op = ExpressionOp::number;
            node.number = 3.14159265358979323846;
        } else {
            std::string there;
            for (const std::string& known : nearest_first(name, names_))
                there += fmt::format("{}'{}'", there.empty() ? "" : ", ", known);
            return wrong_at(begin, fmt::format("there is no field '{}': there {}", name,
                                               there.empty() ? "are x, y and z, the coordinates" : "is " + there));
        }
        return add(std::move(node));
    }

    NodeNumber join(std::string_view symbol, NodeNumber left, NodeNumber right) {
        constexpr std::array<std::pair<std::string_view, ExpressionOp>, 4> of_vectors{{{"+", ExpressionOp::add},
                                                                                       {"-", ExpressionOp::subtract},
                                                                                       {"*", ExpressionOp::multiply},
                                                                                       {"/", ExpressionOp::divide}}};
        ExpressionNode node{.op = ExpressionOp::binary,
                            .binary = operator_called(symbol),
                            .arguments = {left, right},
                            .begin = tree_.nodes[left].begin,
                            .end = tree_.nodes[right].end};
        for (const auto& [text, op] : of_vectors)
            if (symbol == text) node.op = op;
        return add(std::move(node));
    }

    NodeNumber add(ExpressionNode node) {
        tree_.nodes.push_back(std::move(node));
        return tree_.nodes.size() - 1;
    }

    std::string_view rest() const { return std::string_view(tree_.text).substr(place_); }

    bool take(std::string_view symbol) {
        if (!rest().starts_with(symbol)) return false;
        place_ += symbol.size();
        return true;
    }

    void skip_blanks() {
        while (place_ < tree_.text.size() && (tree_.text[place_] == ' ' || tree_.text[place_] == '\t')) ++place_;
    }

    Error wrong_at(std::size_t place, const std::string& what) const {
        return invalid_argument(fmt::format("expression '{}', character {}: {}", tree_.text, place + 1, what));
    }

    Error expected(std::string_view what) const {
        return wrong_at(place_, place_ < tree_.text.size()
                                    ? fmt::format("{} is expected, not '{}'", what, rest().substr(0, 16))
                                    : fmt::format("{} is expected, but the text ends", what));
    }

    const std::vector<std::string>& names_;
    ExpressionTree tree_;
    std::size_t place_ = 0, depth_ = 0;
};

} // namespace

Result<ExpressionTree> parse_expression(std::string_view text, const std::vector<std::string>& names) {
    return Parser(text, names).parse();
}

} // namespace core

Result<ExpressionNeeds> needs_of_expression(std::string_view text, const std::vector<std::string>& names) {
    const auto tree = core::parse_expression(text, names);
    if (!tree) return tree.error();
    ExpressionNeeds needs;
    const auto need = [&](const std::string& field) {
        if (std::ranges::find(needs.fields, field) == needs.fields.end()) needs.fields.push_back(field);
    };
    for (const core::ExpressionNode& node : tree->nodes) {
        needs.neighbours |= node.op == core::ExpressionOp::gradient;
        if (node.op != core::ExpressionOp::field) continue;
        if (node.field.parts.empty()) need(node.field.field);
        for (const std::string& part : node.field.parts) need(part);
    }
    return needs;
}

bool looks_like_expression(std::string_view text) noexcept {
    return text.find_first_of("()+-*/^<>=!&|`") != std::string_view::npos;
}

} // namespace isotet
