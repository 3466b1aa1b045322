// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/grid_file.hpp>

#include <algorithm>
#include <utility>

#include <isotet/active_cells.hpp>
#include <isotet/contour.hpp>
#include <isotet/fields.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/packed_file.hpp>

namespace isotet {

struct GridFile::Data {
    std::string path;
    ReadOptions options;
    FileInfo info;

    Result<FieldArrays> arrays_of(const std::vector<std::string>& names, std::size_t step, const Run& run,
                                  bool* averages = nullptr) const;
    ReadOptions options_for(std::size_t step, const std::optional<FieldArrays>& fields) const;
    Result<ReadResult> read_closed(const ReadOptions& wanted, bool close_too, const Run& run) const;
};

namespace {

struct FieldNames {
    std::vector<std::string> point, cell;
};

FieldNames names_of(const FileInfo& info) {
    FieldNames names;
    for (const FieldInfo& field : info.fields)
        (field.association == Association::point ? names.point : names.cell).push_back(field.name);
    return names;
}

void add(std::vector<std::string>& names, const std::vector<std::string>& more) {
    for (const std::string& name : more)
        if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

/// A note on the field joins those of `read`.
Result<ContourInput> input_of(ReadResult& read, const std::string& field, const FileContourOptions& options,
                              const Run& run) {
    Result<ContourInput> input = contour_input(read.grid, field, options.with, run);
    if (!input) return input;
    if (!input->field.note.empty()) read.notes.push_back(input->field.note);
    input->grid.point_fields = input->grid.cell_fields = {};
    return input;
}

/// A session on the chunks of a packed file; nothing where it asks for what the file does not have as it is.
Result<std::optional<Contour>> session_of_packed(const std::string& path, const std::string& field,
                                                 const FileContourOptions& options, const Run& run) {
    const Result<PackedFile> file = PackedFile::open(path, {}, run);
    if (!file) return file.error();
    const auto has = [&](const std::string& name) {
        return std::ranges::any_of(file->info().fields, [&](const PackedFieldInfo& one) {
            return one.step == options.step && (one.report.name == name || name.empty());
        });
    };
    if (!has(field) || !std::ranges::all_of(options.with, has)) return std::optional<Contour>{};
    ContourInput input;
    Result<PackedGrid> grid = file->grid(field, options.step, run);
    if (!grid) return grid.error();
    input.packed = *std::move(grid);
    for (const std::string& name : options.with) {
        Result<PackedGrid> carried = file->grid(name, options.step, run);
        if (!carried) return carried.error();
        input.packed_fields.push_back(*std::move(carried));
    }
    ContourOptions as_packed = options.contour;
    if (as_packed.precision == Precision::float32) as_packed.precision = file->info().precision;
    Result<Contour> contour = Contour::create(std::move(input), as_packed, run);
    if (contour) return std::optional(*std::move(contour));
    if (contour.error().code != ErrorCode::invalid_argument) return contour.error();
    return std::optional<Contour>{};
}

Result<void> close(Grid& grid, std::vector<std::string>& notes, const Run& run) {
    Result<ClosedGrid> closed = close_hanging_points(grid, run);
    if (!closed) return closed.error();
    grid = std::move(closed->grid);
    for (std::string& note : closed->report.notes()) notes.push_back(std::move(note));
    return {};
}

} // namespace

/// `averages`   set where some follow from cell fields at points; the last name counts as contoured
Result<FieldArrays> GridFile::Data::arrays_of(const std::vector<std::string>& names, std::size_t step, const Run& run,
                                              bool* averages) const {
    FieldNames there = names_of(info);
    if (step > 0 && info.times.size() > 1) {
        ReadOptions of_step = options;
        of_step.step = step;
        const Result<FileInfo> looked = inspect(path, of_step, run);
        if (!looked) return looked.error();
        there = names_of(*looked);
    }
    FieldArrays all;
    for (const std::string& name : names) {
        if (name.empty()) { // the only one there is
            add(all.point, there.point);
            add(all.cell, there.cell);
            if (averages && !there.cell.empty()) *averages = true;
            continue;
        }
        const Result<FieldArrays> one = arrays_of_field(name, there.point, there.cell);
        if (!one) return one;
        add(all.point, one->point);
        add(all.cell, one->cell);
        all.neighbours = all.neighbours || one->neighbours;
        const bool as_it_is = &name != &names.back() && one->point.empty() && one->cell == std::vector{name};
        if (averages && !one->cell.empty() && !as_it_is) *averages = true;
    }
    return all;
}

ReadOptions GridFile::Data::options_for(std::size_t step, const std::optional<FieldArrays>& fields) const {
    ReadOptions wanted = options;
    if (!info.times.empty() || step > 0) wanted.step = step; // else the reader's own choice
    if (!fields) return wanted;
    wanted.point_fields = fields->point;
    wanted.cell_fields = fields->cell;
    return wanted;
}

std::optional<ReadActiveCells> active_cells_for(const std::string& field, const ContourOptions& options) {
    if (!Contour::can_do_with_active_cells(options) ||
        options.expected_isovalues.size() > ActiveCellFilter::max_isovalues)
        return std::nullopt;
    ReadActiveCells active{field, options.expected_isovalues, {}};
    active.options.precision = options.precision;
    active.options.extract.ties = options.ties;
    active.options.extract.source_cells = options.source_cells;
    active.options.extract.normals = options.normals;
    return active;
}

std::optional<GridPart> part_of(const ReadResult& read, bool has_cells_around,
                                std::function<Result<ReadResult>(const Run&)> read_all,
                                std::function<Result<std::vector<Field>>(const Grid&, const Run&)> cell_fields) {
    if (!read.cells_in_file && read.cell_numbers.empty()) return std::nullopt;
    GridPart part{{}, read.cell_numbers, has_cells_around};
    if (!read.cells_in_file || !read_all) return part;
    part.whole = [read_all = std::move(read_all),
                  cell_fields = std::move(cell_fields)](const Run& run) -> Result<ContourInput> {
        Result<ReadResult> all = read_all(run);
        if (!all) return all.error();
        ContourInput input;
        if (cell_fields) {
            Result<std::vector<Field>> fields = cell_fields(all->grid, run);
            if (!fields) return fields.error();
            input.cell_fields = *std::move(fields);
        }
        input.part = part_of(*all, false, {});
        input.grid = std::move(all->grid);
        return input;
    };
    return part;
}

GridFile::GridFile(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

Result<GridFile> GridFile::open(const std::string& path, ReadOptions options, const Run& run) {
    options.point_fields.reset();
    options.cell_fields.reset();
    options.step.reset();
    options.active_cells.reset();
    if (!options.kept) options.kept = keep_files();
    Result<FileInfo> info = inspect(path, options, run);
    if (!info) return info.error();
    return GridFile(std::make_shared<const Data>(Data{path, std::move(options), *std::move(info)}));
}

const FileInfo& GridFile::info() const noexcept { return data_->info; }

Result<ReadResult> GridFile::read(std::size_t step, const std::optional<std::vector<std::string>>& fields,
                                  const Run& run) const {
    std::optional<FieldArrays> arrays;
    if (fields) {
        Result<FieldArrays> found = data_->arrays_of(*fields, step, run);
        if (!found) return found.error();
        arrays = *std::move(found);
    }
    return isotet::read(data_->path, data_->options_for(step, arrays), run);
}

/// What `wanted` says, closed. Where its active cells alone are read, no point hangs on them.
Result<ReadResult> GridFile::Data::read_closed(const ReadOptions& wanted, bool close_too, const Run& run) const {
    Result<ReadResult> result = isotet::read(path, wanted, run);
    if (!result || !close_too || result->cells_in_file) return result;
    if (auto closed = close(result->grid, result->notes, run); !closed) return closed.error();
    return result;
}

Result<FileSession> GridFile::session(const std::string& field, const FileContourOptions& options,
                                      const Run& run) const {
    const ReadOptions& opened = data_->options;
    if (data_->info.format == "isotet" && opened.displace.empty() && opened.blocks.empty() && !opened.patches) {
        Result<std::optional<Contour>> packed = session_of_packed(data_->path, field, options, run);
        if (!packed) return packed.error();
        if (*packed) return FileSession{**std::move(packed), {}};
    }
    std::vector<std::string> names = options.with;
    names.push_back(field);
    bool averages = false;
    const Result<FieldArrays> arrays = data_->arrays_of(names, options.step, run, &averages);
    if (!arrays) return arrays.error();
    ReadOptions wanted = data_->options_for(options.step, *arrays);
    if (!averages && !arrays->neighbours) wanted.active_cells = active_cells_for(field, options.contour);
    Result<ReadResult> read = data_->read_closed(wanted, options.close_hanging_points, run);
    if (!read) return read.error();
    Result<ContourInput> input = input_of(*read, field, options, run);
    if (!input) return input.error();
    wanted.active_cells.reset();
    const auto read_all = [data = data_, wanted, close_too = options.close_hanging_points](const Run& later) {
        return data->read_closed(wanted, close_too, later);
    };
    const auto cell_fields = [field, with = options.with](const Grid& all, const Run& later) {
        Result<ContourInput> same = contour_input(all, field, with, later);
        return same ? Result<std::vector<Field>>(std::move(same->cell_fields)) : same.error();
    };
    input->part = part_of(*read, options.contour.normals == Normals::gradient, read_all, cell_fields);
    Result<Contour> contour = Contour::create(*std::move(input), options.contour, run);
    if (!contour) return contour.error();
    return FileSession{*std::move(contour), std::move(read->notes)};
}

Result<ContourResult> GridFile::contour(const std::string& field, std::span<const double> isovalues,
                                        const FileContourOptions& options, const Run& run) const {
    FileContourOptions once = options;
    once.contour.expected_isovalues.assign(isovalues.begin(), isovalues.end());
    if (once.contour.surfaces == 0) once.contour.surfaces = isovalues.size();
    Result<FileSession> started = session(field, once, run);
    if (!started) return started.error();
    Result<ContourResult> result = started->contour.extract(isovalues, run);
    if (!result) return result;
    result->notes.insert(result->notes.begin(), started->notes.begin(), started->notes.end());
    return result;
}

} // namespace isotet
