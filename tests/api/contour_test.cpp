// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The session gives the surfaces of the functions that it stands for, and keeps what may be kept.
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numeric>
#include <string_view>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/contour.hpp>
#include <isotet/extract.hpp>
#include <isotet/make.hpp>

#include "support/small_grid.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {
namespace {

Grid kuhn(std::uint64_t side = 8) {
    return make_grid({.shape = "kuhn", .side = side, .fields = {"gyroid", "sphere"}}).value();
}

ContourInput input_of(const Grid& grid, std::size_t field = 0) { return {grid, point_field(grid, field), {}, {}}; }

/// The same contents in memory of their own.
Array copy_of(const Array& array) {
    return array.visit([&]<class T>(std::span<const T> values) {
        return Array::own(std::vector<T>(values.begin(), values.end()), array.components());
    });
}

Grid copy_of(const Grid& grid) {
    Grid copy = grid;
    copy.points = copy_of(grid.points);
    copy.cells.connectivity = copy_of(grid.cells.connectivity);
    for (Field& field : copy.point_fields) field.values = copy_of(field.values);
    return copy;
}

std::string direct_bytes(const Grid& grid, std::size_t field, double isovalue) {
    return bytes_of(
        extract_direct(grid, point_field(grid, field), std::span(&isovalue, 1)).value().surfaces[0].surface);
}

std::string packed_bytes(const Grid& grid, std::size_t field, double isovalue) {
    return bytes_of(extract(pack(grid, point_field(grid, field)).value(), isovalue).value().surface);
}

TEST(Contour, ExtractsDirectlyForAFewSurfacesAndPacksForMany) {
    const Grid grid = kuhn();
    Contour contour = Contour::create(input_of(grid)).value();
    for (std::uint64_t i = 1; i <= surfaces_that_pay_for_packing; ++i) {
        const double isovalue = 0.01 * static_cast<double>(i);
        const ContourResult result = contour.extract(isovalue).value();
        ASSERT_EQ(result.surfaces.size(), 1u);
        const bool packed = i == surfaces_that_pay_for_packing;
        EXPECT_EQ(result.method, packed ? Method::clusters : Method::direct);
        EXPECT_EQ(bytes_of(result.surfaces[0].surface),
                  packed ? packed_bytes(grid, 0, isovalue) : direct_bytes(grid, 0, isovalue));
    }
    EXPECT_EQ(contour.extract(0.5).value().pack_seconds, 0) << "packed once";
}

TEST(Contour, OfArraysIsThatOfASession) {
    const Grid grid = kuhn();
    const Array values = point_field(grid, 0).values;
    const Surface surface = contour(grid.points, grid.cells, values, 0.1).value();
    EXPECT_EQ(bytes_of(surface), direct_bytes(grid, 0, 0.1));
    EXPECT_GT(surface.triangle_count(), 0u);
    const Array wrong = Array::own(std::vector<float>(3));
    EXPECT_EQ(contour(grid.points, grid.cells, wrong, 0.1).error().code, ErrorCode::invalid_argument);
}

TEST(Contour, TellsWhichCellTypesItContours) {
    for (int type = 0; type < 256; ++type) {
        const bool contoured = (type >= 10 && type <= 16) || type == 42;
        EXPECT_EQ(Contour::contours(static_cast<std::uint8_t>(type)), contoured) << type;
    }
}

/// Seen by a change in place, which the same owner hides.
TEST(Contour, KnowsEqualCellsAndPointsByTheMemoryThatItMetLast) {
    const Grid first = kuhn();
    Contour contour = Contour::create(input_of(first), {.surfaces = 100}).value();
    ASSERT_TRUE(contour.extract(0.1));
    Grid second = copy_of(first);
    std::vector<float> points(first.points.as<float>().begin(), first.points.as<float>().end());
    const auto owner = std::make_shared<int>(0);
    second.points = Array(ScalarType::float32, points.data(), first.points.tuples(), 3, owner);
    EXPECT_EQ(contour.set(input_of(second)).value(), ContourUpdate::nothing);
    points[0] += 1;
    EXPECT_EQ(contour.set(input_of(second)).value(), ContourUpdate::nothing);
    second.points = Array(ScalarType::float32, points.data(), first.points.tuples(), 3, std::make_shared<int>(0));
    EXPECT_EQ(contour.set(input_of(second)).value(), ContourUpdate::points);
}

TEST(Contour, KnowsFromTheStartHowManySurfacesWillBeAskedFor) {
    const Grid grid = kuhn();
    Contour contour = Contour::create(input_of(grid), {.surfaces = 100}).value();
    EXPECT_EQ(contour.method(), Method::clusters);
    EXPECT_EQ(bytes_of(contour.extract(0.1).value().surfaces[0].surface), packed_bytes(grid, 0, 0.1));
    Contour few = Contour::create(input_of(grid), {.surfaces = 3}).value();
    EXPECT_EQ(few.method(1000), Method::direct);
    Contour shaded = Contour::create(input_of(grid), {.surfaces = 4, .normals = Normals::gradient}).value();
    EXPECT_EQ(shaded.method(), Method::clusters);
}

/// Prepares the session, with `meanwhile` on another thread once packing has begun.
void prepare_beside(Contour& contour, const std::function<void()>& meanwhile) {
    std::atomic<bool> done{false};
    Run run;
    run.progress.report = [&](std::string_view, double) {
        if (!done.exchange(true)) std::thread(meanwhile).join();
    };
    const Result<void> ready = contour.prepare(run);
    ASSERT_TRUE(ready) << ready.error().message;
    ASSERT_TRUE(done) << "nothing was packed";
}

TEST(Contour, ExtractsDirectlyWhileItPacks) {
    const Grid grid = kuhn(16);
    Contour contour = Contour::create(input_of(grid), {.surfaces = 100, .extract_while_packing = true}).value();
    prepare_beside(contour, [&] {
        const ContourResult result = contour.extract(0.1).value();
        EXPECT_EQ(result.method, Method::direct);
        EXPECT_EQ(bytes_of(result.surfaces[0].surface), direct_bytes(grid, 0, 0.1));
    });
    const ContourResult result = contour.extract(0.1).value();
    EXPECT_EQ(result.method, Method::clusters);
    EXPECT_EQ(bytes_of(result.surfaces[0].surface), packed_bytes(grid, 0, 0.1));
}

TEST(Contour, PacksWhatWasSetWhileItPacked) {
    const Grid grid = kuhn(16), other = kuhn(11);
    const ContourOptions options{.extract_while_packing = true};
    for (const ContourInput& next : {input_of(grid, 1), input_of(other, 1)}) {
        Contour contour = Contour::create(input_of(grid), options).value();
        prepare_beside(contour, [&] {
            ASSERT_TRUE(contour.set(next));
            EXPECT_EQ(bytes_of(contour.extract(0.4).value().surfaces[0].surface), direct_bytes(next.grid, 1, 0.4));
        });
        const ContourResult result = contour.extract(0.4).value();
        EXPECT_EQ(result.method, Method::clusters);
        EXPECT_EQ(bytes_of(result.surfaces[0].surface), packed_bytes(next.grid, 1, 0.4));
        ASSERT_TRUE(contour.set(input_of(other))) << "another grid is not packed before prepare() is called";
        EXPECT_EQ(contour.extract(0.1).value().method,
                  next.grid.points.data() == other.points.data() ? Method::clusters : Method::direct);
        ASSERT_TRUE(contour.prepare());
        EXPECT_EQ(bytes_of(contour.extract(0.1).value().surfaces[0].surface), packed_bytes(other, 0, 0.1));
    }
}

TEST(Contour, PacksAllPolyhedraWhileItHasThoseThatIsovaluesMeet) {
    const Grid grid = make_grid({.shape = "kelvin", .side = 6, .fields = {"gyroid", "sphere"}}).value();
    ContourOptions options{.surfaces = 1, .source_cells = true, .expected_isovalues = {0.1}};
    options.extract_while_packing = true;
    Contour contour = Contour::create(input_of(grid), options).value();
    const std::uint64_t met = contour.linear_grid()->grid.cells.count();
    const auto bytes_by = [&](Method method, double isovalue) {
        Contour one = Contour::create(input_of(grid), {.method = method, .source_cells = true}).value();
        return bytes_of(one.extract(isovalue).value().surfaces[0].surface);
    };
    prepare_beside(contour, [&] {
        options.expected_isovalues = {0.3};
        ASSERT_TRUE(contour.set(input_of(grid), options));
        EXPECT_EQ(bytes_of(contour.extract(0.3).value().surfaces[0].surface), bytes_by(Method::direct, 0.3));
    });
    EXPECT_LT(met, contour.linear_grid()->grid.cells.count());
    EXPECT_EQ(contour.method(), Method::clusters);
    EXPECT_EQ(bytes_of(contour.extract(0.7).value().surfaces[0].surface), bytes_by(Method::clusters, 0.7));
}

TEST(Contour, TakesTheMethodThatIsAskedFor) {
    const Grid grid = kuhn();
    const std::array isovalues{0.1, 0.7, -0.3};
    for (const Method method : {Method::direct, Method::clusters}) {
        Contour contour = Contour::create(input_of(grid), {.method = method}).value();
        const ContourResult result = contour.extract(isovalues).value();
        EXPECT_EQ(result.method, method);
        ASSERT_EQ(result.surfaces.size(), isovalues.size());
        for (std::size_t i = 0; i < isovalues.size(); ++i)
            EXPECT_EQ(bytes_of(result.surfaces[i].surface), method == Method::direct
                                                                ? direct_bytes(grid, 0, isovalues[i])
                                                                : packed_bytes(grid, 0, isovalues[i]));
        EXPECT_EQ(contour.packed().has_value(), method == Method::clusters);
    }
}

TEST(Contour, FindsOutWhatIsTheSame) {
    const Grid grid = kuhn();
    Contour contour = Contour::create(input_of(grid), {.method = Method::clusters}).value();
    contour.prepare().value();
    EXPECT_EQ(contour.set(input_of(grid)).value(), ContourUpdate::nothing);
    EXPECT_EQ(contour.set(input_of(copy_of(grid), 1)).value(), ContourUpdate::field) << "the same, elsewhere in memory";
    EXPECT_EQ(bytes_of(contour.extract(0.5).value().surfaces[0].surface), packed_bytes(grid, 1, 0.5));

    Grid moved = copy_of(grid);
    std::vector<float> points(moved.points.as<float>().begin(), moved.points.as<float>().end());
    for (float& x : points) x = 2 * x + 1;
    moved.points = Array::own(std::move(points), 3);
    EXPECT_EQ(contour.set(input_of(moved)).value(), ContourUpdate::points);
    EXPECT_EQ(bytes_of(contour.extract(0.5).value().surfaces[0].surface), packed_bytes(moved, 0, 0.5));

    const Grid other = kuhn(6);
    EXPECT_EQ(contour.set(input_of(other)).value(), ContourUpdate::grid);
    EXPECT_EQ(bytes_of(contour.extract(0.5).value().surfaces[0].surface), packed_bytes(other, 0, 0.5));
}

TEST(Contour, SeesThatBorrowedMemoryWasFilledAnew) {
    const Grid grid = kuhn();
    std::vector<float> values(grid.points.tuples(), 1.f);
    ContourInput input{grid, {"values", Array::borrow(std::span<const float>(values)), false, {}}, {}, {}};
    Contour contour = Contour::create(input, {.method = Method::clusters}).value();
    EXPECT_EQ(contour.extract(0.5).value().surfaces[0].surface.triangle_count(), 0u);
    const auto sphere = grid.point_fields[1].values.as<float>();
    std::copy(sphere.begin(), sphere.end(), values.begin());
    EXPECT_EQ(contour.set(input).value(), ContourUpdate::field);
    EXPECT_EQ(bytes_of(contour.extract(0.5).value().surfaces[0].surface), packed_bytes(grid, 1, 0.5));
}

TEST(Contour, SeesThatSharedMemoryWasChangedInPlace) {
    Grid grid = kuhn();
    const auto memory = std::make_shared<std::vector<float>>(grid.points.tuples(), 1.f);
    const auto values = [&] { // an owner of its own each time
        const std::shared_ptr<const void> owner(memory->data(), [memory](const void*) {});
        return Array(ScalarType::float32, memory->data(), memory->size(), 1, owner);
    };
    const auto input = [&] { return ContourInput{grid, {"values", values(), false, {}}, {}, {}}; };
    Contour contour = Contour::create(input(), {.method = Method::clusters}).value();
    EXPECT_EQ(contour.extract(0.5).value().surfaces[0].surface.triangle_count(), 0u);
    EXPECT_EQ(contour.set(input()).value(), ContourUpdate::nothing) << "the same values";
    const auto sphere = grid.point_fields[1].values.as<float>();
    std::copy(sphere.begin(), sphere.end(), memory->begin());
    EXPECT_EQ(contour.set(input()).value(), ContourUpdate::field);
    EXPECT_EQ(bytes_of(contour.extract(0.5).value().surfaces[0].surface), packed_bytes(grid, 1, 0.5));
}

TEST(Contour, PacksAgainWhereATetTurnsOver) {
    const Grid grid = kuhn(3);
    Contour contour = Contour::create(input_of(grid), {.method = Method::clusters}).value();
    contour.prepare().value();
    Grid mirrored = copy_of(grid);
    std::vector<float> points(grid.points.as<float>().begin(), grid.points.as<float>().end());
    for (std::size_t i = 0; i < points.size(); i += 3) points[i] = -points[i];
    mirrored.points = Array::own(std::move(points), 3);
    EXPECT_EQ(contour.set(input_of(mirrored)).value(), ContourUpdate::points);
    EXPECT_EQ(bytes_of(contour.extract(0.3).value().surfaces[0].surface), packed_bytes(mirrored, 0, 0.3));
}

TEST(Contour, StaysAsItWasWhenASetIsRefused) {
    const Grid grid = kuhn();
    Contour contour = Contour::create(input_of(grid), {.method = Method::clusters}).value();
    const std::string before = bytes_of(contour.extract(0.5).value().surfaces[0].surface);
    ContourInput wrong = input_of(grid);
    wrong.field.values = Array::own(std::vector<float>(3));
    const auto refused = contour.set(wrong);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(bytes_of(contour.extract(0.5).value().surfaces[0].surface), before);
    EXPECT_EQ(Contour::create(wrong).error().code, ErrorCode::invalid_argument);
}

TEST(Contour, CarriesFields) {
    const Grid grid = kuhn();
    for (const Method method : {Method::direct, Method::clusters}) {
        ContourInput input = input_of(grid);
        input.point_fields = {grid.point_fields[1]};
        std::vector<std::int32_t> numbers(grid.cells.count());
        for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::int32_t>(i);
        input.cell_fields = {{"number", Array::own(std::move(numbers))}};
        Contour contour = Contour::create(input, {.method = method, .source_cells = true}).value();
        const Surface surface = contour.extract(0.2).value().surfaces[0].surface;
        ASSERT_EQ(surface.point_fields.size(), 1u);
        ASSERT_EQ(surface.cell_fields.size(), 1u);
        for (std::size_t t = 0; t < surface.triangle_count(); ++t)
            ASSERT_EQ(surface.cell_fields[0].values.at(t), surface.source_cells.at(t));
    }
}

TEST(Contour, PacksAgainForCellFieldsThatNobodyAskedForBefore) {
    const Grid grid = kuhn();
    Contour contour = Contour::create(input_of(grid), {.method = Method::clusters}).value();
    contour.prepare().value();
    ContourInput input = input_of(grid);
    input.cell_fields = {{"zero", Array::own(std::vector<float>(grid.cells.count()))}};
    EXPECT_EQ(contour.set(input).value(), ContourUpdate::grid);
    EXPECT_EQ(contour.extract(0.2).value().surfaces[0].surface.cell_fields.size(), 1u);
}

TEST(Contour, PackedForAllDoesNotPackAgainForNormalsAndCellFields) {
    const Grid grid = kuhn();
    ContourOptions options{.method = Method::clusters, .pack_all = true};
    Contour contour = Contour::create(input_of(grid), options).value();
    contour.extract(0.5).value();
    options.normals = Normals::gradient;
    ContourInput input = input_of(grid);
    std::vector<std::int32_t> marks(grid.cells.count());
    std::iota(marks.begin(), marks.end(), 0);
    input.cell_fields = {{"mark", Array::own(marks)}};
    EXPECT_EQ(contour.set(input, options).value(), ContourUpdate::nothing);
    const ContourResult result = contour.extract(0.5).value();
    EXPECT_EQ(result.pack_seconds, 0);
    EXPECT_FALSE(result.surfaces[0].surface.normals.empty());
    EXPECT_EQ(result.surfaces[0].surface.cell_fields.size(), 1u);
}

TEST(Contour, TakesOtherOptionsWithTheSameGrid) {
    const Grid grid = kuhn();
    ContourOptions options{.method = Method::clusters};
    Contour contour = Contour::create(input_of(grid), options).value();
    contour.prepare().value();
    options.normals = Normals::face;
    options.edge_ends = true;
    EXPECT_EQ(contour.set(input_of(grid), options).value(), ContourUpdate::nothing) << "nothing more to pack";
    const Surface faces = contour.extract(0.2).value().surfaces[0].surface;
    EXPECT_EQ(faces.normals.tuples(), faces.triangle_count());
    EXPECT_EQ(faces.edge_ends.tuples(), faces.vertex_count());
    options.normals = Normals::gradient;
    EXPECT_EQ(contour.set(input_of(grid), options).value(), ContourUpdate::grid) << "packed without gradients";
    const Surface smooth = contour.extract(0.2).value().surfaces[0].surface;
    EXPECT_EQ(smooth.normals.tuples(), smooth.vertex_count());
    EXPECT_EQ(contour.set(input_of(grid), {.method = Method::clusters}).value(), ContourUpdate::nothing);
    EXPECT_EQ(bytes_of(contour.extract(0.2).value().surfaces[0].surface), packed_bytes(grid, 0, 0.2));
    EXPECT_EQ(contour.set(input_of(grid), {.precision = Precision::float64}).value(), ContourUpdate::grid);
    contour.prepare().value();
    EXPECT_EQ(contour.packed()->precision(), Precision::float64);
    options.engine = nullptr;
    EXPECT_EQ(contour.set(input_of(grid), options).error().code, ErrorCode::invalid_argument);
    EXPECT_TRUE(contour.extract(0.2)) << "as it was";
}

TEST(Contour, PredictsBeforeItExtracts) {
    const Grid grid = kuhn(24);
    Contour contour = Contour::create(input_of(grid), {.surfaces = 1000}).value();
    const auto before = contour.predict(0.1).value();
    EXPECT_EQ(contour.sample().value().triangles(0.1), before.triangles);
    EXPECT_EQ(contour.sample().value().points(), grid.points.tuples());
    const ContourResult result = contour.extract(0.1).value();
    const auto triangles = static_cast<double>(result.surfaces[0].surface.triangle_count());
    EXPECT_NEAR(before.triangles, triangles, 0.2 * triangles);
    EXPECT_LT(contour.predict(0.1).value().estimate.seconds, before.estimate.seconds) << "packing is done";
}

TEST(Contour, TellsTheRangeOfTheField) {
    const Grid grid = kuhn();
    for (const Method method : {Method::direct, Method::clusters}) {
        Contour contour = Contour::create(input_of(grid, 1), {.method = method}).value();
        const FieldReport field = contour.field().value();
        EXPECT_EQ(field.name, "sphere");
        EXPECT_EQ(field.lower, 0);
        EXPECT_NEAR(field.upper, std::sqrt(3.0), 1e-6);
    }
}

TEST(Contour, IsStoppedWhileItPacksAndGoesOnAfterwards) {
    const Grid grid = kuhn(16);
    Contour contour = Contour::create(input_of(grid), {.method = Method::clusters}).value();
    std::atomic<bool> stop = true;
    const auto stopped = contour.extract(0.5, {.progress = {{}, &stop}});
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
    EXPECT_EQ(bytes_of(contour.extract(0.5).value().surfaces[0].surface), packed_bytes(grid, 0, 0.5));
}

// As a slider does: the call for a stale isovalue is cancelled from another thread, the next one is answered.
TEST(Contour, AnswersTheNewestOfManyIsovalues) {
    const Grid grid = kuhn(16);
    Contour contour = Contour::create(input_of(grid), {.surfaces = 1000}).value();
    const std::string expected = packed_bytes(grid, 0, 0.5);
    for (int round = 0; round < 20; ++round) {
        std::atomic<bool> stale = false;
        std::thread old([&] {
            const auto result = contour.extract(0.01 * round, {.progress = {{}, &stale}});
            EXPECT_TRUE(result || result.error().code == ErrorCode::cancelled);
        });
        stale = true;
        EXPECT_EQ(bytes_of(contour.extract(0.5).value().surfaces[0].surface), expected);
        old.join();
    }
}

TEST(Contour, AnswersManyThreadsAtOnce) {
    const Grid grid = kuhn(12);
    for (const Method method : {Method::direct, Method::clusters}) {
        Contour contour = Contour::create(input_of(grid), {.method = method}).value();
        const std::string expected = method == Method::direct ? direct_bytes(grid, 0, 0.5) : packed_bytes(grid, 0, 0.5);
        std::vector<std::thread> threads;
        for (int i = 0; i < 4; ++i)
            threads.emplace_back([&] {
                for (int round = 0; round < 5; ++round)
                    EXPECT_EQ(bytes_of(contour.extract(0.5).value().surfaces[0].surface), expected);
            });
        for (std::thread& thread : threads) thread.join();
    }
}

TEST(Contour, RefusesOptionsThatContradictEachOther) {
    const Grid grid = kuhn(2);
    Contour contour = Contour::create(input_of(grid)).value();
    EXPECT_EQ(contour.extract(std::nan("")).error().code, ErrorCode::invalid_argument);
    const auto unused = [](EngineGrid&, const ExtractOptions&) -> Result<void> { return {}; };
    EXPECT_EQ(contour.use_grid(1, unused).error().message,
              "the session extracts by the cpu engine, which keeps no grid");
    EXPECT_EQ(Contour::create(input_of(grid), {.engine = nullptr}).error().message, "the session has no engine");
}

} // namespace
} // namespace isotet::test
