// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Of grids in pieces active cells only are read: the files are those of all cells.
#include <isotet/jobs/draw_files.hpp>
#include <isotet/jobs/extract_files.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <isotet/grid.hpp>
#include <isotet/make.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "grid/cells.hpp"
#include "jobs/listener.hpp"
#include "pieces/partition.hpp"
#include "support/counted_cells.hpp"
#include "support/seeds.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::expect_counted;
using test::Listener;
using test::some_of;

/// What the pieces of a grid are like.
struct Cut {
    std::string shape = "kuhn";
    std::uint64_t side = 12;
    std::size_t pieces = 5;
    bool ids = false;
    std::uint64_t more = 0; ///< of so many cells of the grid one more is in each piece,
    bool marked = false;    ///< marked as a ghost cell or not
    bool rounded = false;   ///< points of different pieces differ by rounding
    bool wide = false;      ///< float64 points
    bool blocks = true;     ///< of cells along x, else at random
};

std::vector<std::vector<std::uint64_t>> cells_of(const Grid& grid, const Cut& cut, std::mt19937& random) {
    const core::CellReader reader = core::CellReader::open(grid).value();
    std::vector<std::vector<std::uint64_t>> cells(cut.pieces);
    for (std::uint64_t cell = 0; cell < reader.count(); ++cell) {
        const double x = (grid.points.at(reader.corner(reader.first(cell))) + 1) / 2;
        const auto slab = static_cast<std::size_t>(x * static_cast<double>(cut.pieces));
        cells[cut.blocks ? std::min(slab, cut.pieces - 1) : random() % cut.pieces].push_back(cell);
    }
    return cells;
}

/// Coordinates that differ by a rounding, in some of the points.
Array rounded_points(const Array& points, std::mt19937& random) {
    std::vector<float> out;
    for (const float value : points.as<float>()) out.push_back(random() % 4 == 0 ? std::nextafter(value, 2.0f) : value);
    return Array::own(std::move(out), 3);
}

Array widened(const Array& values) {
    std::vector<double> out;
    for (std::size_t i = 0; i < values.tuples(); ++i)
        for (std::size_t k = 0; k < values.components(); ++k) out.push_back(1e3 + values.at(i, k));
    return Array::own(std::move(out), values.components());
}

Cells no_cells() {
    Cells cells;
    cells.connectivity = Array::own(std::vector<std::int64_t>{});
    return cells;
}

using Change = std::function<void(std::size_t piece, Grid& grid)>;

/// Writes the pieces and their index; returns the path of this.
std::string write_pieces(const test::TemporaryFolder& folder, const Cut& cut, const Change& change = {},
                         Compression compression = Compression::none) {
    std::mt19937 random(7);
    const Grid whole =
        make_grid({.shape = cut.shape, .side = cut.side, .fields = {"gyroid", "integer", "plane"}}).value();
    auto lists = cells_of(whole, cut, random);
    std::string index = "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid GhostLevel=\"0\">\n";
    for (std::size_t p = 0; p < lists.size(); ++p) {
        const std::size_t own = lists[p].size();
        for (std::uint64_t cell = p; cut.more > 0 && cell < whole.cells.count(); cell += cut.more)
            if (std::ranges::find(lists[p], cell) == lists[p].end()) lists[p].push_back(cell);
        const PointField gyroid{"gyroid", whole.point_fields[0].values, false, {}};
        test::GridPiece piece = test::piece_of(whole, gyroid, lists[p], random);
        Grid grid = std::move(piece.grid);
        for (const Field& field : whole.point_fields)
            grid.point_fields.push_back({field.name, test::taken(field.values, piece.points)});
        if (cut.ids) grid.point_fields.push_back({"GlobalNodeId", grid.point_numbers});
        grid.point_numbers = {};
        if (cut.rounded) grid.points = rounded_points(grid.points, random);
        if (cut.wide) {
            grid.points = widened(grid.points);
            grid.point_fields[0].values = widened(grid.point_fields[0].values);
        }
        std::vector<std::uint8_t> marks(own, 0);
        marks.resize(lists[p].size(), 1);
        if (cut.marked) grid.cell_fields = {{"vtkGhostType", Array::own(std::move(marks))}};
        if (change) change(p, grid);
        const std::string name = "piece" + std::to_string(p) + ".vtu";
        EXPECT_TRUE(write_grid(grid, folder.file(name), {.compression = compression}));
        index += "<Piece Source=\"" + name + "\"/>\n";
    }
    return folder.write("all.pvtu", index + "</PUnstructuredGrid></VTKFile>\n");
}

