// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The example of docs/pieces.md, with ranks that are threads.
#include "pieces/example.hpp"

#include <gtest/gtest.h>

#include <condition_variable>
#include <fstream>
#include <iterator>
#include <mutex>
#include <thread>

#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "pieces/partition.hpp"
#include "support/places.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

TEST(ExampleOfPieces, GivesTheSurfaceOfTheWholeOnRanksThatOnlyGatherSurveys) {
    Grid grid = made_grid("mixed", 5, {"gyroid"});
    const PointField field = point_field(grid);
    const auto pieces = partition(grid, field, 3, 5);
    std::mutex mutex;
    std::condition_variable arrived;
    std::vector<Survey> surveys;
    const AllGather all_gather = [&](const Survey& mine) {
        std::unique_lock lock(mutex);
        surveys.push_back(mine);
        arrived.notify_all();
        arrived.wait(lock, [&] { return surveys.size() == pieces.size(); });
        return surveys;
    };
    std::vector<Surface> surfaces(pieces.size());
    std::vector<std::thread> ranks;
    for (std::size_t rank = 0; rank < pieces.size(); ++rank)
        ranks.emplace_back([&, rank] {
            Grid piece = pieces[rank].grid;
            piece.point_numbers = {};
            surfaces[rank] = surface_of_piece(piece, pieces[rank].field, 0.1, all_gather).value();
        });
    for (std::thread& rank : ranks) rank.join();
    std::vector<TriangleBits> together;
    for (const Surface& surface : surfaces) add_triangles(surface, together);
    grid.point_numbers = number_points_by_coordinates(grid.points).value();
    EXPECT_TRUE(sorted(std::move(together)) == triangle_set(extract(pack(grid, field).value(), 0.1).value().surface));
}

TEST(ExampleOfPieces, StandsInTheDocuments) {
    const auto content = [](const std::filesystem::path& path) {
        std::ifstream file(path, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    const std::string source = content(source_folder() / "tests/pieces/example.hpp");
    const std::string page = content(source_folder() / "docs/pieces.md");
    EXPECT_NE(page.find("```cpp\n" + source.substr(source.find('\n') + 1) + "```"), std::string::npos);
}

} // namespace
} // namespace isotet::test
