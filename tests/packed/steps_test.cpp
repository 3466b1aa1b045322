// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Steps of a packed file: points that move, and grids between two steps.
#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/boundary.hpp>
#include <isotet/contour.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/read.hpp>

#include "packed/packed_samples.hpp"
#include "packed/packed.hpp"
#include "packed/residency.hpp"
#include "packed/right_checksums.hpp"
#include "support/places.hpp"
#include "support/run_program.hpp"

namespace isotet::test {
namespace {

constexpr std::array<std::uint64_t, 3> memory_limits{1, 200'000, std::uint64_t{1} << 30};

/// The points, drawn away from the first by a factor.
Array stretched_points(const Array& points, double factor) {
    std::vector<double> wide;
    std::vector<float> narrow;
    for (std::size_t i = 0; i < points.tuples(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            wide.push_back(factor * (points.at(i, axis) + 0.01 * static_cast<double>(axis)));
            narrow.push_back(static_cast<float>(wide.back()));
        }
    return points.type() == ScalarType::float32 ? Array::own(std::move(narrow), 3) : Array::own(std::move(wide), 3);
}

/// A grid of mixed cells at three steps: its points move at the second, values at all.
struct MovingGrid {
    Precision precision;
    std::vector<PackedGrid> steps;

    MovingGrid(Precision chosen, bool wide_points) : precision(chosen) {
        MixedOptions options;
        options.side = 5;
        options.values = 0;
        options.wide = wide_points;
        options.no_data = 0.03;
        const NastyGrid nasty = mixed_grid(4, options);
        const PackedGrid first = pack(nasty.grid, nasty.field, packing_of_all(precision)).value();
        const PackedGrid second =
            with_more(first, nasty, 0.01).with_points(stretched_points(nasty.grid.points, 1.1)).value();
        steps = {first, second, with_more(second, nasty, 0.02)};
    }

    static PackedGrid with_more(const PackedGrid& packed, const NastyGrid& nasty, double more) {
        std::vector<double> values;
        for (std::size_t i = 0; i < nasty.field.values.tuples(); ++i) values.push_back(nasty.field.values.at(i) + more);
        PointField field = nasty.field;
        field.values = Array::own(std::move(values));
        return packed.with_field(field).value();
    }

    std::string saved_in(const TemporaryFolder& folder) const {
        SavePackedOptions options;
        options.chunk_bytes = 1'000;
        options.time = 0;
        PackedWriter writer = PackedWriter::create(steps[0], folder.file("moving.isotet"), options).value();
        for (std::size_t step = 1; step < steps.size(); ++step)
            writer.add_step(steps[step], static_cast<double>(step)).value();
        writer.commit().value();
        return folder.file("moving.isotet");
    }
};

std::vector<MovingGrid> moving_grids() {
    std::vector<MovingGrid> grids;
    for (const Precision precision : {Precision::float32, Precision::float64})
        for (const bool wide : {false, true}) grids.emplace_back(precision, wide);
    return grids;
}

TEST(MovingPoints, AreThoseOfTheirStep) {
    for (const MovingGrid& grid : moving_grids()) {
        const TemporaryFolder folder;
        const std::string path = grid.saved_in(folder);
        for (const std::uint64_t memory : memory_limits) {
            const PackedFile file = PackedFile::open(path, {memory}).value();
            for (std::size_t step = 0; step < grid.steps.size(); ++step) {
                const PackedGrid of_file = file.grid("", step).value();
                const PackedGrid& expected = grid.steps[step];
                EXPECT_TRUE(bytes_of(extract(of_file, 0.1, with_all(Ties::merge)).value().surface) ==
                            bytes_of(extract(expected, 0.1, with_all(Ties::merge)).value().surface))
                    << step << ", " << memory << " bytes";
                EXPECT_TRUE(bytes_of(file.load("", step).value()) == bytes_of(expected)) << step;
                EXPECT_TRUE(bytes_of(boundary_of(of_file, {of_file}).value()) ==
                            bytes_of(boundary_of(expected, {expected}).value()))
                    << step;
            }
            file.check().value();
            ASSERT_EQ(file.info().moved_points.size(), 1u) << "the third step has those of the second";
            EXPECT_EQ(file.info().moved_points[0].step, 1u);
            EXPECT_GT(file.info().moved_points[0].upper[0], file.info().upper[0]);
        }
    }
}

TEST(MovingPoints, AreThoseOfTheirStepWithoutAField) {
    for (const MovingGrid& grid : moving_grids()) {
        const TemporaryFolder folder;
        const std::string path = grid.saved_in(folder);
        for (std::size_t step = 0; step < grid.steps.size(); ++step) {
            ReadOptions options;
            options.step = step;
            options.point_fields.emplace();
            const Array points = read(path, options).value().grid.points;
            const Array expected = unpack(grid.steps[step]).value().points;
            ASSERT_EQ(points.bytes(), expected.bytes());
            EXPECT_EQ(std::memcmp(points.data(), expected.data(), points.bytes()), 0) << step;
        }
    }
}

TEST(MovingPoints, AreAddedToAFileThatIsThere) {
    const MovingGrid grid(Precision::float32, false);
    const TemporaryFolder folder;
    const std::string path = folder.file("moving.isotet");
    SavePackedOptions options;
    options.chunk_bytes = 1'000;
    options.time = 0;
    save_packed(grid.steps[0], path, options).value();
    for (const std::size_t step : {1, 2})
        PackedWriter::append(grid.steps[step], path, static_cast<double>(step)).value().commit().value();
    const std::string appended = content_of(path);
    const PackedFile file = PackedFile::open(path).value();
    file.check().value();
    EXPECT_EQ(file.info().moved_points.size(), 1u);
    for (std::size_t step = 0; step < 3; ++step)
        EXPECT_TRUE(bytes_of(file.load("", step).value()) == bytes_of(grid.steps[step])) << step;
    PackedWriter::append(grid.steps[0], path, 3).value().commit().value(); // back to where they were
    const PackedFile longer = PackedFile::open(path).value();
    EXPECT_EQ(longer.info().moved_points.size(), 2u);
    EXPECT_TRUE(bytes_of(longer.load("", 3).value()) == bytes_of(grid.steps[0]));
}

TEST(MovingPoints, OfFieldsOfOneStepAreTheSame) {
    const MovingGrid grid(Precision::float32, false);
    const TemporaryFolder folder;
    PackedWriter writer = PackedWriter::create(grid.steps[0], folder.file("a.isotet")).value();
    const Result<void> added = writer.add_field(grid.steps[1]);
    ASSERT_FALSE(added);
    EXPECT_EQ(added.error().code, ErrorCode::invalid_argument);
}

TEST(MovingPoints, AreReadWhereASessionNeedsThem) {
    const Grid grid = made_grid("kuhn", 16, {"sphere"});
    const PackedGrid first = pack(grid, point_field(grid)).value();
    const PackedGrid second = first.with_points(stretched_points(grid.points, 1.25)).value();
    const TemporaryFolder folder;
    SavePackedOptions options;
    options.chunk_bytes = 2'000;
    PackedWriter writer = PackedWriter::create(first, folder.file("a.isotet"), options).value();
    writer.add_step(second, std::nullopt).value();
    writer.commit().value();
    const PackedFile file = PackedFile::open(folder.file("a.isotet")).value();
    const auto input = [&](std::size_t step) {
        ContourInput of_step;
        of_step.packed = file.grid("", step).value();
        return of_step;
    };
    Contour contour = Contour::create(input(0)).value();
    const std::uint64_t all = contour.extract(0.2).value().file_bytes_read;
    EXPECT_EQ(contour.set(input(1)).value(), ContourUpdate::points);
    const ContourResult moved = contour.extract(0.2).value();
    EXPECT_TRUE(bytes_of(moved.surfaces[0].surface) == bytes_of(extract(second, 0.2).value().surface));
    EXPECT_LT(moved.file_bytes_read, all) << "cells stay in memory";
    EXPECT_EQ(contour.set(input(0)).value(), ContourUpdate::points);
    EXPECT_TRUE(bytes_of(contour.extract(0.2).value().surfaces[0].surface) ==
                bytes_of(extract(first, 0.2).value().surface));
}

TEST(MovingPoints, AreReadByAnotherReaderWrittenFromItsDescription) {
    const std::string script = (source_folder() / "tests/packed/read_packed.py").string();
    if (run_program({"/usr/bin/env", "python3", "-c", "0"}).status != 0) GTEST_SKIP() << "there is no Python";
    for (const MovingGrid& grid : moving_grids()) {
        const TemporaryFolder folder;
        const RunResult run = run_program({"/usr/bin/env", "python3", script, grid.saved_in(folder)});
        EXPECT_EQ(run.status, 0) << run.err;
        const std::size_t moved = run.out.find("moved 1 ");
        ASSERT_NE(moved, std::string::npos) << run.out;
        const Array places = boundary_of(grid.steps[1]).value().positions;
        double sum = 0, origin = 0;
        for (std::size_t i = 0; i < places.tuples(); ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                sum += places.at(i, axis);
                origin += grid.steps[1].data().origin[axis];
            }
        EXPECT_NEAR(std::stod(run.out.substr(moved + 8)), sum - origin, 1e-6 * static_cast<double>(places.size()));
    }
}

TEST(MovingPoints, WithWrongNumbersAreErrors) {
    const MovingGrid grid(Precision::float32, false);
    const TemporaryFolder folder;
    const std::string path = grid.saved_in(folder), content = content_of(path);
    const auto all = std::as_bytes(std::span(content));
    const io::DirectorySlot slot = io::decode_packed_header(all, content.size()).value();
    const io::PackedDirectory d = io::decode_directory(all.subspan(slot.offset, slot.bytes), content.size()).value();
    const auto message = [&](const std::string& broken) {
        folder.write("moving.isotet", broken);
        const auto file = PackedFile::open(path);
        if (!file) return file.error().message;
        const auto checked = file->check();
        return checked ? std::string() : checked.error().message;
    };
    std::string changed = content;
    changed[d.moved_points[0].offset] ^= 1;
    EXPECT_NE(message(changed).find("chunk 0 is broken: its checksum differs"), std::string::npos);
    changed = content;
    changed[d.moved_points[0].boundary_offset] ^= 1;
    EXPECT_NE(message(changed).find("the boundary is broken"), std::string::npos);
    const auto with_points = [&](auto change) {
        io::PackedDirectory other = d;
        change(other.moved_points[0]);
        return message(with_directory(content, slot, other));
    };
    EXPECT_NE(with_points([](io::PointsEntry& points) { points.step = 3; }).find("there is no such step"),
              std::string::npos);
    EXPECT_NE(with_points([](io::PointsEntry& points) { points.step = 0; }).find("ascend from 1"), std::string::npos);
    EXPECT_NE(with_points([](io::PointsEntry& points) {
                  points.offset = ~std::uint64_t{0} - 100;
              }).find("positions of moved points lie outside of the file"),
              std::string::npos);
    EXPECT_NE(with_points([](io::PointsEntry& points) { points.origin[1] = std::nan(""); }).find("not finite"),
              std::string::npos);
}

/// (1 - w) a + w b in the precision of the grid, of stored numbers that are the user's.
template <class Real>
std::vector<Real> between(const Array& a, const Array& b, double fraction) {
    const Real w = static_cast<Real>(fraction), u = Real(1) - w;
    std::vector<Real> out;
    for (std::size_t i = 0; i < a.tuples(); ++i)
        for (std::size_t c = 0; c < a.components(); ++c) {
            const Real at_a = static_cast<Real>(a.at(i, c)), at_b = static_cast<Real>(b.at(i, c));
            const Real of_a = u * at_a, of_b = w * at_b;
            out.push_back(fraction == 0 ? at_a : fraction == 1 ? at_b : of_a + of_b);
        }
    return out;
}

template <class Real>
void expect_grids_between(const Grid& grid, const std::vector<Real>& next, bool moves) {
    PackOptions options;
    options.precision = sizeof(Real) == 4 ? Precision::float32 : Precision::float64;
    options.source_cells = true;
    const PointField field{
        "p", Array::own(between<Real>(grid.point_fields[0].values, grid.point_fields[0].values, 0)), false, {}};
    const Array points = Array::own(between<Real>(grid.points, grid.points, 0), 3);
    Grid typed = grid;
    typed.points = points;
    const Array next_values = Array::own(next), next_points = stretched_points(points, moves ? 1.125 : 1);
    const PackedGrid first = pack(typed, field, options).value();
    PackedGrid second = first.with_field({"p", next_values, false, {}}).value();
    if (moves) second = second.with_points(next_points).value();
    const TemporaryFolder folder;
    SavePackedOptions saving;
    saving.chunk_bytes = 1'000;
    PackedWriter writer = PackedWriter::create(first, folder.file("a.isotet"), saving).value();
    writer.add_step(second, std::nullopt).value();
    writer.commit().value();
    for (const double fraction : {0.0, 0.25, 1.0 / 3, 0.9, 1.0}) {
        PackedGrid expected =
            first.with_field({"p", Array::own(between<Real>(field.values, next_values, fraction)), false, {}}).value();
        if (moves) expected = expected.with_points(Array::own(between<Real>(points, next_points, fraction), 3)).value();
        for (const std::uint64_t memory : memory_limits) {
            const PackedFile file = PackedFile::open(folder.file("a.isotet"), {memory}).value();
            const PackedGrid blended = file.interpolated("p", 0, fraction).value();
            ExtractOptions carried;
            carried.edge_ends = carried.source_cells = true;
            carried.packed_fields = {blended};
            ExtractOptions by_memory = carried;
            by_memory.packed_fields = {expected};
            for (const double isovalue : {-0.2, 0.0, 0.1, 1.0})
                EXPECT_TRUE(bytes_of(extract(blended, isovalue, carried).value().surface) ==
                            bytes_of(extract(expected, isovalue, by_memory).value().surface))
                    << fraction << ", " << isovalue << ", " << memory << " bytes";
            EXPECT_TRUE(bytes_of(boundary_of(blended, {blended}).value()) ==
                        bytes_of(boundary_of(expected, {expected}).value()))
                << fraction;
            std::string whole, of_expected;
            append_bytes(whole, unpack(blended).value().point_fields[0].values);
            append_bytes(of_expected, unpack(expected).value().point_fields[0].values);
            EXPECT_TRUE(whole == of_expected) << fraction;
        }
    }
}

TEST(GridsBetweenSteps, HaveTheSurfacesOfGridsWithThoseValues) {
    const Grid grid = made_grid("mixed", 6, {"gyroid", "sphere"});
    for (const bool moves : {false, true}) {
        std::vector<float> next(grid.point_fields[1].values.as<float>().begin(),
                                grid.point_fields[1].values.as<float>().end());
        next[7] = std::numeric_limits<float>::quiet_NaN();
        next[40] = std::numeric_limits<float>::infinity();
        expect_grids_between<float>(grid, next, moves);
        expect_grids_between<double>(grid, {next.begin(), next.end()}, moves);
    }
}

TEST(GridsBetweenSteps, MissNoClusterWhereRoundingLeavesTheRange) {
    const Grid grid = made_grid("kuhn", 6, {"integer"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    std::vector<float> values;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i)
        values.push_back(0.1F * static_cast<float>(grid.point_fields[0].values.at(i)));
    const PackedGrid tenths = packed.with_field(field_of(values, "integer")).value();
    const TemporaryFolder folder;
    SavePackedOptions saving;
    saving.chunk_bytes = 500;
    PackedWriter writer = PackedWriter::create(tenths, folder.file("a.isotet"), saving).value();
    writer.add_step(tenths, std::nullopt).value();
    writer.commit().value();
    const PackedFile file = PackedFile::open(folder.file("a.isotet")).value();
    for (int i = 1; i < 60; ++i) {
        const double fraction = i / 60.0;
        const Array between_both = Array::own(between<float>(Array::borrow(values), Array::borrow(values), fraction));
        const PackedGrid expected = tenths.with_field({"integer", between_both, false, {}}).value();
        const PackedGrid blended = file.interpolated("integer", 0, fraction).value();
        for (const std::size_t point : {0, 100, 200})
            ASSERT_TRUE(bytes_of(extract(blended, between_both.at(point)).value().surface) ==
                        bytes_of(extract(expected, between_both.at(point)).value().surface))
                << fraction;
    }
}

TEST(GridsBetweenSteps, BlendValuesThatAreScaledOtherwise) {
    const Grid grid = made_grid("kuhn", 6, {"gyroid"});
    std::vector<double> a, b, mean;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i) {
        a.push_back(1e6 + 1e-3 * grid.point_fields[0].values.at(i));
        b.push_back(2e6 + 3e-6 * grid.point_fields[0].values.at(i));
        mean.push_back(0.5 * a.back() + 0.5 * b.back());
    }
    const PackedGrid first = pack(grid, field_of(a)).value(), second = first.with_field(field_of(b)).value();
    const TemporaryFolder folder;
    PackedWriter writer = PackedWriter::create(first, folder.file("a.isotet")).value();
    writer.add_step(second, std::nullopt).value();
    writer.commit().value();
    const PackedGrid blended = PackedFile::open(folder.file("a.isotet")).value().interpolated("", 0, 0.5).value();
    const Surface expected = extract(first.with_field(field_of(mean)).value(), 1.5e6).value().surface;
    const Surface surface = extract(blended, 1.5e6).value().surface;
    ASSERT_EQ(surface.triangle_count(), expected.triangle_count());
    for (std::size_t i = 0; i < surface.vertex_count(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(surface.positions.at(i, axis), expected.positions.at(i, axis), 1e-4);
}

/// Packed grids of two steps in a file, and the one between them: as it is read in parts, and all in memory.
struct BetweenTwo {
    TemporaryFolder folder;
    PackedGrid blended, whole;

    BetweenTwo(const PackedGrid& first, const PackedGrid& second, double fraction, std::uint64_t memory) {
        SavePackedOptions saving;
        saving.chunk_bytes = 500;
        PackedWriter writer = PackedWriter::create(first, folder.file("a.isotet"), saving).value();
        writer.add_step(second, std::nullopt).value();
        writer.commit().value();
        blended = PackedFile::open(folder.file("a.isotet"), {memory}).value().interpolated("", 0, fraction).value();
        whole = PackedGrid(core::whole_of(blended.shared_data(), {}).value());
    }
    void expect_same_boundary() const {
        EXPECT_TRUE(bytes_of(boundary_of(blended, {blended}).value()) == bytes_of(boundary_of(whole, {whole}).value()));
    }
    void expect_same_surface(double isovalue, Normals normals = Normals::none) const {
        ExtractOptions options;
        options.normals = normals;
        EXPECT_TRUE(bytes_of(extract(blended, isovalue, options).value().surface) ==
                    bytes_of(extract(whole, isovalue, options).value().surface))
            << isovalue;
    }
};

TEST(GridsBetweenSteps, HaveTheBoundaryOfTheGridInMemory) {
    const Grid grid = made_grid("mixed", 5, {"gyroid"});
    Grid far = grid; // values and points that are rounded as they are stored
    std::vector<double> points, next_points, values, next_values;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            points.push_back(1e5 + grid.points.at(i, axis) / 3);
            next_points.push_back(1e5 + grid.points.at(i, axis) / 2.9);
        }
        values.push_back(1e6 + grid.point_fields[0].values.at(i) / 7);
        next_values.push_back(3e-30 * grid.point_fields[0].values.at(i));
    }
    far.points = Array::own(std::move(points), 3);
    for (const Precision precision : {Precision::float32, Precision::float64}) {
        const PackedGrid first = pack(far, field_of(values), {.precision = precision}).value();
        const PackedGrid second = first.with_field(field_of(next_values)).value();
        const PackedGrid moved = second.with_points(Array::own(std::vector<double>(next_points), 3)).value();
        for (const PackedGrid& next : {second, moved})
            for (const double fraction : {0.2, 1.0 / 3}) {
                const BetweenTwo two(first, next, fraction, 1 << 20);
                two.expect_same_boundary();
                two.expect_same_surface(1e6 * (1 - fraction));
            }
    }
}

TEST(GridsBetweenSteps, MissNothingWhereValuesBecomeTooSmallToBeStored) {
    const Grid grid = made_grid("kuhn", 8, {"gyroid"});
    const std::vector<float> tiny(grid.points.tuples(), -1e-25F); // which is scaled up in its own step
    std::vector<float> small;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i)
        small.push_back(grid.points.at(i) < 0.4 ? -3e-21F : -1.5e-21F);
    const PackedGrid first = pack(grid, field_of(tiny)).value(), second = first.with_field(field_of(small)).value();
    ASSERT_GT(first.field().scale, second.field().scale);
    const BetweenTwo two(first, second, 0.4, 1 << 20);
    EXPECT_GT(extract(two.whole, 0).value().surface.triangle_count(), 0u);
    two.expect_same_surface(0);
}

TEST(GridsBetweenSteps, MissNoGroupWhereValuesLieFarFromZero) {
    const Grid grid = made_grid("kuhn", 10, {"gyroid"});
    std::vector<float> values;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i)
        values.push_back(1e6F + 0.0625F * std::round(4 * static_cast<float>(grid.point_fields[0].values.at(i))));
    const PackedGrid packed = pack(grid, field_of(values)).value();
    for (int i = 1; i < 20; ++i) {
        const BetweenTwo two(packed, packed, i / 20.0, 1 << 20);
        for (int k = -6; k < 7; ++k) two.expect_same_surface(1e6 + 0.0625 * k);
    }
}

TEST(GridsBetweenSteps, HaveGradientsBetweenThoseOfBoth) {
    const Grid grid = made_grid("mixed", 5, {"gyroid", "plane"});
    const PackedGrid first = pack(grid, find_field(grid, "gyroid").value(), {.gradients = true}).value();
    const PackedGrid second = first.with_field({"gyroid", grid.point_fields[1].values, false, {}}).value();
    for (const std::uint64_t memory : memory_limits) {
        const BetweenTwo two(first, second, 0.25, memory), near(first, second, 1e-9, memory);
        two.expect_same_surface(0.1, Normals::gradient);
        ExtractOptions options;
        options.normals = Normals::gradient;
        const Array normals = extract(near.blended, 0.1, options).value().surface.normals;
        const Array expected = extract(first, 0.1, options).value().surface.normals;
        ASSERT_EQ(normals.size(), expected.size());
        for (std::size_t i = 0; i < normals.tuples(); ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(normals.at(i, axis), expected.at(i, axis), 1e-3);
        EXPECT_EQ(two.blended.report().gradient_bytes, 4 * two.blended.report().points);
    }
    const PackedGrid plain = pack(grid, find_field(grid, "gyroid").value()).value();
    const BetweenTwo without(plain, plain, 0.5, 1 << 20);
    EXPECT_EQ(without.blended.report().gradient_bytes, 0u);
}

TEST(GridsBetweenSteps, AreRefusedWhereThereIsNone) {
    const Grid grid = made_grid("kuhn", 3, {"gyroid"});
    const TemporaryFolder folder;
    const std::string path = saved(pack(grid, point_field(grid)).value(), folder);
    const PackedFile file = PackedFile::open(path).value();
    EXPECT_EQ(file.interpolated("gyroid", 0, 0.5).error().message,
              "step 1 is not there, but the file has 1 step, counted from 0");
    EXPECT_EQ(file.interpolated("gyroid", 0, -0.5).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(file.interpolated("gyroid", 0, std::nan("")).error().code, ErrorCode::invalid_argument);
    EXPECT_TRUE(file.interpolated("gyroid", 0, 0));
}

} // namespace
} // namespace isotet::test