ReadOptions reading(std::vector<double> isovalues, const std::string& field = "gyroid") {
    ReadOptions options;
    options.cell_fields = std::vector<std::string>{};
    if (!isovalues.empty()) options.active_cells = ReadActiveCells{field, std::move(isovalues), {}};
    return options;
}

bool same_bytes(const Array& a, const Array& b) {
    return a.type() == b.type() && a.bytes() == b.bytes() &&
           (a.bytes() == 0 || std::memcmp(a.data(), b.data(), a.bytes()) == 0);
}

/// Active cells of the file, with the points and notes of the whole grid.
void expect_streamed(const std::string& file) {
    const auto some = read(file, reading({0.1})), all = read(file, reading({}));
    ASSERT_TRUE(some) << some.error().message;
    ASSERT_TRUE(all) << all.error().message;
    EXPECT_EQ(some->cells_in_file, all->grid.cells.count());
    EXPECT_LT(some->grid.cells.count(), all->grid.cells.count() * 4 / 5);
    EXPECT_EQ(some->notes, all->notes);
    EXPECT_TRUE(same_bytes(some->grid.points, all->grid.points));
    ASSERT_EQ(some->grid.point_fields.size(), all->grid.point_fields.size());
    for (std::size_t i = 0; i < some->grid.point_fields.size(); ++i) {
        EXPECT_EQ(some->grid.point_fields[i].name, all->grid.point_fields[i].name);
        EXPECT_TRUE(same_bytes(some->grid.point_fields[i].values, all->grid.point_fields[i].values));
    }
}

bool read_all_cells(const Listener& listener) {
    return std::ranges::find(listener.details, "reading all cells of step 0") != listener.details.end();
}

struct Asked {
    std::string field = "gyroid";
    std::vector<double> isovalues = {0.1, -0.7, 0};
    bool edge_ends = false, source_cells = false, degenerate = false;
    int threads = 0;
    Normals normals = Normals::none;
    std::vector<std::string> with = {}; ///< empty: all point fields
    std::vector<std::string> cells = {};
};

/// The job's file: the bytes are those of the engine that always reads all cells.
void expect_same_surface(const test::TemporaryFolder& folder, const std::string& file, const Asked& asked,
                         bool may_read_all = false) {
    ExtractJob job;
    job.grid.file = file;
    job.out = folder.file("surface.vtp");
    job.field.name = asked.field;
    job.isovalues = asked.isovalues;
    job.allow_empty = true;
    job.contour.edge_ends = asked.edge_ends;
    job.contour.source_cells = asked.source_cells;
    job.keep_degenerate = asked.degenerate;
    job.contour.normals = asked.normals;
    if (!asked.with.empty()) job.with = asked.with;
    job.grid.cells = asked.cells;
    Listener listener(asked.threads), other;
    const auto numbers = extract_files(job, listener);
    ASSERT_TRUE(numbers) << numbers.error().message;
    const std::string written = test::content_of(job.out);
    job.engine = EngineChoice::reference;
    const auto expected = extract_files(job, other);
    ASSERT_TRUE(expected) << expected.error().message;
    EXPECT_TRUE(written == test::content_of(job.out));
    EXPECT_EQ(numbers->cells, expected->cells);
    EXPECT_TRUE(may_read_all || !read_all_cells(listener));
}

TEST(ActiveCellsOfPieces, GiveTheGridAndTheFileOfAllCells) {
    const test::TemporaryFolder folder;
    for (const char* shape : test::some_of({"shuffled", "kuhn", "hex", "wedge", "pyramid"}))
        for (const bool ids : {false, true})
            for (const bool blocks : {false, true}) {
                SCOPED_TRACE(testing::Message() << shape << (ids ? ", ids" : "") << (blocks ? ", blocks" : ""));
                const std::string file = write_pieces(folder, {.shape = shape, .ids = ids, .blocks = blocks});
                expect_streamed(file);
                expect_same_surface(folder, file, {});
            }
}

