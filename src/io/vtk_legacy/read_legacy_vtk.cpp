// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Legacy VTK files as grids: unstructured, and the structured kinds as hexahedra.
#include "io/vtk_legacy/read_legacy_vtk.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "grid/cells.hpp"
#include "io/files/escape.hpp"
#include "io/files/kept_files.hpp"
#include "io/files/read_tuples.hpp"
#include "io/files/text_scanner.hpp"
#include "io/pieces/join/join.hpp"
#include "io/pieces/survey_unread.hpp"
#include "io/pieces/uniform_cells.hpp"
#include "io/vtk_legacy/legacy_cells.hpp"
#include "io/vtk_legacy/legacy_polyhedra.hpp"
#include "io/vtk_legacy/legacy_vtk.hpp"
#include "io/vtk_legacy/old_hexahedra.hpp"
#include "io/vtk_xml/columns.hpp"
#include "io/vtk_xml/load.hpp"
#include "io/vtk_xml/stored_array.hpp"
#include "io/write/write_stream.hpp"

namespace isotet::io {
namespace {

using vtk_xml::GridSize;

template <class Offset>
Array offsets_as(const LegacyCells& cells) {
    core::Buffer<Offset> offsets(static_cast<std::size_t>(cells.count) + 1);
    core::parallel_each(offsets.size(), std::size_t{1} << 16,
                        [&](std::size_t i) { offsets[i] = static_cast<Offset>(i * cells.corners); });
    return std::move(offsets).to_array();
}

Array offsets_of(const LegacyCells& cells) {
    const bool narrow = cells.connectivity.tuples() <= std::numeric_limits<std::int32_t>::max();
    return narrow ? offsets_as<std::int32_t>(cells) : offsets_as<std::int64_t>(cells);
}

/// True where types and offsets say nothing.
bool says_nothing(const LegacyFile& file) {
    return file.one_type && file.cells.offsets.empty() && core::is_contoured(*file.one_type) &&
           file.cells.corners == static_cast<std::uint64_t>(core::corners_of(*file.one_type));
}

/// Cells without types are none, as in VTK.
Result<Cells> cells_of(const LegacyFile& file) {
    Cells cells;
    const LegacyCells& list = file.cells;
    if (list.count == 0 || file.cell_type_count == 0) return cells;
    if (file.cell_type_count != list.count)
        return invalid_data(fmt::format("there are {} cells, but {} cell types", list.count, file.cell_type_count));
    cells.connectivity = list.connectivity;
    if (says_nothing(file)) {
        cells.uniform_type = static_cast<CellType>(*file.one_type);
        return cells;
    }
    cells.types = file.one_type
                      ? Array::own(std::vector<std::uint8_t>(static_cast<std::size_t>(list.count), *file.one_type))
                      : file.cell_types;
    cells.offsets = list.offsets.empty() ? offsets_of(list) : list.offsets;
    if (auto taken = take_legacy_polyhedra(cells); !taken) return taken.error();
    if (list.interleaved) reorder_old_hexahedra(cells);
    vtk_xml::simplify(cells);
    return cells;
}

/// What the file says of its size.
std::string stated_size(const LegacyFile& file) {
    const auto& [x, y, z] = file.dimensions;
    return fmt::format("{} {} {} x {} x {}", file.size_keyword, file.size_keyword == "EXTENT" ? "is of" : "are", x, y,
                       z);
}

Result<Array> structured_points(const LegacyFile& file, const GridSize& size) {
    const std::uint64_t count = size.x * size.y * size.z;
    if (file.dataset == "structured_grid") {
        if (file.points.tuples() == count) return file.points;
        return invalid_data(fmt::format("there are {} points, but {}", file.points.tuples(), stated_size(file)));
    }
    if (file.dataset == "structured_points") {
        const auto& s = file.spacing;
        return points_of(size,
                         vtk_xml::ImagePoints{file.first_index, {s[0], 0, 0, 0, s[1], 0, 0, 0, s[2]}, file.origin});
    }
    std::array<std::vector<double>, 3> ticks;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Array& along = file.coordinates[axis];
        if (along.tuples() != file.dimensions[axis])
            return invalid_data(fmt::format("there are {} coordinates along axis {}, but {}", along.tuples(),
                                            "xyz"[axis], stated_size(file)));
        for (std::size_t i = 0; i < along.tuples(); ++i) ticks[axis].push_back(along.at(i));
    }
    return points_of(size, ticks);
}

Result<void> take_structured(const LegacyFile& file, Piece& piece, std::vector<std::string>& notes) {
    const GridSize size{file.dimensions[0], file.dimensions[1], file.dimensions[2]};
    constexpr std::uint64_t most = std::uint64_t{1} << 48;
    if (size.x * size.y > most / std::max<std::uint64_t>(size.z, 1))
        return invalid_data(stated_size(file) + ": too many points");
    auto points = structured_points(file, size);
    if (!points) return points.error();
    auto cells = vtk_xml::cells_of_box(size, notes);
    if (!cells) return cells.error();
    piece.grid.points = std::move(*points);
    piece.grid.cells = std::move(*cells);
    piece.flat = vtk_xml::flatness(size);
    return {};
}

/// A file that is opened again, unless it is in memory.
struct LegacyPath {
    LegacyPath(std::string file, const ByteSource& source) : path(std::move(file)), size(source.size()) {
        if (source.is_in_memory()) held = source;
    }

