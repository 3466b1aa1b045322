// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Every public function that computes asks whether it is cancelled: before it starts, and whenever that is.
#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <sys/resource.h>
#include <time.h>

#include <gtest/gtest.h>

#include <isotet/boundary.hpp>
#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/extract.hpp>
#include <isotet/fields.hpp>
#include <isotet/frame.hpp>
#include <isotet/grid.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/pieces.hpp>
#include <isotet/read.hpp>
#include <isotet/scene.hpp>
#include <isotet/paper/search.hpp>
#include <isotet/slice.hpp>
#include <isotet/solid.hpp>
#include <isotet/surface.hpp>
#include <isotet/write.hpp>

#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

using Outcome = std::optional<ErrorCode>; ///< nothing: done

template <class T>
Outcome outcome_of(const Result<T>& result) {
    return result ? std::nullopt : std::optional(result.error().code);
}

struct Work {
    std::string name;
    std::function<Outcome(const Run&)> carry_out;
};

PointField first_field(const Grid& grid) { return {grid.point_fields[0].name, grid.point_fields[0].values, false, {}}; }

Grid grid_of(const std::string& shape, std::uint64_t side) {
    Grid grid = make_grid({.shape = shape, .side = side, .fields = {"gyroid"}}).value();
    std::vector<float> values(grid.cells.count());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 13);
    grid.cell_fields = {{"of cells", Array::own(std::move(values))}};
    return grid;
}

/// What is done with a grid of any cells.
void add_grid_work(const Grid& grid, std::vector<Work>& all) {
    const PointField field = first_field(grid);
    const auto add = [&](const char* name, auto work) {
        all.push_back({name, [=](const Run& run) { return outcome_of(work(run)); }});
    };
    add("survey", [=](const Run& run) { return survey(grid, {}, run); });
    add("survey without faces", [=](const Run& run) { return survey(grid, {.faces = false}, run); });
    add("boundary_of", [=](const Run& run) { return boundary_of(grid, run); });
    add("merge_points", [=](const Run& run) { return merge_points(grid, {}, run); });
    add("merge_points, near", [=](const Run& run) { return merge_points(grid, {.tolerance = 1e-6}, run); });
    add("count_hanging_points", [=](const Run& run) { return count_hanging_points(grid, run); });
    add("close_hanging_points", [=](const Run& run) { return close_hanging_points(grid, run); });
    add("take_cells", [=](const Run& run) { return take_cells(grid, 1, grid.cells.count(), run); });
    add("contour_spectrum", [=](const Run& run) { return contour_spectrum_over_range(grid, field, 50, run); });
    add("relative_volumes", [=](const Run& run) { return relative_volumes(grid, run); });
    if (has_cells_to_linearize(grid.cells)) add("linearize", [=](const Run& run) { return linearize(grid, {}, run); });
    add("find_field of cells", [=](const Run& run) { return find_field(grid, "of cells", {}, run); });
    add("boundary_cells",
        [=, boundary = boundary_of(grid).value()](const Run& run) { return boundary_cells(boundary, grid, run); });
    for (const Method method : {Method::direct, Method::clusters}) {
        ContourOptions options;
        options.method = method;
        options.edge_ends = options.source_cells = true;
        all.push_back({"Contour", [=](const Run& run) {
                           Result<Contour> contour = Contour::create({grid, field, {}, grid.cell_fields}, options, run);
                           return contour ? outcome_of(contour->extract(0.1, run)) : outcome_of(contour);
                       }});
    }
    all.push_back({"Solids", [=](const Run& run) {
                       Result<Solids> solids = Solids::create({grid, field, {}, {}}, {}, run);
                       return solids ? outcome_of(solids->extract({0.1, 0.5}, run)) : outcome_of(solids);
                   }});
    const Surface solid = Solids::create({grid, field, {}, {}}, {}).value().extract({0.1, 0.5}).value().surface;
    add("measure_solid", [=](const Run& run) { return measure_solid(solid, run); });
    all.push_back({"Clipper", [=](const Run& run) {
                       Result<Clipper> clipper = Clipper::create({grid, field, {}, {}}, {}, run);
                       return clipper ? outcome_of(clipper->clip({0.1, 0.5}, {}, run)) : outcome_of(clipper);
                   }});
}

void add_linear_work(const Grid& grid, std::vector<Work>& all) {
    const PointField field = first_field(grid);
    const auto add = [&](const char* name, auto work) {
        all.push_back({name, [=](const Run& run) { return outcome_of(work(run)); }});
    };
    add("split", [=](const Run& run) { return split(grid, run); });
    add("survey_piece", [=](const Run& run) { return survey_piece(grid, field, {}, run); });
    add("pack", [=](const Run& run) { return pack(grid, field, {}, run); });
    const PackedGrid packed = pack(grid, field).value();
    add("with_field", [=](const Run& run) { return packed.with_field(field, run); });
    add("extract", [=](const Run& run) { return extract(packed, 0.1, {}, run); });
    add("unpack", [=](const Run& run) { return unpack(packed, run); });
    add("boundary_of packed", [=](const Run& run) { return boundary_of(packed, run); });
    const PackedGrid tets = pack(grid, field, {.split_cells = true}).value();
    add("TetIndex", [=](const Run& run) { return TetIndex::create(tets, SearchIndex::interval_tree, run); });
    DirectOptions direct;
    direct.extract.edge_ends = true;
    const Surface surface = extract_direct(grid, field, std::vector{0.1}, direct).value().surfaces[0].surface;
    add("check", [=](const Run& run) { return check(surface, {.grid = &grid, .field = &field}, run); });
    add("reduce", [=](const Run& run) { return reduce(surface, {}, run); });
    add("find_parts", [=](const Run& run) { return find_parts(surface, run); });
}

