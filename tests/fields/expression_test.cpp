// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Fields that are computed: values against formulas, derivatives of linear fields, and every wrong text.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>
#include <isotet/make.hpp>

#include "support/mixed_grid.hpp"
#include "support/seeds.hpp"

namespace isotet::expressions {
namespace {

Field scalars(const std::string& name, std::vector<double> values) { return {name, Array::own(std::move(values))}; }
Field vectors(const std::string& name, std::vector<double> values) { return {name, Array::own(std::move(values), 3)}; }

/// Two tets on five points.
Grid two_tets() {
    Grid grid;
    grid.points = Array::own(std::vector<double>{0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 1, 1, 1}, 3);
    grid.cells.connectivity = Array::own(std::vector<std::int32_t>{0, 1, 2, 3, 1, 2, 3, 4});
    grid.point_fields = {scalars("p", {1, -2, 3, 4, 0.25}),
                         scalars("alpha.water", {0, 1, 0.5, 0.75, 1}),
                         scalars("wall distance", {1, 2, 3, 4, 5}),
                         vectors("U", {3, 4, 0, 0, 0, 0, 1, 2, 2, -1, 0, 0, 2, 3, 6}),
                         scalars("vx", {1, 2, 3, 4, 5}),
                         scalars("vy", {0, 0, 0, 0, 0}),
                         scalars("vz", {0, 0, 1, 0, 12})};
    grid.cell_fields = {scalars("k", {4, 9}), scalars("w", {2, 3})};
    return grid;
}

std::vector<double> values_of(const Grid& grid, const std::string& text) {
    const auto found = find_field(grid, text);
    EXPECT_TRUE(found) << text << ": " << (found ? "" : found.error().message);
    if (!found) return {};
    EXPECT_EQ(found->name, text);
    EXPECT_EQ(found->values.components(), 1u);
    std::vector<double> values;
    for (std::size_t i = 0; i < found->values.tuples(); ++i) values.push_back(found->values.at(i));
    return values;
}

using Values = std::vector<double>;

TEST(Expression, ComputesWhatIsWritten) {
    const Grid grid = two_tets();
    EXPECT_EQ(values_of(grid, "p + 1"), (Values{2, -1, 4, 5, 1.25}));
    EXPECT_EQ(values_of(grid, "2*p - p/4"), (Values{1.75, -3.5, 5.25, 7, 0.4375}));
    EXPECT_EQ(values_of(grid, "-p^2"), (Values{-1, -4, -9, -16, -0.0625}));
    EXPECT_EQ(values_of(grid, "2^3^2 + 0*p"), Values(5, 512));
    EXPECT_EQ(values_of(grid, "2**-1 * p"), (Values{0.5, -1, 1.5, 2, 0.125}));
    EXPECT_EQ(values_of(grid, "(p - 1) * (p + 1)"), (Values{0, 3, 8, 15, -0.9375}));
    EXPECT_EQ(values_of(grid, "8 / 2 / 2 + 0*p"), Values(5, 2));
    EXPECT_EQ(values_of(grid, "p > 0.5 && !(p > 3)"), (Values{1, 0, 1, 0, 0}));
    EXPECT_EQ(values_of(grid, "p <= -2 || p == 4"), (Values{0, 1, 0, 1, 0}));
    EXPECT_EQ(values_of(grid, "p != 1"), (Values{0, 1, 1, 1, 1}));
    EXPECT_EQ(values_of(grid, "if(alpha.water > 0.6, p, -1)"), (Values{-1, -2, -1, 4, 0.25}));
    EXPECT_EQ(values_of(grid, "`wall distance` / 2"), (Values{0.5, 1, 1.5, 2, 2.5}));
    EXPECT_EQ(values_of(grid, "min(p, 1, x)"), (Values{0, -2, 0, 0, 0.25}));
    EXPECT_EQ(values_of(grid, "max(p, z)"), (Values{1, 0, 3, 4, 1}));
    EXPECT_EQ(values_of(grid, "mod(p, 3)"), (Values{1, 1, 0, 1, 0.25}));
    EXPECT_EQ(values_of(grid, "abs(p) + sign(p) + round(p) + floor(p) + ceil(p)"), (Values{5, -5, 13, 17, 2.25}));
    EXPECT_EQ(values_of(grid, "1.5e1*p"), (Values{15, -30, 45, 60, 3.75}));
}

TEST(Expression, HasTheFunctionsOfNumbers) {
    const std::vector<std::pair<std::string, double (*)(double)>> functions{
        {"sqrt", std::sqrt}, {"exp", std::exp},   {"log", std::log},   {"log10", std::log10}, {"log2", std::log2},
        {"sin", std::sin},   {"cos", std::cos},   {"tan", std::tan},   {"asin", std::asin},   {"acos", std::acos},
        {"atan", std::atan}, {"sinh", std::sinh}, {"cosh", std::cosh}, {"tanh", std::tanh}};
    const Grid grid = two_tets();
    for (const auto& [name, function] : functions) {
        const Values found = values_of(grid, name + "(alpha.water)");
        ASSERT_EQ(found.size(), 5u) << name;
        for (std::size_t i = 0; i < found.size(); ++i)
            EXPECT_EQ(found[i], function(grid.point_fields[1].values.at(i))) << name;
    }
    EXPECT_EQ(values_of(grid, "atan2(p, 1)")[1], std::atan2(-2.0, 1.0));
    EXPECT_EQ(values_of(grid, "pow(p, 3)")[2], 27);
    EXPECT_DOUBLE_EQ(values_of(grid, "sin(pi/2) + 0*p")[0], 1);
}

TEST(Expression, TakesVectors) {
    const Grid grid = two_tets();
    EXPECT_EQ(values_of(grid, "mag(U)"), (Values{5, 0, 3, 1, 7}));
    EXPECT_EQ(values_of(grid, "U:x + U:1"), (Values{7, 0, 3, -1, 5}));
    EXPECT_EQ(values_of(grid, "U:mag^2"), (Values{25, 0, 9, 1, 49}));
    EXPECT_EQ(values_of(grid, "dot(U, U)"), (Values{25, 0, 9, 1, 49}));
    EXPECT_EQ(values_of(grid, "2*U"), (Values{10, 0, 6, 2, 14})); // by its magnitude
    EXPECT_EQ(values_of(grid, "(U - U/2):y"), (Values{2, 0, 1, 0, 1.5}));
    EXPECT_EQ(values_of(grid, "cross(U, v):z"), (Values{-4, 0, -6, 0, -15})); // of v's components
    EXPECT_EQ(values_of(grid, "mag(v)"), (Values{1, 2, std::sqrt(10.0), 4, 13}));
    EXPECT_EQ(values_of(grid, "dot(vec(1, x, p), U)"), (Values{3, 0, 7, -1, 6.5}));
    EXPECT_EQ(values_of(grid, "if(p > 0, U, 0*U):x"), (Values{3, 0, 1, -1, 2}));
}

TEST(Expression, IsFloat32WhereAllIs) {
    Grid grid = two_tets();
    grid.point_fields.push_back({"f", Array::own(std::vector<float>{1, 2, 3, 4, 5})});
    EXPECT_EQ(find_field(grid, "f/3").value().values.type(), ScalarType::float32);
    EXPECT_EQ(find_field(grid, "f/3").value().values.at(0), static_cast<double>(1.0f / 3.0f));
    EXPECT_EQ(find_field(grid, "f + 0*p").value().values.type(), ScalarType::float64);
    EXPECT_EQ(find_field(grid, "f + 0*x").value().values.type(), ScalarType::float64); // the points are
}

TEST(Expression, OfCellFieldsIsComputedInTheCells) {
    const Grid grid = two_tets();
    const PointField found = find_field(grid, "sqrt(k) * w", {Association::point, false, true}).value();
    EXPECT_TRUE(found.averaged);
    ASSERT_EQ(found.cell_values.tuples(), 2u);
    EXPECT_EQ(found.cell_values.at(0), 4);
    EXPECT_EQ(found.cell_values.at(1), 9);
    Grid other = grid;
    other.cell_fields.push_back(scalars("product", {4, 9}));
    EXPECT_EQ(values_of(grid, "sqrt(k) * w"), values_of(other, "product"));
    // With a point field cell fields are averaged first.
    const Values w = values_of(grid, "w"), mixed = values_of(grid, "w * p");
    for (std::size_t i = 0; i < w.size(); ++i) EXPECT_EQ(mixed[i], w[i] * grid.point_fields[0].values.at(i));
}

TEST(Expression, LeavesFieldsOfThatNameAlone) {
    Grid grid = two_tets();
    grid.point_fields.push_back(scalars("p-k", {7, 7, 7, 7, 7}));
    EXPECT_EQ(values_of(grid, "p-k"), Values(5, 7));
    EXPECT_EQ(values_of(grid, "`p-k` + p"), (Values{8, 5, 10, 11, 7.25}));
}

TEST(Expression, WithoutAValueIsNoData) {
    const Values roots = values_of(two_tets(), "sqrt(p)");
    EXPECT_TRUE(std::isnan(roots[1]));
    EXPECT_EQ(roots[2], std::sqrt(3.0));
    EXPECT_TRUE(std::isnan(values_of(two_tets(), "if(0/0*p > 0, 1, 2)")[0]));
    EXPECT_TRUE(std::isnan(values_of(two_tets(), "min(sqrt(p), 1)")[1]));
}

TEST(Expression, TellsWhatIsWrongAndWhere) {
    const Grid grid = two_tets();
    const std::vector<std::pair<std::string, std::string>> wrong{
        {"p +", "character 4: a value is expected, but the text ends"},
        {"(p", "character 3: ')' is expected, but the text ends"},
        {"p)", "character 2: an operator is expected, not ')'"},
        {"p p*1", "character 3: an operator is expected, not 'p*1'"},
        {"q*2", "character 1: there is no field 'q': there is 'p', "},
        {"foo(p)", "character 1: there is no function 'foo': there are abs, "},
        {"sqrt(p, 2)", "character 1: sqrt() takes one value, but 2 are given"},
        {"atan2(p)", "character 1: atan2() takes 2 values, but one is given"},
        {"min(p)", "min() takes 2 or more values, but one is given"},
        {"U:w*1", "character 3: a component is x, y, z, of tensors xx and so on, mag or a number from 0, not 'w'"},
        {"(U):3", "'(U)' has 3 components (counted from 0), but 3 is asked for"},
        {"`p", "character 1: a backquote is not closed"},
        {"1e999*p", "character 1: the number is too large or too small for a double"},
        {"U*U", "'U*U' multiplies two vectors: dot() and cross() are their products"},
        {"sqrt(U)", "'U' has 3 components, but a number is needed"},
        {"p/U", "'U' is no number, and only by numbers can be divided"},
        {"p + U", "'p + U' takes values of as many components, but they have 1 and 3"},
        {"cross(p, U)", "'p' has 1 component, but cross() takes vectors of 3"},
        {"vorticity(p)", "'vorticity(p)' takes a vector of 3 components, but what it was given has 1"},
        {"mises(U)", "'U' has 3 components, but mises() takes a tensor of 6 or 9"},
        {"vec(p, U, p)", "'U' has 3 components, but a number is needed"},
        {"if(U, p, p)", "'U' is no number, but the first value of if() is"},
        {"p ? 1 : 2", "character 3: an operator is expected"},
        {"()", "character 2: a value is expected, not ')'"},
        {std::string(200, '(') + "p" + std::string(200, ')'), "nested deeper than 100 times"},
        {"p" + std::string(5000, '+'), "an expression of 5001 characters is given, but 4096 are the most"}};
    for (const auto& [text, part] : wrong) {
        const auto found = find_field(grid, text.find_first_of("()+-*/`") == std::string::npos ? text + "+0" : text);
        ASSERT_FALSE(found) << text;
        EXPECT_EQ(found.error().code, ErrorCode::invalid_argument) << text;
        EXPECT_NE(found.error().message.find(part), std::string::npos) << found.error().message;
    }
}

TEST(Expression, NeedsTheFieldsThatItNames) {
    const std::vector<std::string> names{"p", "U", "velocity_x", "velocity_y", "velocity_z", "a b"};
    const auto needs = needs_of_expression("p*mag(velocity) + p - `a b`", names).value();
    EXPECT_EQ(needs.fields, (std::vector<std::string>{"p", "velocity_x", "velocity_y", "velocity_z", "a b"}));
    EXPECT_FALSE(needs.neighbours);
    EXPECT_TRUE(needs_of_expression("qcriterion(U)", names).value().neighbours);
    EXPECT_TRUE(needs_of_expression("x + y", names).value().fields.empty());
    EXPECT_FALSE(needs_of_expression("q", names));
    EXPECT_FALSE(looks_like_expression("alpha.water:x"));
    EXPECT_TRUE(looks_like_expression("mag(U)"));
}

TEST(Expression, TakesAnyTextWithoutHarm) {
    const std::vector<std::string> parts{"p",   "U",    "x", "1", ".5", "+", "-", "*", "/",  "^", "(",     ")",
                                         "mag", "grad", ",", ":", "`",  " ", "!", "<", "==", "&", "if(p,", "\xC3\xA9"};
    const Grid grid = two_tets();
    std::size_t sound = 0;
    for (const std::uint32_t seed : test::Seeds(1, 1000)) {
        std::mt19937 random(seed);
        std::string text = "(";
        for (std::uint32_t i = random() % 8; i < 9; ++i) text += parts[random() % parts.size()];
        const auto found = find_field(grid, text + (random() % 2 ? ")" : ""));
        if (found) ++sound;
        else EXPECT_EQ(found.error().code, ErrorCode::invalid_argument) << text;
    }
    const bool all_seeds = !std::getenv("ISOTET_SEED");
    EXPECT_TRUE(sound > 0 || !all_seeds);
}

/// A grid with a linear field "f" = 3 x - 2 y + z / 2 + 1 and a vector "u" of such, and with points in double, so that
/// those that are made inside of cells are not rounded.
Grid with_linear_fields(Grid grid) {
    std::vector<double> f, u, places;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i) {
        const double x = grid.points.at(i, 0), y = grid.points.at(i, 1), z = grid.points.at(i, 2);
        f.push_back(3 * x - 2 * y + z / 2 + 1);
        for (const double value : {x + 2 * y + 3 * z, 4 * x + 5 * y + 6 * z, 7 * x + 8 * y - 9 * z}) u.push_back(value);
        places.insert(places.end(), {x, y, z});
    }
    grid.points = Array::own(std::move(places), 3);
    grid.point_fields = {scalars("f", std::move(f)), vectors("u", std::move(u))};
    grid.cell_fields.clear();
    return grid;
}

void expect_all_near(const Grid& grid, const std::string& text, double expected) {
    const Values values = values_of(grid, text);
    std::size_t counted = 0;
    for (const double value : values) {
        if (std::isnan(value)) continue;
        ++counted;
        ASSERT_NEAR(value, expected, 1e-9 * (1 + std::abs(expected))) << text;
    }
    EXPECT_GT(counted, values.size() / 2) << text;
}

TEST(Expression, DerivativesOfLinearFieldsAreExactOnAllKindsOfCells) {
    for (const char* shape :
         {"shuffled", "hex", "wedge", "pyramid", "mixed", "tet10", "curved", "hex27", "kelvin", "octree-bent"}) {
        SCOPED_TRACE(shape);
        MakeOptions make;
        make.shape = shape;
        make.side = 3;
        make.fields = {"sphere"};
        const Grid grid = with_linear_fields(make_grid(make).value());
        expect_all_near(grid, "grad(f):x + 10*grad(f):y + 100*grad(f):z", 33);
        expect_all_near(grid, "div(u)", -3);
        expect_all_near(grid, "vorticity(u):x + 10*vorticity(u):y + 100*vorticity(u):z", 162);
        expect_all_near(grid, "qcriterion(u)", -0.5 * (1 + 25 + 81) - (8 + 21 + 48));
    }
    for (const std::uint32_t seed : test::Seeds(1, 6)) {
        test::MixedOptions options;
        options.moved = 0.2;
        options.missing = 0.1;
        options.collapsed = 0.05;
        options.wide = true;
        const Grid grid = with_linear_fields(test::mixed_grid(seed, options).grid);
        expect_all_near(grid, "grad(f):y", -2);
        expect_all_near(grid, "div(u)", -3);
    }
}

TEST(Expression, OfFlowsHasTheirInvariants) {
    MakeOptions make;
    make.shape = "mixed";
    make.side = 4;
    Grid grid = make_grid(make).value();
    const auto flow = [&](const std::function<std::array<double, 3>(double, double, double)>& at) {
        std::vector<double> u;
        for (std::size_t i = 0; i < grid.points.tuples(); ++i)
            for (const double value : at(grid.points.at(i, 0), grid.points.at(i, 1), grid.points.at(i, 2)))
                u.push_back(value);
        grid.point_fields = {vectors("u", std::move(u))};
    };
    flow([](double x, double y, double) { return std::array<double, 3>{-y, x, 0}; }); // turns
    expect_all_near(grid, "vorticity(u)", 2);
    expect_all_near(grid, "qcriterion(u)", 1);
    expect_all_near(grid, "lambda2(u)", -1);
    flow([](double x, double y, double z) { return std::array<double, 3>{x, y, -2 * z}; }); // strains
    expect_all_near(grid, "div(u)", 0);
    expect_all_near(grid, "qcriterion(u)", -3);
    expect_all_near(grid, "lambda2(u)", 1);
}

TEST(Expression, OfStressesHasVonMises) {
    Grid grid = two_tets();
    Values six, nine;
    for (const auto& [xx, yy, zz, xy, yz, xz] : std::vector<std::array<double, 6>>{
             {100, 0, 0, 0, 0, 0}, {5, 5, 5, 0, 0, 0}, {0, 0, 0, 10, 0, 0}, {0, 0, 0, 0, 10, 0}, {1, 2, 3, 4, 5, 6}}) {
        six.insert(six.end(), {xx, yy, zz, xy, yz, xz});
        nine.insert(nine.end(), {xx, xy, xz, xy, yy, yz, xz, yz, zz});
    }
    grid.point_fields = {{"s6", Array::own(std::move(six), 6)}, {"s9", Array::own(std::move(nine), 9)}};
    const Values expected{100, 0, std::sqrt(300.0), std::sqrt(300.0), std::sqrt(0.5 * 6 + 3 * 77.0)};
    EXPECT_EQ(values_of(grid, "mises(s6)"), expected);
    EXPECT_EQ(values_of(grid, "mises(s9)"), expected);
}

TEST(Expression, HasDerivativesOfSecondOrderOnRegularGrids) {
    std::vector<double> errors;
    for (const std::uint64_t side : {8, 16}) {
        MakeOptions make;
        make.shape = "hex";
        make.side = side;
        const Grid grid = make_grid(make).value();
        const Values found = values_of(grid, "grad(sin(3*x)*cos(y)):x");
        double worst = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const double x = grid.points.at(i, 0), y = grid.points.at(i, 1);
            if (std::abs(std::abs(x) - 1) > 1e-6)
                worst = std::max(worst, std::abs(found[i] - 3 * std::cos(3 * x) * std::cos(y)));
        }
        errors.push_back(worst);
    }
    EXPECT_GT(errors[0] / errors[1], 3.5);
}

TEST(Expression, IsTheSameForAnyThreads) {
    const Grid grid = with_linear_fields(test::mixed_grid(3, {}).grid);
    const std::string text = "lambda2(u*f) + sin(f)";
    const Array one = find_field(grid, text, {}, {.threads = 1}).value().values;
    for (const int threads : {2, 7}) {
        const Array other = find_field(grid, text, {}, {.threads = threads}).value().values;
        ASSERT_EQ(other.bytes(), one.bytes());
        EXPECT_EQ(std::memcmp(other.data(), one.data(), one.bytes()), 0);
    }
}

} // namespace
} // namespace isotet::expressions
