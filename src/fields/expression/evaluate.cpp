// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "fields/expression/evaluate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/buffer.hpp"
#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "fields/expression/tensor.hpp"
#include "grid/values/scalar_of.hpp"

namespace isotet::core {

namespace {

std::optional<std::size_t> place_of(const ExpressionNode& node, std::size_t components) {
    return Scalar{node.component, false, node.of_tensor}.place_in(components);
}

constexpr std::size_t block_size = 512, blocks_a_task = 16;

/// A node in the order of computing, and where its block of values stands.
struct Step {
    const ExpressionNode* node = nullptr;
    Array values;               ///< of leaves
    std::size_t components = 1; ///< a row of `block_size` values each
    std::size_t row = 0;        ///< its first row
    std::vector<std::size_t> arguments;
};

class Evaluation {
public:
    Evaluation(const ExpressionTree& tree, const ExpressionSource& source, const Progress& progress)
        : tree_(tree), source_(source), progress_(progress) {}

    Result<Array> scalar() {
        auto steps = plan(tree_.nodes.size() - 1);
        if (!steps) return steps.error();
        const std::size_t components = steps->back().components;
        if (components == 3) {
            if (steps->back().node->op == ExpressionOp::field)
                return wrong(tree_.nodes.back(), "has 3 components, but one is needed: add ':x' or ':mag'");
            Step length{&magnitude_, {}, 1, rows_of(*steps), {steps->size() - 1}};
            steps->push_back(std::move(length));
        } else if (components != 1) {
            return wrong(tree_.nodes.back(), fmt::format("has {} components, but one is needed", components));
        }
        return is_narrow_ ? run<float>(*steps) : run<double>(*steps);
    }

private:
    using Steps = std::vector<Step>;

    /// What to compute for a node, gradients below it already as arrays.
    Result<Steps> plan(std::size_t root) {
        std::vector<bool> is_needed(root + 1);
        is_needed[root] = true;
        for (std::size_t number = root + 1; number-- > 0;)
            if (is_needed[number] && tree_.nodes[number].op != ExpressionOp::gradient)
                for (const std::size_t argument : tree_.nodes[number].arguments) is_needed[argument] = true;
        Steps steps;
        std::vector<std::size_t> step_of(root + 1);
        for (std::size_t number = 0; number <= root; ++number) {
            if (!is_needed[number]) continue;
            auto step = plan_node(tree_.nodes[number], step_of, steps);
            if (!step) return step.error();
            step->row = rows_of(steps);
            step_of[number] = steps.size();
            steps.push_back(*std::move(step));
        }
        return steps;
    }

    Result<Step> plan_node(const ExpressionNode& node, const std::vector<std::size_t>& step_of, const Steps& steps) {
        Step step;
        step.node = &node;
        if (node.op == ExpressionOp::field || node.op == ExpressionOp::coordinate ||
            node.op == ExpressionOp::gradient) {
            auto values = node.op == ExpressionOp::gradient ? gradient_of(node.arguments[0]) : source_.values_of(node);
            if (!values) return values.error();
            if (node.op != ExpressionOp::gradient) is_narrow_ &= values->type() == ScalarType::float32;
            step.values = *std::move(values);
            step.components = step.values.components();
            return step;
        }
        for (const std::size_t argument : node.arguments) step.arguments.push_back(step_of[argument]);
        const auto components = components_of(node, step.arguments, steps);
        if (!components) return components.error();
        step.components = *components;
        return step;
    }

    static std::size_t rows_of(const Steps& steps) {
        return steps.empty() ? 0 : steps.back().row + steps.back().components;
    }

    Result<Array> gradient_of(std::size_t number) {
        auto steps = plan(number);
        if (!steps) return steps.error();
        const std::size_t components = steps->back().components;
        if (components != 1 && components != 3)
            return wrong(tree_.nodes[number],
                         fmt::format("has {} components, but derivatives are taken of 1 or 3", components));
        auto values = run<double>(*steps);
        if (!values) return values;
        return source_.gradient_of(*values);
    }

    Error wrong(const ExpressionNode& node, std::string_view what) const {
        return invalid_argument(fmt::format("expression '{}': '{}' {}", tree_.text, tree_.text_of(node), what));
    }