void add_file_work(const TemporaryFolder& folder, const Grid& grid, std::vector<Work>& all) {
    const std::string path = folder.file("grid.vtu"), out = folder.file("out.vtu"), packed = folder.file("a.isotet");
    ASSERT_TRUE(write_grid(grid, path));
    ASSERT_TRUE(save_packed(pack(grid, first_field(grid)).value(), packed));
    const auto add = [&](const char* name, auto work) {
        all.push_back({name, [=](const Run& run) { return outcome_of(work(run)); }});
    };
    add("read", [=](const Run& run) { return read(path, {}, run); });
    add("read_surveyed", [=](const Run& run) { return read_surveyed(path, {}, run); });
    add("write_grid", [=](const Run& run) { return write_grid(grid, out, {}, run); });
    add("PackedFile::load", [=](const Run& run) { return PackedFile::open(packed).value().load({}, 0, run); });
    add("PackedFile::check", [=](const Run& run) { return PackedFile::open(packed).value().check(run); });
}

class EveryFunction : public testing::Test {
protected:
    EveryFunction() {
        for (const auto& [shape, side] : {std::pair{"mixed", 14}, {"kelvin", 5}, {"tet10", 4}}) {
            const Grid grid = grid_of(shape, static_cast<std::uint64_t>(side));
            const std::size_t before = work_.size();
            add_grid_work(grid, work_);
            if (shape == std::string("mixed")) add_linear_work(grid, work_);
            for (std::size_t i = before; i < work_.size(); ++i) work_[i].name += std::string(" of ") + shape;
        }
        add_file_work(folder_, grid_of("kuhn", 14), work_);
    }

    const TemporaryFolder folder_;
    std::vector<Work> work_;
};

TEST_F(EveryFunction, AsksBeforeItStarts) {
    const std::atomic<bool> cancel{true};
    for (const auto& [name, carry_out] : work_)
        EXPECT_EQ(carry_out({2, {nullptr, &cancel}}), ErrorCode::cancelled) << name;
}

TEST_F(EveryFunction, IsCancelledAtAnyMomentOrDone) {
    std::mt19937 random(5);
    for (const auto& [name, carry_out] : work_) {
        const auto begin = std::chrono::steady_clock::now();
        const Outcome all = carry_out({2, {}});
        const auto time =
            std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - begin);
        EXPECT_EQ(all, std::nullopt) << name;
        for (int round = 0; round < 4; ++round) {
            std::atomic<bool> cancel{false};
            const auto wait = time * static_cast<int>(random() % 100) / 100;
            std::thread canceller([&] {
                std::this_thread::sleep_for(wait);
                cancel = true;
            });
            const Outcome outcome = carry_out({2, {nullptr, &cancel}});
            canceller.join();
            EXPECT_TRUE(!outcome || outcome == ErrorCode::cancelled) << name << " after " << wait.count() << " us";
        }
    }
}

/// Seconds of processors that this process has used.
double processor_seconds() {
    timespec time{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Likewise, that processes which it waited for have.
double processor_seconds_apart() {
    rusage usage{};
    ::getrusage(RUSAGE_CHILDREN, &usage);
    return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

/// Work in which one step takes a large part: on the average over all moments a cancel would leave an eighth of the work to be
/// done, or more, if that step did not stop.
TEST(LongSteps, EndSoonAfterACancelAtAnyMoment) {
    const TemporaryFolder folder;
    const Grid grid = make_grid({.shape = "kuhn", .side = 56, .fields = {"gyroid"}}).value();
    const Surface surface = extract_direct(grid, first_field(grid), std::vector{0.1}).value().surfaces[0].surface;
    const std::vector<Work> all{
        {"make_grid, hanging",
         [](const isotet::Run& run) {
             return outcome_of(make_grid({.shape = "octree-tets", .side = 28, .fields = {}}, run));
         }},
        {"make_grid, shuffled",
         [](const isotet::Run& run) {
             return outcome_of(make_grid({.shape = "shuffled", .side = 30, .fields = {"wavelet"}}, run));
         }},
        {"reduce", [&](const isotet::Run& run) { return outcome_of(reduce(surface, {}, run)); }},
        {"find_parts", [&](const isotet::Run& run) { return outcome_of(find_parts(surface, run)); }},
        {"write 3MF",
         [&](const isotet::Run& run) { return outcome_of(write_surface(surface, folder.file("a.3mf"), {}, run)); }}};
    for (const auto& [name, carry_out] : all) {
        using Clock = std::chrono::steady_clock;
        const auto begin = Clock::now();
        const double before = processor_seconds() + processor_seconds_apart();
        EXPECT_EQ(carry_out({1, {}}), std::nullopt) << name;
        const double work = processor_seconds() + processor_seconds_apart() - before;
        const auto whole = Clock::now() - begin;
        constexpr int moments = 6;
        double late = 0;
        for (int i = 0; i < moments; ++i) {
            std::atomic<bool> cancel{false};
            std::atomic<double> at = 0;
            std::thread canceller([&] {
                std::this_thread::sleep_for(whole * (2 * i + 1) / (2 * moments));
                at = processor_seconds();
                cancel = true;
            });
            const Outcome outcome = carry_out({1, {nullptr, &cancel}});
            const double end = processor_seconds();
            canceller.join();
            if (outcome) late += end - at;
        }
        EXPECT_LT(late, work * moments / 8) << name;
    }
}

} // namespace
} // namespace isotet::test