    std::string path;
    std::size_t size;
    std::optional<ByteSource> held = {};

    /// Errors   file: it was changed meanwhile
    Result<ByteSource> open() const {
        if (held) return *held;
        auto source = ByteSource::open(path);
        if (source && source->size() != size)
            return Error{ErrorCode::file, fmt::format("{} was changed while it was read", escaped(path))};
        return source;
    }
};

/// A cell field that was left in the file.
class LegacyFieldSource final : public FieldSource {
public:
    /// `progress`   borrowed
    LegacyFieldSource(LegacyPath path, const ValuesInFile& values, const Progress& progress)
        : path_(std::move(path)), values_(values), progress_(progress) {}

    Result<Array> read(const std::vector<std::uint64_t>& cells) const override {
        const auto source = path_.open();
        if (!source) return source.error();
        const auto components = static_cast<std::size_t>(values_.components);
        const std::size_t size = size_of(values_.type.type);
        auto values =
            vtk_xml::filled_array(values_.type.type, cells.size(), components, [&](std::byte* to) -> Result<void> {
                auto read = read_tuples(*source, values_.begin, components * size, cells, to, progress_);
                if (read && std::endian::native != std::endian::big) swap_bytes(to, cells.size() * components, size);
                return read;
            });
        if (values && values_.type.widened)
            values = mapped<std::int64_t>(*values, [](auto value) { return static_cast<std::int64_t>(value); });
        return ordered(std::move(values));
    }

    Result<Array> read() const override {
        const auto source = path_.open();
        if (!source) return source.error();
        LegacyValues values(*source, progress_);
        values.set_binary(true);
        values.scanner().seek(values_.position);
        return ordered(values.read_values(values_.type, values_.tuples, values_.components, "the field", true));
    }

private:
    Result<Array> ordered(Result<Array> values) const {
        return values && values_.order ? ordered_as_vtk(*values, *values_.order) : std::move(values);
    }

    LegacyPath path_;
    ValuesInFile values_;
    const Progress& progress_;
};

/// Cells of one type whose corners were left in the file.
class LegacyCellSource final : public CellSource {
public:
    /// `file`       without points and fields
    /// `progress`   borrowed
    LegacyCellSource(LegacyPath path, LegacyFile file, const Progress& progress)
        : CellSource(CellPlaces(static_cast<CellType>(*file.one_type), file.cells.count), {}),
          path_(std::move(path)),
          file_(std::move(file)),
          progress_(progress) {}

    Result<void> each_block(const Visit& visit) const override {
        const auto source = path_.open();
        if (!source) return source.error();
        LegacyValues values(*source, progress_);
        values.set_binary(true);
        const auto all = each_of_corners(values, *file_.cells.in_file, [&](std::uint64_t first, const Array& corners) {
            visit(first, corners);
            return true;
        });
        if (!all) return all.error();
        return *all ? Result<void>() : invalid_data("cells have not as many corners as their type has");
    }

