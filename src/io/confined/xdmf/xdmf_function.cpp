// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/xdmf/xdmf_function.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "io/files/escape.hpp"
#include "io/files/text_scanner.hpp"

namespace isotet::io::confined {
namespace {

using Values = std::vector<double>;
using Calculation = double (*)(double);

constexpr int deepest_brackets = 50;

struct NamedCalculation {
    std::string_view name;
    Calculation calculate;
};
constexpr NamedCalculation calculations[] = {
    {"ABS", [](double x) { return std::abs(x); }},   {"SQRT", [](double x) { return std::sqrt(x); }},
    {"SIN", [](double x) { return std::sin(x); }},   {"COS", [](double x) { return std::cos(x); }},
    {"TAN", [](double x) { return std::tan(x); }},   {"ASIN", [](double x) { return std::asin(x); }},
    {"ACOS", [](double x) { return std::acos(x); }}, {"ATAN", [](double x) { return std::atan(x); }},
    {"EXP", [](double x) { return std::exp(x); }},   {"LOG", [](double x) { return std::log(x); }},
};

double apply(char sign, double a, double b) {
    switch (sign) {
    case '+': return a + b;
    case '-': return a - b;
    case '*': return a * b;
    default: return a / b;
    }
}

class Expression {
public:
    Expression(std::string_view text, const std::vector<Array>& items) : text_(text), left_(text), items_(items) {}

    Result<Values> evaluate() {
        auto values = sum(0);
        if (!values) return values;
        if (next() != '\0') return wrong(fmt::format("ends before '{}'", next()));
        return values;
    }

private:
    Error wrong(std::string_view what) const {
        return {ErrorCode::invalid_data, fmt::format("the function \"{}\" {}", escaped(text_.substr(0, 80)), what)};
    }
    char next() {
        while (!left_.empty() && is_space(left_.front())) left_.remove_prefix(1);
        return left_.empty() ? '\0' : left_.front();
    }
    bool take(char c) {
        if (next() != c) return false;
        left_.remove_prefix(1);
        return true;
    }

    Result<Values> combined(char sign, Values a, const Values& b) const {
        if (a.size() != b.size() && a.size() != 1 && b.size() != 1)
            return wrong(fmt::format("takes {} and {} values together", a.size(), b.size()));
        Values out(std::max(a.size(), b.size()));
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = apply(sign, a[a.size() == 1 ? 0 : i], b[b.size() == 1 ? 0 : i]);
        return out;
    }
    Result<Values> sum(int depth) {
        auto values = product(depth);
        while (values && (next() == '+' || next() == '-')) {
            const char sign = left_.front();
            left_.remove_prefix(1);
            const auto other = product(depth);
            if (!other) return other;
            values = combined(sign, *std::move(values), *other);
        }
        return values;
    }
    Result<Values> product(int depth) {
        auto values = factor(depth);
        while (values && (next() == '*' || next() == '/')) {
            const char sign = left_.front();
            left_.remove_prefix(1);
            const auto other = factor(depth);
            if (!other) return other;
            values = combined(sign, *std::move(values), *other);
        }
        return values;
    }
    Result<Values> factor(int depth) {
        if (depth > deepest_brackets) return wrong("has brackets within brackets without end");
        if (take('-')) {
            auto values = factor(depth + 1);
            if (values)
                for (double& value : *values) value = -value;
            return values;
        }
        if (take('(')) return closed(sum(depth + 1));
        if (take('$')) return item();
        double number = 0;
        next();
        const auto [end, error] = std::from_chars(left_.data(), left_.data() + left_.size(), number);
        if (error == std::errc{}) {
            left_.remove_prefix(static_cast<std::size_t>(end - left_.data()));
            return Values{number};
        }
        return named(depth);
    }
    Result<Values> closed(Result<Values> values) {
        if (values && !take(')')) return wrong("has a bracket that is not closed");
        return values;
    }
    Result<Values> item() {
        std::size_t number = 0;
        const auto [end, error] = std::from_chars(left_.data(), left_.data() + left_.size(), number);
        if (error != std::errc{}) return wrong("has a $ without a number");
        left_.remove_prefix(static_cast<std::size_t>(end - left_.data()));
        if (number >= items_.size()) return wrong(fmt::format("has ${}, but {} items", number, items_.size()));
        Values values(items_[number].size());
        items_[number].visit([&](auto from) {
            for (std::size_t i = 0; i < from.size(); ++i) values[i] = static_cast<double>(from[i]);
        });
        return values;
    }
    Result<Values> named(int depth) {
        std::size_t length = 0;
        while (length < left_.size() && ((left_[length] | 32) >= 'a' && (left_[length] | 32) <= 'z')) ++length;
        std::string name(left_.substr(0, length));
        for (char& c : name) c = static_cast<char>(c & ~32);
        left_.remove_prefix(length);
        const auto* const known = std::ranges::find(calculations, std::string_view(name), &NamedCalculation::name);
        if ((known == std::end(calculations) && name != "JOIN") || !take('('))
            return wrong(fmt::format("is not read from '{}' on", escaped(name + std::string(left_.substr(0, 20)))));
        if (name == "JOIN") return closed(joined(depth + 1));
        auto values = closed(sum(depth + 1));
        if (values)
            for (double& value : *values) value = known->calculate(value);
        return values;
    }
    Result<Values> joined(int depth) {
        std::vector<Values> parts;
        char mark = '\0';
        do {
            auto part = sum(depth);
            if (!part) return part;
            parts.push_back(*std::move(part));
            if (mark == '\0' && (next() == ',' || next() == ';')) mark = next();
        } while (mark != '\0' && take(mark));
        Values out;
        if (mark != ',') {
            for (const Values& part : parts) out.insert(out.end(), part.begin(), part.end());
            return out;
        }
        for (const Values& part : parts)
            if (part.size() != parts.front().size())
                return wrong(fmt::format("joins {} and {} values by turns", parts.front().size(), part.size()));
        out.reserve(parts.size() * parts.front().size());
        for (std::size_t i = 0; i < parts.front().size(); ++i)
            for (const Values& part : parts) out.push_back(part[i]);
        return out;
    }

    std::string_view text_, left_;
    const std::vector<Array>& items_;
};

} // namespace

Result<std::vector<double>> evaluate_function(std::string_view expression, const std::vector<Array>& items) {
    return Expression(expression, items).evaluate();
}

} // namespace isotet::io::confined