    /// How many components a node has whose arguments are planned.
    Result<std::size_t> components_of(const ExpressionNode& node, std::span<const std::size_t> arguments,
                                      const Steps& steps) const {
        const auto of = [&](std::size_t i) { return steps[arguments[i]].components; };
        const auto argument = [&](std::size_t i) -> const ExpressionNode& { return *steps[arguments[i]].node; };
        const auto need = [&](std::initializer_list<std::size_t> allowed,
                              std::string_view rule) -> std::optional<Error> {
            for (std::size_t i = 0; i < arguments.size(); ++i)
                if (std::ranges::find(allowed, of(i)) == allowed.end())
                    return wrong(argument(i),
                                 fmt::format("has {} component{}, but {}", of(i), of(i) == 1 ? "" : "s", rule));
            return std::nullopt;
        };
        const auto either = [](std::optional<Error> error, std::size_t components) -> Result<std::size_t> {
            if (error) return *std::move(error);
            return components;
        };
        constexpr std::string_view one = "a number is needed: add ':x', or take mag() of it";
        switch (node.op) {
        case ExpressionOp::number:
        case ExpressionOp::field:
        case ExpressionOp::coordinate:
        case ExpressionOp::gradient: break;
        case ExpressionOp::component:
            if (!place_of(node, of(0)))
                return wrong(argument(0), fmt::format("has {} component{} (counted from 0), but {} is asked for", of(0),
                                                      of(0) == 1 ? "" : "s",
                                                      node.of_tensor ? std::string("one of a tensor")
                                                                     : std::to_string(node.component)));
            break;
        case ExpressionOp::magnitude: break;
        case ExpressionOp::unary:
            if (!node.unary) return of(0);
            return either(need({1}, one), 1);
        case ExpressionOp::binary: return either(need({1}, one), 1);
        case ExpressionOp::choose:
            if (of(0) != 1) return wrong(argument(0), "is no number, but the first value of if() is");
            [[fallthrough]];
        case ExpressionOp::add:
        case ExpressionOp::subtract: {
            const std::size_t last = arguments.size() - 1;
            if (of(last - 1) != of(last))
                return wrong(node, fmt::format("takes values of as many components, but they have {} and {}",
                                               of(last - 1), of(last)));
            return of(last);
        }
        case ExpressionOp::multiply:
            if (of(0) != 1 && of(1) != 1)
                return wrong(node, "multiplies two vectors: dot() and cross() are their products");
            return std::max(of(0), of(1));
        case ExpressionOp::divide:
            if (of(1) != 1) return wrong(argument(1), "is no number, and only by numbers can be divided");
            return of(0);
        case ExpressionOp::dot:
            if (of(0) != of(1))
                return wrong(node,
                             fmt::format("takes vectors of as many components, but they have {} and {}", of(0), of(1)));
            break;
        case ExpressionOp::vector: return either(need({1}, one), 3);
        case ExpressionOp::cross: return either(need({3}, "cross() takes vectors of 3"), 3);
        case ExpressionOp::trace:
        case ExpressionOp::q_criterion:
        case ExpressionOp::lambda2:
        case ExpressionOp::curl:
            if (of(0) != 9) // which is the gradient
                return wrong(node,
                             fmt::format("takes a vector of 3 components, but what it was given has {}", of(0) / 3));
            return std::size_t{node.op == ExpressionOp::curl ? 3U : 1U};
        case ExpressionOp::mises: return either(need({6, 9}, "mises() takes a tensor of 6 or 9"), 1);
        }
        return std::size_t{1};
    }

    template <class Value>
    Result<Array> run(const Steps& steps) const {
        const std::size_t rows = rows_of(steps), width = steps.back().components;
        Buffer<Value> out(source_.tuples * width);
        parallel_pieces(source_.tuples, block_size * blocks_a_task, progress_, [&](std::size_t begin, std::size_t end) {
            std::vector<double> values(rows * block_size);
            for (std::size_t first = begin; first < end; first += block_size) {
                const std::size_t count = std::min(block_size, end - first);
                for (const Step& step : steps) compute(steps, step, first, count, values.data());
                const double* last = values.data() + steps.back().row * block_size;
                for (std::size_t c = 0; c < width; ++c)
                    for (std::size_t i = 0; i < count; ++i)
                        out[(first + i) * width + c] = static_cast<Value>(last[c * block_size + i]);
            }
        });
        if (progress_.cancelled()) return Error{ErrorCode::cancelled, "computing the field was cancelled"};
        return std::move(out).to_array(width);
    }