TEST(ActiveCellsOfPieces, MayBeThoseOfARegion) {
    const test::TemporaryFolder folder;
    const auto add_region = [](std::size_t piece, Grid& grid) {
        std::vector<std::int32_t> region(grid.cells.count());
        for (std::size_t cell = 0; cell < region.size(); ++cell)
            region[cell] = static_cast<std::int32_t>(piece + 3 * cell / region.size());
        grid.cell_fields.push_back({"region", Array::own(std::move(region))});
    };
    for (const char* shape : {"shuffled", "hex", "mixed"})
        for (const bool marked : {false, true}) {
            SCOPED_TRACE(testing::Message() << shape << (marked ? ", marked" : ""));
            const Cut cut{.shape = shape, .more = marked ? 11U : 0U, .marked = marked};
            const std::string file = write_pieces(folder, cut, add_region);
            ReadOptions options = reading({0.1});
            options.cell_fields = {"region"};
            options.active_cells->conditions = {{"region", {{1, 1}, {3, 9}}, false}};
            const auto some = read(file, options);
            ASSERT_TRUE(some) << some.error().message;
            ASSERT_TRUE(some->chosen_cells);
            EXPECT_LT(*some->chosen_cells, *some->cells_in_file);
            expect_same_surface(
                folder, file, {.edge_ends = true, .source_cells = true, .with = {"region"}, .cells = {"region=1,3:9"}});
            expect_same_surface(folder, file, {.source_cells = true, .cells = {"!region=2"}});
        }
}

/// The pieces of an index as those of one file, its arrays appended raw.
std::string in_one_file(const test::TemporaryFolder& folder, std::size_t pieces) {
    std::string elements, data;
    for (std::size_t p = 0; p < pieces; ++p) {
        const std::string text = test::content_of(folder.file("piece" + std::to_string(p) + ".vtu"));
        const std::size_t appended = text.find("<AppendedData"), first = text.find("<Piece");
        std::string element = text.substr(first, text.find("</Piece>") + 8 - first);
        constexpr std::string_view offset = "offset=\"";
        for (std::size_t at = element.find(offset); at != std::string::npos; at = element.find(offset, at + 1)) {
            const std::size_t begin = at + offset.size(), size = element.find('"', begin) - begin;
            element.replace(begin, size, std::to_string(std::stoull(element.substr(begin, size)) + data.size()));
        }
        elements += element;
        const std::size_t begin = text.find('_', appended) + 1;
        data += text.substr(begin, text.rfind("</AppendedData>") - begin);
    }
    return folder.write("one.vtu", "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
                                   "header_type=\"UInt64\"><UnstructuredGrid>" +
                                       elements + "</UnstructuredGrid><AppendedData encoding=\"raw\">_" + data +
                                       "</AppendedData></VTKFile>");
}

TEST(ActiveCellsOfPieces, AreFoundInOneFileWithSeveralPieces) {
    const test::TemporaryFolder folder;
    for (const bool marked : {false, true})
        for (const char* shape : some_of<const char*>({"mixed", "shuffled"})) {
            SCOPED_TRACE(testing::Message() << shape << (marked ? ", marked" : ""));
            const Cut cut{.shape = shape, .ids = marked, .more = 11, .marked = marked};
            write_pieces(folder, cut);
            const std::string file = in_one_file(folder, cut.pieces);
            expect_streamed(file);
            expect_same_surface(folder, file, {.edge_ends = true});
        }
}

/// The pieces of an index as blocks.
std::string as_blocks(const test::TemporaryFolder& folder, std::size_t pieces) {
    std::string blocks;
    for (std::size_t p = 0; p < pieces; ++p) {
        const std::string number = std::to_string(p);
        blocks += "<DataSet index=\"" + number + "\" file=\"piece" + number + ".vtu\"/>";
    }
    return folder.write("all.vtm", "<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet>" + blocks +
                                       "</vtkMultiBlockDataSet></VTKFile>");
}

