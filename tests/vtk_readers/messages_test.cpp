// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Requests and replies as bytes. The parent must survive every reply.
#include <array>
#include <random>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include "io/process/messages.hpp"

namespace isotet::io::confined {
namespace {

ReadResult made_result() {
    ReadResult result;
    result.info.format = "vtu";
    result.info.fields = {{"p", Association::point, ScalarType::float32, 1}};
    result.info.times = {0.5, 1.5};
    result.info.blocks = {{10, "steel", "element block", 1}};
    result.info.regions = {{"material", 10, "steel"}};
    result.info.left_out = {{"point field", "q", "its type is 'Foo'"}};
    result.step = 1;
    result.notes = {"a note"};
    result.grid.points = Array::own(std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, 3);
    result.grid.cells.connectivity = Array::own(std::vector<std::int32_t>{0, 1, 2, 3});
    result.grid.point_fields = {{"p", Array::own(std::vector<float>{1, 2, 3, 4})}};
    result.grid.point_numbers = Array::own(std::vector<std::int64_t>{7, 8, 9, 10});
    return result;
}

GridReply made_reply() {
    GridReply reply{made_result()};
    reply.boundary.is_there = true;
    reply.boundary.print = {5, 6};
    reply.boundary.surface.positions = Array::own(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    reply.boundary.surface.triangles = Array::own(std::vector<std::uint32_t>{0, 1, 2}, 3);
    reply.boundary.surface.edge_ends = Array::own(std::vector<std::int64_t>{0, 0, 1, 1, 2, 2}, 2);
    reply.boundary.cells.cells.connectivity = Array::own(std::vector<std::int32_t>{3, 2, 1, 0});
    reply.boundary.cells.cell_fields = {{"r", Array::own(std::vector<double>{8})}};
    reply.read.share_isovalues = {0.25, 0.5};
    reply.read.digests = {{"r", Array::own(std::vector<double>{8, 9})}};
    return reply;
}

SurveyedGrid made_survey() {
    SurveyedGrid surveyed;
    surveyed.read = made_result();
    surveyed.read.cells_in_file = 9;
    surveyed.read.grid.cell_fields = {{"q", Array::own(std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9})}};
    GridReport& report = surveyed.report.emplace();
    report.points = 4;
    report.cells = 9;
    report.cells_by_type = {{10, 9}};
    report.tets = 8;
    report.unused_points = 2;
    report.upper = {1, 2, 3};
    surveyed.sampled = {8};
    return surveyed;
}

class MemoryFile {
public:
    explicit MemoryFile(const std::string& content = {})
        : number(::memfd_create("test", MFD_CLOEXEC | MFD_ALLOW_SEALING)) {
        EXPECT_EQ(::pwrite(number, content.data(), content.size(), 0), static_cast<ssize_t>(content.size()));
    }
    ~MemoryFile() { ::close(number); }
    std::string content() const {
        std::string bytes(static_cast<std::size_t>(::lseek(number, 0, SEEK_END)), '\0');
        EXPECT_EQ(::pread(number, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
        return bytes;
    }
    int number;
};

/// Reads every scalar, so that a view outside the mapping is a crash.
std::size_t touch(const Reply& reply) {
    std::size_t sum = 0;
    const auto add = [&](const Array& array) {
        for (std::size_t i = 0; i < array.bytes(); ++i) sum += static_cast<const unsigned char*>(array.data())[i];
    };
    const auto* surveyed = std::get_if<SurveyedGrid>(&reply);
    const auto* grid = std::get_if<GridReply>(&reply);
    if (const auto* result = surveyed ? &surveyed->read : grid ? &grid->read : nullptr) {
        for (const Array* array : {&result->grid.points, &result->grid.cells.connectivity, &result->grid.cells.offsets,
                                   &result->grid.cells.types})
            add(*array);
        for (const auto* fields : {&result->grid.point_fields, &result->grid.cell_fields, &result->digests})
            for (const Field& field : *fields) add(field.values);
    }
    if (grid) add(grid->boundary.cells.cells.connectivity);
    for (std::size_t i = 0; grid && i < grid->boundary.surface.triangles.tuples(); ++i) // of vertices that are there
        sum +=
            static_cast<std::size_t>(std::abs(grid->boundary.surface.positions.at(
                                         static_cast<std::size_t>(grid->boundary.surface.triangles.at(i, 0)), 0)) < 2);
    return sum;
}

TEST(Reply, ComesBackAsItWasWritten) {
    const MemoryFile file;
    ASSERT_TRUE(write_reply(file.number, made_reply()));
    const auto reply = map_reply(file.number);
    ASSERT_TRUE(reply) << reply.error().message;
    const auto* grid = std::get_if<GridReply>(&*reply);
    ASSERT_TRUE(grid);
    EXPECT_TRUE(grid->boundary.is_there);
    EXPECT_EQ(grid->boundary.print[1], 6u);
    EXPECT_EQ(grid->boundary.surface.triangles.at(0, 2), 2);
    EXPECT_EQ(grid->boundary.surface.positions.at(2, 1), 1);
    EXPECT_EQ(grid->boundary.cells.cells.connectivity.at(0), 3);
    EXPECT_EQ(grid->boundary.cells.cell_fields.at(0).values.at(0), 8);
    EXPECT_EQ(grid->read.share_isovalues, (std::vector<double>{0.25, 0.5}));
    EXPECT_EQ(grid->read.digests.at(0).values.at(1), 9);
    const ReadResult* const result = &grid->read;
    EXPECT_EQ(result->info.fields.at(0).name, "p");
    EXPECT_EQ(result->info.times, (std::vector<double>{0.5, 1.5}));
    ASSERT_EQ(result->info.left_out.size(), 1u);
    EXPECT_EQ(result->info.left_out[0].name, "q");
    EXPECT_EQ(result->info.left_out[0].reason, "its type is 'Foo'");
    EXPECT_EQ(result->notes, std::vector<std::string>{"a note"});
    EXPECT_EQ(result->grid.points.at(3, 2), 1);
    EXPECT_EQ(result->grid.cells.connectivity.type(), ScalarType::int32);
    EXPECT_EQ(result->grid.point_fields.at(0).values.at(3), 4);
    EXPECT_EQ(result->grid.point_numbers.at(3), 10);
    ASSERT_EQ(result->info.regions.size(), 1U);
    EXPECT_EQ(result->info.regions[0].field + result->info.regions[0].name, "materialsteel");
    EXPECT_EQ(result->info.regions[0].number, 10);
}

TEST(Reply, WithABoundaryThatHasOtherVerticesIsAnError) {
    GridReply reply = made_reply();
    reply.boundary.surface.triangles = Array::own(std::vector<std::uint32_t>{0, 1, 3}, 3);
    const MemoryFile file;
    ASSERT_TRUE(write_reply(file.number, std::move(reply)));
    EXPECT_FALSE(map_reply(file.number));
}

TEST(Reply, OfCountsComesBackAsItWasWritten) {
    const MemoryFile file;
    ASSERT_TRUE(write_reply(file.number, made_survey()));
    const auto reply = map_reply(file.number);
    ASSERT_TRUE(reply) << reply.error().message;
    const auto* surveyed = std::get_if<SurveyedGrid>(&*reply);
    ASSERT_TRUE(surveyed && surveyed->report);
    const GridReport expected = *made_survey().report;
    EXPECT_EQ(surveyed->report->points, expected.points);
    EXPECT_EQ(surveyed->report->cells, expected.cells);
    EXPECT_EQ(surveyed->report->cells_by_type, expected.cells_by_type);
    EXPECT_EQ(surveyed->report->tets, expected.tets);
    EXPECT_EQ(surveyed->report->unused_points, expected.unused_points);
    EXPECT_EQ(surveyed->report->upper, expected.upper);
    EXPECT_EQ(surveyed->sampled, std::vector<std::uint64_t>{8});
    EXPECT_EQ(surveyed->read.grid.cell_fields.at(0).values.at(8), 9);
}

TEST(Reply, OfCountsWithASampleThatDoesNotFitIsAnError) {
    const auto is_read = [](const SurveyedGrid& surveyed) {
        const MemoryFile file;
        return write_reply(file.number, surveyed) && map_reply(file.number);
    };
    SurveyedGrid survey = made_survey();
    EXPECT_TRUE(is_read(survey));
    survey.sampled = {9}; // is no cell
    EXPECT_FALSE(is_read(survey));
    survey.sampled = {7, 8}; // one cell is there
    EXPECT_FALSE(is_read(survey));
    survey = made_survey();
    survey.read.cells_in_file = 10; // and 9 values
    EXPECT_FALSE(is_read(survey));
}

TEST(Reply, CannotBeChangedOnceItIsMapped) {
    const MemoryFile file;
    ASSERT_TRUE(write_reply(file.number, made_reply()));
    const auto reply = map_reply(file.number);
    ASSERT_TRUE(reply);
    EXPECT_EQ(::pwrite(file.number, "x", 1, 64), -1);
    EXPECT_EQ(::ftruncate(file.number, 0), -1);
}

TEST(Reply, ThatItsWriterStillMapsForWritingIsRefused) {
    const MemoryFile file;
    ASSERT_TRUE(write_reply(file.number, made_reply()));
    void* window = ::mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, file.number, 0);
    ASSERT_NE(window, MAP_FAILED);
    const auto reply = map_reply(file.number);
    EXPECT_FALSE(reply);
    ::munmap(window, 4096);
}

TEST(Reply, IsAnErrorForEveryTruncation) {
    const MemoryFile whole;
    ASSERT_TRUE(write_reply(whole.number, made_reply()));
    const std::string content = whole.content();
    for (std::size_t length = 0; length < content.size(); ++length)
        EXPECT_FALSE(map_reply(MemoryFile(content.substr(0, length)).number)) << length;
}

TEST(Reply, WithAnyBytesChangedIsAnErrorOrStaysInsideTheMapping) {
    const MemoryFile read, counted;
    ASSERT_TRUE(write_reply(read.number, made_reply()));
    ASSERT_TRUE(write_reply(counted.number, made_survey()));
    const std::array contents{read.content(), counted.content()};
    std::mt19937 random(1);
    std::size_t sum = 0, refused = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        std::string broken = contents[trial % 2];
        for (unsigned changes = 1 + random() % 3; changes > 0; --changes) {
            const std::size_t at = random() % broken.size();
            broken[at] = random() % 2 ? static_cast<char>(random()) : static_cast<char>(random() % 2 ? 0xFF : 0x7F);
        }
        const MemoryFile file(broken);
        if (const auto reply = map_reply(file.number)) sum += touch(*reply);
        else ++refused;
    }
    EXPECT_GT(sum, 0u);
    EXPECT_GT(refused, 1000u);
}

TEST(Request, ComesBackAsItWasWritten) {
    Request request;
    request.task = Task::inspect;
    request.format = "exodus";
    request.path = "/a/b c.e";
    request.options.point_fields = {"p", "q"};
    request.options.step = 7;
    request.options.memory_limit = 1u << 30;
    request.options.allow_outside = true;
    request.options.blocks = {"steel", "7"};
    const auto decoded = decode_request(encode(request));
    ASSERT_TRUE(decoded);
    EXPECT_EQ(decoded->task, Task::inspect);
    EXPECT_EQ(decoded->path, request.path);
    EXPECT_EQ(decoded->options.point_fields, request.options.point_fields);
    EXPECT_FALSE(decoded->options.cell_fields);
    EXPECT_EQ(decoded->options.step, request.options.step);
    EXPECT_TRUE(decoded->options.allow_outside);
    EXPECT_EQ(decoded->options.blocks, request.options.blocks);
    EXPECT_EQ(decoded->options.memory_limit, request.options.memory_limit);
}

TEST(Request, CutShortIsAnError) {
    const std::string bytes = encode(Request{});
    for (std::size_t length = 0; length < bytes.size(); ++length) EXPECT_FALSE(decode_request(bytes.substr(0, length)));
    EXPECT_FALSE(decode_request(bytes + "x"));
}

} // namespace
} // namespace isotet::io::confined