    /// One block of one node: rows of `values`, one a component.
    static void compute(const Steps& steps, const Step& step, std::size_t first, std::size_t count, double* values) {
        const ExpressionNode& node = *step.node;
        double* out = values + step.row * block_size;
        const auto row = [&](std::size_t argument, std::size_t component) -> const double* {
            return values + (steps[step.arguments[argument]].row + component) * block_size;
        };
        const auto width = [&](std::size_t argument) { return steps[step.arguments[argument]].components; };
        const auto each = [&](const auto& value) { // of each component, as value(component, place)
            for (std::size_t c = 0; c < step.components; ++c)
                for (std::size_t i = 0; i < count; ++i) out[c * block_size + i] = value(c, i);
        };
        /// As each(), of two values, of which one may be a number.
        const auto join = [&](const auto& value) {
            for (std::size_t c = 0; c < step.components; ++c) {
                const double *a = row(0, width(0) == 1 ? 0 : c), *b = row(1, width(1) == 1 ? 0 : c);
                for (std::size_t i = 0; i < count; ++i) out[c * block_size + i] = value(a[i], b[i]);
            }
        };
        const auto tensor = [&](const auto& value) { // of the components of the argument
            std::vector<double> all(width(0));
            for (std::size_t i = 0; i < count; ++i) {
                for (std::size_t c = 0; c < all.size(); ++c) all[c] = row(0, c)[i];
                out[i] = value(std::span<const double>(all));
            }
        };
        switch (node.op) {
        case ExpressionOp::number: each([&](std::size_t, std::size_t) { return node.number; }); break;
        case ExpressionOp::field:
        case ExpressionOp::gradient:
            step.values.visit([&](auto typed) {
                const auto* from = typed.data() + first * step.components;
                each([&](std::size_t c, std::size_t i) { return static_cast<double>(from[i * step.components + c]); });
            });
            break;
        case ExpressionOp::coordinate:
            step.values.visit([&](auto typed) {
                each([&](std::size_t, std::size_t i) { return static_cast<double>(typed[first + i]); });
            });
            break;
        case ExpressionOp::component: std::copy_n(row(0, *place_of(node, width(0))), count, out); break;
        case ExpressionOp::unary:
            if (node.unary) each([&](std::size_t, std::size_t i) { return node.unary(row(0, 0)[i]); });
            else each([&](std::size_t c, std::size_t i) { return -row(0, c)[i]; });
            break;
        case ExpressionOp::binary: join(node.binary); break;
        case ExpressionOp::choose:
            each([&](std::size_t c, std::size_t i) {
                const double condition = row(0, 0)[i];
                return std::isnan(condition) ? condition : row(condition != 0 ? 1 : 2, c)[i];
            });
            break;
        case ExpressionOp::add: join([](double a, double b) { return a + b; }); break;
        case ExpressionOp::subtract: join([](double a, double b) { return a - b; }); break;
        case ExpressionOp::multiply: join([](double a, double b) { return a * b; }); break;
        case ExpressionOp::divide: join([](double a, double b) { return a / b; }); break;
        case ExpressionOp::magnitude: {
            std::array<double, block_size> largest{};
            std::fill_n(out, count, 0.0);
            for (std::size_t c = 0; c < width(0); ++c) {
                const double* from = row(0, c);
                for (std::size_t i = 0; i < count; ++i) {
                    largest[i] = std::max(largest[i], std::abs(from[i]));
                    out[i] += from[i] * from[i];
                }
            }
            for (std::size_t i = 0; i < count; ++i) out[i] = std::sqrt(out[i]);
            const auto is_plain = [](double x) { return x > 0x1p-500 && x < 0x1p500; };
            if (!std::all_of(largest.begin(), largest.begin() + static_cast<std::ptrdiff_t>(count), is_plain))
                tensor([](std::span<const double> v) { return magnitude_of(v.data(), v.size()); });
            break;
        }
        case ExpressionOp::dot:
            each([&](std::size_t, std::size_t i) {
                double sum = 0;
                for (std::size_t c = 0; c < width(0); ++c) sum += row(0, c)[i] * row(1, c)[i];
                return sum;
            });
            break;
        case ExpressionOp::cross:
            each([&](std::size_t c, std::size_t i) {
                const std::size_t d = (c + 1) % 3, e = (c + 2) % 3;
                return row(0, d)[i] * row(1, e)[i] - row(0, e)[i] * row(1, d)[i];
            });
            break;
        case ExpressionOp::vector:
            for (std::size_t c = 0; c < 3; ++c) std::copy_n(row(c, 0), count, out + c * block_size);
            break;
        case ExpressionOp::trace: tensor([](std::span<const double> g) { return g[0] + g[4] + g[8]; }); break;
        case ExpressionOp::curl:
            each([&](std::size_t c, std::size_t i) {
                const std::size_t d = (c + 1) % 3, e = (c + 2) % 3;
                return row(0, 3 * e + d)[i] - row(0, 3 * d + e)[i];
            });
            break;
        case ExpressionOp::q_criterion: tensor(q_criterion); break;
        case ExpressionOp::lambda2: tensor(lambda2); break;
        case ExpressionOp::mises: tensor(von_mises); break;
        }
    }

    const ExpressionTree& tree_;
    const ExpressionSource& source_;
    const Progress& progress_;
    ExpressionNode magnitude_{.op = ExpressionOp::magnitude};
    bool is_narrow_ = true;
};

} // namespace

Result<Array> evaluate_expression(const ExpressionTree& tree, const ExpressionSource& source,
                                  const Progress& progress) {
    return Evaluation(tree, source, progress).scalar();
}

} // namespace isotet::core