TEST(ActiveCellsOfPieces, AreFoundInBlocks) {
    const test::TemporaryFolder folder;
    write_pieces(folder, {.shape = "shuffled", .more = 20});
    const std::string file = as_blocks(folder, 5);
    expect_streamed(file);
    expect_same_surface(folder, file, {.edge_ends = true});
}

TEST(ActiveCellsOfPieces, MayBeOfSeveralTypes) {
    const test::TemporaryFolder folder;
    for (const bool marked : {false, true}) {
        const std::string file =
            write_pieces(folder, {.shape = "mixed", .more = 7, .marked = marked, .blocks = marked});
        expect_streamed(file);
        expect_same_surface(folder, file, {.edge_ends = true});
        expect_same_surface(folder, file, {.field = "integer", .isovalues = {2}});
    }
    // Each piece of one type, which is another one in the next piece.
    write_pieces(folder, {.shape = "hex", .pieces = 2});
    write_pieces(folder, {.shape = "wedge", .pieces = 1}); // piece 0 again
    const std::string file =
        folder.write("two.pvtu", "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><Piece Source=\"piece1.vtu\"/>"
                                 "<Piece Source=\"piece0.vtu\"/></PUnstructuredGrid></VTKFile>");
    expect_same_surface(folder, file, {.edge_ends = true}, true);
}

TEST(ActiveCellsOfPieces, AreFoundInCompressedBlocks) {
    const test::TemporaryFolder folder;
    for (const char* shape : some_of<const char*>({"mixed", "kuhn", "pyramid"}))
        for (const Compression compression : {Compression::zlib, Compression::lz4})
            expect_streamed(write_pieces(folder, {.shape = shape}, {}, compression));
}

TEST(ActiveCellsOfPieces, KeepEdgeEndsDegenerateTrianglesAndTies) {
    const test::TemporaryFolder folder;
    const std::string file = write_pieces(folder, {.shape = "shuffled", .side = 9});
    expect_same_surface(folder, file, {.edge_ends = true});
    expect_same_surface(folder, file, {.field = "integer", .isovalues = {2, 3}});
    expect_same_surface(folder, file, {.field = "integer", .isovalues = {2}, .edge_ends = true, .degenerate = true});
}

std::vector<double> many_isovalues() {
    std::vector<double> isovalues;
    for (int i = 0; i < 13; ++i) isovalues.push_back(0.17 * ((5 * i) % 13) - 1);
    return isovalues;
}

TEST(ActiveCellsOfPieces, AreOfAnyNumberOfIsovalues) {
    const test::TemporaryFolder folder;
    for (const char* shape : some_of<const char*>({"mixed", "shuffled"})) {
        const std::string file = write_pieces(folder, {.shape = shape});
        expect_same_surface(folder, file, {.isovalues = many_isovalues(), .edge_ends = true});
        expect_same_surface(folder, file, {.field = "integer", .isovalues = {0, 1, 2, 3, 4, 5, 6, 7, 8}});
    }
}

TEST(ActiveCellsOfPieces, HaveThoseAroundThemForGradientNormals) {
    const test::TemporaryFolder folder;
    for (const char* shape : some_of<const char*>({"mixed", "shuffled", "hex"}))
        for (const std::uint64_t more : {0, 7})
            for (const bool marked : {false, true}) {
                SCOPED_TRACE(testing::Message() << shape << ", more " << more << (marked ? ", marked" : ""));
                const std::string file = write_pieces(folder, {.shape = shape, .more = more, .marked = marked});
                const Asked asked{.edge_ends = marked, .normals = Normals::gradient};
                expect_same_surface(folder, file, asked);
                expect_same_surface(folder, as_blocks(folder, 5), asked);
                expect_same_surface(folder, file, {.field = "integer", .isovalues = {2}, .normals = Normals::gradient});
            }
}