    Result<Cells> read() const override {
        const auto source = path_.open();
        if (!source) return source.error();
        LegacyValues values(*source, progress_);
        values.set_binary(true);
        LegacyFile file = file_;
        if (auto done = read_corners(values, file.cells); !done) return in_file(path_.path, done.error());
        auto cells = cells_of(file);
        return cells ? std::move(cells) : in_file(path_.path, cells.error());
    }

private:
    LegacyPath path_;
    LegacyFile file_;
    const Progress& progress_;
};

/// `piece`   has points and point fields
Result<void> take_cells(const ByteSource& source, const std::string& path, LegacyFile& file, const Progress& progress,
                        Piece& piece) {
    if (file.cells.in_file && !path.empty() && says_nothing(file) && file.cell_type_count == file.cells.count) {
        LegacyFile cells;
        cells.cells = file.cells;
        cells.cell_type_count = file.cell_type_count;
        cells.one_type = file.one_type;
        piece.unread = std::make_shared<const LegacyCellSource>(LegacyPath{path, source}, std::move(cells), progress);
        return {};
    }
    if (file.cells.in_file) {
        LegacyValues values(source, progress);
        values.set_binary(true);
        if (auto read = read_corners(values, file.cells); !read) return read;
    }
    auto cells = cells_of(file);
    if (!cells) return cells.error();
    piece.grid.cells = *std::move(cells);
    return {};
}

/// Gives a cell field to the piece: for later where its cells are read later.
Result<void> take_field(const LegacyPath& path, LegacyFile& file, Attribute& field, bool later,
                        const Progress& progress, Loaded& loaded, Piece& piece) {
    const auto left = file.cell_values_in_file.find(field.name);
    if (left == file.cell_values_in_file.end()) {
        if (later)
            piece.unread_fields.push_back({field.name, field.values.type(), field.values.components(),
                                           std::make_shared<const FieldInMemory>(field.values)});
        else piece.grid.cell_fields.push_back({field.name, std::move(field.values)});
        return {};
    }
    const ValuesInFile& in_file = left->second;
    auto source = std::make_shared<const LegacyFieldSource>(path, in_file, progress);
    if (later) {
        piece.unread_fields.push_back(
            {field.name, in_file.read_type(), static_cast<std::size_t>(in_file.components), std::move(source)});
        return {};
    }
    auto values = source->read();
    if (!values && values.error().code != ErrorCode::invalid_data) return values.error();
    if (!values) leave_out(loaded.info, {"cell field", field.name, values.error().message});
    else piece.grid.cell_fields.push_back({field.name, *std::move(values)});
    return {};
}

/// The sections without which a file was cut off; a count of 0 is an empty grid.
Result<void> check_sections(const LegacyFile& file) {
    for (const auto& [has, section] : {std::pair{file.has_points, "POINTS"},
                                       {file.has_cells && (file.cells.count > 0 || file.cell_type_count == 0), "CELLS"},
                                       {file.cell_type_count > 0 || file.cells.count == 0, "CELL_TYPES"}})
        if (!has) return invalid_data(fmt::format("the file ends without {}", section));
    return {};
}

bool is_grid(std::string_view dataset) { return dataset.ends_with("_grid") || dataset == "structured_points"; }

} // namespace