TEST(ActiveCellsOfPieces, HaveTheNumbersOfAllAsSourceCells) {
    const test::TemporaryFolder folder;
    for (const char* shape : some_of<const char*>({"mixed", "shuffled"})) {
        expect_same_surface(folder, write_pieces(folder, {.shape = shape}), {.source_cells = true});
        expect_same_surface(folder, write_pieces(folder, {.shape = shape, .more = 7, .marked = true}),
                            {.isovalues = many_isovalues(), .source_cells = true});
        expect_same_surface(folder, write_pieces(folder, {.shape = shape, .more = 7}), {.source_cells = true});
        expect_same_surface(folder, write_pieces(folder, {.shape = shape, .more = 7}),
                            {.source_cells = true, .normals = Normals::gradient});
        write_pieces(folder, {.shape = shape, .more = 3, .marked = true});
        // Alone, with ghost cells: the points of these are in no other cell.
        expect_same_surface(folder, folder.file("piece1.vtu"), {.source_cells = true}, true);
    }
}

TEST(ActiveCellsOfPieces, HaveTheirValuesOfCellFields) {
    const test::TemporaryFolder folder;
    const auto add_fields = [](std::size_t piece, Grid& grid) { // of another type in each, and not in all
        const std::size_t cells = grid.cells.count();
        std::vector<double> numbers(cells);
        std::vector<std::int32_t> whole(cells);
        std::vector<float> vectors(3 * cells);
        for (std::size_t i = 0; i < cells; ++i) {
            numbers[i] = static_cast<double>(1000 * piece + i);
            whole[i] = static_cast<std::int32_t>(i);
            for (std::size_t k = 0; k < 3; ++k) vectors[3 * i + k] = static_cast<float>(numbers[i]) / (1 + k);
        }
        grid.cell_fields.push_back(
            {"number", piece == 1 ? Array::own(std::move(whole)) : Array::own(std::move(numbers))});
        if (piece != 2) grid.cell_fields.push_back({"vector", Array::own(std::move(vectors), 3)});
        if (piece == 0) grid.cell_fields.push_back({"odd", Array::own(std::vector<float>(2 * cells, 1.5f), 2)});
        if (piece == 3) grid.cell_fields.push_back({"odd", Array::own(std::vector<float>(cells, 2.5f))});
    };
    for (const char* shape : some_of<const char*>({"mixed", "shuffled"}))
        for (const bool marked : {false, true})
            for (const std::uint64_t more : {0, 7}) {
                SCOPED_TRACE(testing::Message() << shape << (marked ? ", marked " : " ") << more);
                const std::string file = write_pieces(folder, {.shape = shape, .more = more, .marked = marked},
                                                      add_fields, marked ? Compression::zlib : Compression::none);
                ReadOptions options;
                const ReadResult all = read(file, options).value();
                options.active_cells = ReadActiveCells{"gyroid", {0.1}, {}};
                const ReadResult some = read(file, options).value();
                EXPECT_EQ(some.notes, all.notes);
                ASSERT_TRUE(some.cells_in_file);
                EXPECT_LT(some.grid.cells.count(), *some.cells_in_file);
                ASSERT_EQ(some.grid.cell_fields.size(), all.grid.cell_fields.size());
                expect_same_surface(folder, file, {.with = {"number", "vector", "integer"}});
                expect_same_surface(folder, as_blocks(folder, 5), {.with = {"number", "vector"}});
            }
}

/// Adds cell fields, in the last piece perhaps of another type.
Change cell_fields_in(std::size_t pieces, bool alike) {
    return [=](std::size_t piece, Grid& grid) {
        const std::size_t cells = grid.cells.count();
        std::vector<float> part(cells);
        std::vector<std::int32_t> region(cells);
        for (std::size_t i = 0; i < cells; ++i) {
            part[i] = i % 41 == 0 ? NAN : static_cast<float>(i * 7919 % 100) / 100;
            region[i] = static_cast<std::int32_t>(piece + 2 * i / cells);
        }
        grid.cell_fields.push_back({"part", Array::own(std::move(part))});
        const bool is_other = !alike && piece + 1 == pieces;
        grid.cell_fields.push_back(
            {"region", is_other ? widened(Array::own(std::move(region))) : Array::own(std::move(region))});
    };
}

TEST(ActiveCellsOfPieces, AreOfCellFieldsThatAreAveraged) {
    const test::TemporaryFolder folder;
    for (const char* shape : some_of<const char*>({"mixed", "shuffled", "hex"}))
        for (const char* field : {"part", "region", "part+region/4"})
            for (const bool alike : {true, false})
                for (const Cut& cut : {Cut{}, Cut{.ids = true}, Cut{.more = 7, .marked = true}, Cut{.more = 9}}) {
                    SCOPED_TRACE(testing::Message() << shape << " " << field << alike << cut.ids << cut.more);
                    Cut of_shape = cut;
                    of_shape.shape = shape;
                    const std::string file = write_pieces(folder, of_shape, cell_fields_in(of_shape.pieces, alike));
                    ReadOptions options = reading({0.52}, field);
                    options.cell_fields = {"part", "region"};
                    options.active_cells->averages = true;
                    const ReadResult some = read(file, options).value();
                    const bool overlap = cut.more > 0 && !cut.marked;
                    EXPECT_EQ(some.cells_in_file.has_value(), alike && !overlap);
                    expect_same_surface(folder, file, {.field = field, .isovalues = {0.52, 1.1}});
                    expect_same_surface(folder, as_blocks(folder, 5), {.field = field, .isovalues = {0.52}});
                }
}

TEST(ActiveCellsOfPieces, AreNotCountedBesideFlatOnesWithValues) {
    const test::TemporaryFolder folder;
    const auto piece = [](const std::string& cells, const std::string& offsets, const std::string& types,
                          const std::string& values, int count) {
        return "<Piece NumberOfPoints='4' NumberOfCells='" + std::to_string(count) +
               "'><CellData><DataArray type='Float64' Name='q'>" + values +
               "</DataArray></CellData><Points><DataArray type='Float64' NumberOfComponents='3'>0 0 0 1 0 0 0 1 0 0 0 1"
               "</DataArray></Points><Cells><DataArray type='Int64' Name='connectivity'>" +
               cells + "</DataArray><DataArray type='Int64' Name='offsets'>" + offsets +
               "</DataArray><DataArray type='UInt8' Name='types'>" + types + "</DataArray></Cells></Piece>";
    };
    const std::string file =
        folder.write("both.vtu", "<VTKFile type='UnstructuredGrid'><UnstructuredGrid>" +
                                     piece("0 1 2 0 2 3", "3 6", "5 5", "100 200", 2) +
                                     piece("0 1 2 3", "4", "10", "7", 1) + "</UnstructuredGrid></VTKFile>");
    expect_counted(file, false);
}

TEST(ActiveCellsOfPieces, AreCountedAsTheyGoBy) {
    const test::TemporaryFolder folder;
    const auto number_cells = [](std::size_t piece, Grid& grid) {
        std::vector<double> numbers(grid.cells.count());
        for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(1000 * piece + i);
        grid.cell_fields.push_back({"number", Array::own(std::move(numbers))});
    };
    for (const char* shape : test::some_of({"shuffled", "mixed", "hex"}))
        for (const bool ids : {false, true}) {
            SCOPED_TRACE(testing::Message() << shape << (ids ? ", ids" : ""));
            const Cut cut{.shape = shape, .ids = ids};
            expect_counted(write_pieces(folder, cut, number_cells), true);
            expect_counted(in_one_file(folder, cut.pieces), true);
            expect_counted(as_blocks(folder, cut.pieces), true);
            expect_counted(write_pieces(folder, {.shape = shape, .ids = ids, .more = 9, .marked = true}, number_cells),
                           true);
            expect_counted(write_pieces(folder, {.shape = shape, .ids = ids, .more = 9}), false);
        }
}