Result<Loaded> load_legacy(const ByteSource& source, const ReadOptions& options, Depth depth, const Progress& progress,
                           const std::string& path) {
    std::string kind;
    LegacyWants wants;
    wants.geometry = depth == Depth::arrays;
    wants.leave_corners = options.active_cells.has_value();
    if (wants.leave_corners && !are_counted(options) && !path.empty())
        wants.leave = [](std::string_view name) {
            return name != vtk_xml::ghost_rank_name && !vtk_xml::is_ghost_array(name);
        };
    wants.dataset = [&](std::string_view name) { return is_grid(kind = name); };
    wants.field = [&](Association association, std::string_view name) {
        if (!wants.geometry) return false;
        if (!vtk_xml::is_ghost_array(name)) return wanted(options, association, name);
        return association == Association::cell || kind != "unstructured_grid";
    };
    auto file = read_legacy_vtk(source, wants, progress);
    if (!kind.empty() && !is_grid(kind))
        return invalid_data(fmt::format("a legacy VTK file of type {} has no cells with a volume", in_quotes(kind)));
    if (!file) return file.error();
    if (file->dataset.empty()) return invalid_data("the file has no DATASET");
    Loaded loaded;
    loaded.info = std::move(file->info);
    std::erase_if(loaded.info.fields, [](const FieldInfo& field) { return vtk_xml::is_ghost_array(field.name); });
    loaded.notes = std::move(file->notes);
    if (depth == Depth::description) {
        if (file->dataset == "unstructured_grid")
            loaded.info.least = {file->point_count, file->cell_type_count, file->cells.announced, file->points.type()};
        return loaded;
    }
    const auto step = choose_step(loaded.info, options);
    if (!step) return step.error();
    Piece piece;
    const bool structured = file->dataset != "unstructured_grid";
    // If no field is as long as the size says, the file may be much smaller than such a grid.
    if (structured && loaded.info.fields.empty() && !loaded.info.left_out.empty()) {
        const LeftOut& first = loaded.info.left_out.front();
        return invalid_data(fmt::format("{} {} cannot be read: {}", first.what, in_quotes(first.name), first.reason));
    }
    if (structured) {
        if (auto taken = take_structured(*file, piece, loaded.notes); !taken) return taken.error();
    } else {
        if (auto whole = check_sections(*file); !whole) return whole.error();
        piece.grid.points = std::move(file->points);
    }
    if (piece.grid.points.empty()) piece.grid.points = Array(ScalarType::float32, nullptr, 0, 3, nullptr);
    const auto& [x, y, z] = file->dimensions;
    for (Attribute& field : file->point_data)
        if (!vtk_xml::is_ghost_array(field.name))
            piece.grid.point_fields.push_back({field.name, std::move(field.values)});
        else if (structured) vtk_xml::mark_around_hidden(field.values, field.name, {x, y, z}, piece.left_out);
    if (!structured)
        if (auto taken = take_cells(source, path, *file, progress, piece); !taken) return taken.error();
    const bool flat = structured && piece.cell_count() == 0; // a line or a point
    for (Attribute& field : file->cell_data) {
        if (flat) continue;
        if (field.name == vtk_xml::ghost_rank_name && field.values.tuples() == piece.cell_count())
            vtk_xml::mark_left_out(field.values, field.name, piece.left_out);
        if (!vtk_xml::is_ghost_array(field.name)) {
            if (auto taken = take_field({path, source}, *file, field, piece.unread && !are_counted(options), progress,
                                        loaded, piece);
                !taken)
                return taken.error();
        } else if (field.values.tuples() == piece.cell_count())
            vtk_xml::mark_left_out(field.values, field.name, piece.left_out);
    }
    loaded.pieces.push_back(std::move(piece));
    return loaded;
}

Result<Loaded> load_legacy_file(const std::string& path, const ReadOptions& options, Depth depth,
                                const Progress& progress) {
    const auto source = open_source(path, options, progress, [](std::string_view head) {
        return head.substr(0, 1024).find("\nASCII") != std::string_view::npos; // numbers of which none can be skipped
    });
    if (!source) return source.error();
    auto loaded = load_legacy(*source, options, depth, progress, path);
    if (!loaded) return in_file(path, loaded.error());
    for (Piece& piece : loaded->pieces) piece.name = path;
    loaded->info.format = "vtk";
    return loaded;
}

GridReader legacy_vtk_reader() {
    GridReader reader;
    reader.format = Format{"vtk", "VTK legacy file", {".vtk"}};
    reader.format.reads_grid = true;
    reader.recognizes = [](std::string_view head, std::string_view) {
        return head.starts_with("# vtk DataFile") ? 2 : 0;
    };
    reader.inspect = [](const std::string& path, const ReadOptions& options, const Progress& progress) {
        auto loaded = load_legacy_file(path, options, Depth::description, progress);
        return loaded ? Result<FileInfo>(std::move(loaded->info)) : loaded.error();
    };
    reader.read = [](const std::string& path, const ReadOptions& options, const Progress& progress) {
        auto loaded = load_legacy_file(path, options, Depth::arrays, progress);
        if (!loaded) return Result<ReadResult>(loaded.error());
        return join(std::move(*loaded), options, progress);
    };
    return reader;
}

} // namespace isotet::io