TEST(ActiveCellsOfPieces, AreEnoughForPicturesWithTheBoundary) {
    const test::TemporaryFolder folder;
    for (const char* shape : some_of<const char*>({"mixed", "shuffled"}))
        for (const auto& [more, marked] : {std::pair(0, false), std::pair(7, true), std::pair(7, false)}) {
            SCOPED_TRACE(testing::Message() << shape << " " << more << (marked ? ", marked" : ""));
            DrawJob job;
            job.grid.file =
                write_pieces(folder, {.shape = shape, .more = static_cast<std::uint64_t>(more), .marked = marked},
                             [](std::size_t piece, Grid& grid) { // numbers of pieces, and in one a part
                                 std::vector<std::int32_t> number(grid.cells.count(), static_cast<int>(piece));
                                 std::vector<float> part(grid.cells.count());
                                 for (std::size_t i = 0; i < part.size(); ++i) part[i] = static_cast<float>(i % 9);
                                 grid.cell_fields.push_back({"number", Array::own(std::move(number))});
                                 if (piece == 1) grid.cell_fields.push_back({"part", Array::own(std::move(part))});
                             });
            job.out = folder.file("a.png");
            job.picture.width = 120;
            job.picture.height = 90;
            job.plain = true;
            for (const char* color : {"", "number", "part", "boundary"}) {
                SCOPED_TRACE(color);
                const bool of_boundary = color == std::string("boundary");
                job.field.name = of_boundary ? "" : "gyroid";
                job.isovalues = of_boundary ? std::vector<double>{} : std::vector{0.1};
                job.color_by = of_boundary ? "" : color;
                job.boundary_color_by = of_boundary ? "part" : "";
                job.stretch.clear();
                Listener listener, other;
                ASSERT_TRUE(draw_files(job, listener));
                const std::string drawn = test::content_of(job.out);
                job.stretch = {1, 1, 1}; // needs all cells
                ASSERT_TRUE(draw_files(job, other));
                EXPECT_TRUE(drawn == test::content_of(job.out));
                EXPECT_EQ(listener.noted, other.noted);
                const bool repeats = more > 0 && !marked; // cells whose colours are those of other pieces
                EXPECT_EQ(std::ranges::any_of(listener.details,
                                              [](const std::string& detail) {
                                                  return detail.find("cells were kept") != std::string::npos;
                                              }),
                          !repeats || color == std::string());
            }
        }
}

TEST(ActiveCellsOfPieces, LeaveGhostCellsOut) {
    const test::TemporaryFolder folder;
    for (const std::uint64_t more : {3, 40})
        for (const bool ids : {false, true}) {
            SCOPED_TRACE(testing::Message() << more << (ids ? ", ids" : ""));
            const std::string file = write_pieces(folder, {.ids = ids, .more = more, .marked = true});
            expect_streamed(file);
            expect_same_surface(folder, file, {.edge_ends = true});
        }
}

TEST(ActiveCellsOfPieces, CountOnceThoughPiecesOverlap) {
    const test::TemporaryFolder folder;
    for (const bool ids : {false, true}) {
        const std::string file = write_pieces(folder, {.shape = "shuffled", .ids = ids, .more = 9});
        const auto some = read(file, reading({0.1})).value();
        EXPECT_TRUE(std::ranges::any_of(
            some.notes, [](const std::string& note) { return note.find("pieces overlap") != std::string::npos; }));
        expect_streamed(file);
        expect_same_surface(folder, file, {.edge_ends = true});
    }
}

TEST(ActiveCellsOfPieces, SharePointsThatDifferByRounding) {
    const test::TemporaryFolder folder;
    for (const bool ids : {false, true}) {
        const std::string file = write_pieces(folder, {.ids = ids, .rounded = true});
        expect_streamed(file);
        expect_same_surface(folder, file, {});
    }
    const std::string wide = write_pieces(folder, {.shape = "shuffled", .wide = true});
    expect_streamed(wide);
    expect_same_surface(folder, wide, {.isovalues = {1000.1, 1000}});
}

TEST(ActiveCellsOfPieces, TakeFieldsThatSomePiecesLackOrHaveOtherwise) {
    const test::TemporaryFolder folder;
    const std::string file = write_pieces(folder, {}, [](std::size_t piece, Grid& grid) {
        if (piece == 1) grid.point_fields.pop_back();
        if (piece == 2) grid.point_fields[1].values = widened(grid.point_fields[1].values); // jumps by 1000
    });
    expect_streamed(file);
    expect_same_surface(folder, file, {.isovalues = {0.1}});
    expect_same_surface(folder, file, {.field = "integer", .isovalues = {500}});
}

TEST(ActiveCellsOfPieces, DoNotShareThePointsThatNoCellHas) {
    const test::TemporaryFolder folder;
    // The last piece has each point of the first, and no cell with it.
    std::vector<float> places;
    const std::string file = write_pieces(folder, {}, [&](std::size_t piece, Grid& grid) {
        const auto own = grid.points.as<float>();
        std::vector<float> all(own.begin(), own.end());
        if (piece == 0) places = all;
        if (piece != 4) return;
        all.insert(all.end(), places.begin(), places.end());
        grid.points = Array::own(std::move(all), 3);
        for (Field& field : grid.point_fields) {
            std::vector<double> values(grid.points.tuples(), 0.5);
            for (std::size_t i = 0; i < field.values.tuples(); ++i) values[i] = field.values.at(i);
            field.values = Array::own(std::move(values));
        }
    });
    const auto some = read(file, reading({0.1})).value(), all = read(file, reading({})).value();
    EXPECT_TRUE(same_bytes(some.grid.points, all.grid.points));
    EXPECT_EQ(some.notes, all.notes);
    expect_same_surface(folder, file, {}, true);
}

TEST(ActiveCellsOfPieces, AreReadWithEmptyPiecesAndPiecesWithoutCells) {
    const test::TemporaryFolder folder;
    const std::string file = write_pieces(folder, {}, [](std::size_t piece, Grid& grid) {
        if (piece == 3) grid.cells = no_cells();
        if (piece != 0) return;
        grid.points = Array::own(std::vector<float>{}, 3);
        for (Field& field : grid.point_fields) field.values = Array::own(std::vector<float>{});
        grid.cells = no_cells();
    });
    const auto some = read(file, reading({0.1})).value(), all = read(file, reading({})).value();
    EXPECT_TRUE(same_bytes(some.grid.points, all.grid.points));
    EXPECT_EQ(some.notes, all.notes);
    expect_same_surface(folder, file, {}, true);
}

TEST(ActiveCellsOfPieces, AreReadThoughNoCellIsCut) {
    const test::TemporaryFolder folder;
    for (const bool marked : {false, true}) {
        const std::string file = write_pieces(folder, {.more = 5, .marked = marked});
        expect_same_surface(folder, file, {.isovalues = {17}});
    }
}

TEST(ActiveCellsOfPieces, AreAllReadWhereAPieceComesTwice) {
    const test::TemporaryFolder folder;
    write_pieces(folder, {});
    const std::string file = folder.write(
        "twice.pvtu", "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><Piece Source=\"piece1.vtu\"/>"
                      "<Piece Source=\"piece0.vtu\"/><Piece Source=\"piece1.vtu\"/></PUnstructuredGrid></VTKFile>");
    expect_same_surface(folder, file, {.edge_ends = true}, true);
}

TEST(ActiveCellsOfPieces, AreTheSameForAnyNumberOfThreads) {
    const test::TemporaryFolder folder;
    const std::string file = write_pieces(folder, {.shape = "shuffled", .side = 20, .pieces = 9, .more = 15});
    for (const int threads : test::some_of({7, 2, 1}))
        expect_same_surface(folder, file, {.edge_ends = true, .threads = threads});
}

TEST(ActiveCellsOfPieces, TellWhichPieceIsBroken) {
    const test::TemporaryFolder folder;
    const std::string file = write_pieces(folder, {});
    const std::string path = folder.file("piece2.vtu");
    const Grid piece = read(path).value().grid;
    std::string text = test::content_of(path);
    const auto corners = std::as_bytes(piece.cells.connectivity.as<std::int32_t>().first(8));
    const std::size_t at = text.find(std::string_view(reinterpret_cast<const char*>(corners.data()), corners.size()));
    ASSERT_NE(at, std::string::npos);
    const std::int32_t wrong = 98765;
    text.replace(at + 5 * sizeof wrong, sizeof wrong, reinterpret_cast<const char*>(&wrong), sizeof wrong);
    folder.write("piece2.vtu", text);
    const auto some = read(file, reading({0.1})), all = read(file, reading({}));
    ASSERT_FALSE(some);
    ASSERT_FALSE(all);
    EXPECT_EQ(some.error().message, all.error().message);
    EXPECT_NE(some.error().message.find("cell 1 has point 98765"), std::string::npos) << some.error().message;
}

} // namespace
} // namespace isotet::jobs
