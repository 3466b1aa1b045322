// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/fields.hpp>
#include <isotet/packed_file.hpp>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <span>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/system/memory.hpp"
#include "io/files/crc32c.hpp"
#include "io/files/text_scanner.hpp"
#include "io/packed/boundary_piece.hpp"
#include "io/packed/cell_fields.hpp"
#include "io/packed/file_grid.hpp"

namespace isotet {

struct PackedFile::Data {
    std::shared_ptr<const io::PackedSource> source;
    PackedFileInfo info;
    std::uint64_t limit = 0;
    mutable std::mutex mutex;
    mutable std::shared_ptr<io::PackedStore> store; ///< null before the first grid

    Result<std::shared_ptr<io::PackedStore>> opened_store(const Progress& progress) const;
    Result<const io::FieldEntry*> find(std::string_view field, std::size_t step) const;
};

namespace {

PackedFileInfo info_of(const io::PackedSource& source) {
    const io::PackedDirectory& d = source.directory;
    PackedFileInfo info;
    info.major = io::packed_major;
    info.minor = source.minor;
    info.file_bytes = source.file.size;
    info.precision = d.precision;
    info.point_type = d.point_type;
    info.user_points = d.user_points;
    info.user_cells = d.user_cells;
    info.unpacked_bytes = io::bytes_of_whole(d, d.fields.front()) + io::bytes_of_unpacked(d) +
                          d.user_points * size_of(d.fields.front().type);
    info.report = d.report;
    info.chunks = d.chunks.size();
    info.source_cells = d.cell_ids;
    info.lower = d.lower;
    info.upper = d.upper;
    info.steps = d.fields.back().step + std::size_t{1};
    for (const io::FieldEntry& field : d.fields) {
        if (field.step == info.times.size() && !std::isnan(field.time)) info.times.push_back(field.time);
        info.fields.push_back({field.step, field.type, field.report, field.gradients});
    }
    for (const io::CellFieldEntry& field : d.cell_fields)
        info.cell_fields.push_back({field.step, field.name, field.type, field.components});
    for (const io::PointsEntry& points : d.moved_points)
        info.moved_points.push_back({points.step, points.lower, points.upper});
    if (info.times.size() < info.steps) info.times.clear();
    return info;
}

/// The boundary in the file against that of the cells. Its points.
Result<std::vector<std::uint64_t>> check_boundary(const io::PackedSource& source, const core::Packed& packed,
                                                  const Progress& progress) {
    auto stored = io::read_boundary(source, 0);
    if (!stored) return stored.error();
    const auto found = core::find_boundary(packed, progress);
    if (!found) return found.error();
    const io::BoundaryEntry& entry = *source.directory.boundary;
    if (entry.points != found->points.size() || entry.triangles != found->triangles.tuples() ||
        entry.checksum != io::crc32c(io::encode_boundary(packed, *found)))
        return source.in_file(invalid_data("the boundary is broken: it is not that of the cells"));
    return std::move(stored->points);
}

/// Moved positions of the boundary's points against those of the grid.
Result<void> check_boundary_positions(const io::PackedSource& source, const io::FieldEntry& field,
                                      const core::Packed& packed, const std::vector<std::uint64_t>& points) {
    const io::PointsEntry* const moved = source.directory.points_at(field.step);
    if (!moved || io::crc32c(io::encode_boundary_positions(packed, points)) == moved->boundary_checksum) return {};
    return source.in_file(invalid_data(
        fmt::format("the boundary is broken: its points at step {} are not those of the grid", field.step)));
}

/// Values of a field at the points of the boundary against those of the grid.
Result<void> check_boundary_values(const io::PackedSource& source, const io::FieldEntry& field,
                                   const core::Packed& packed, const std::vector<std::uint64_t>& points) {
    if (auto ok = check_boundary_positions(source, field, packed, points); !ok) return ok;
    if (const auto read = io::read_boundary(source, field.step); !read) return read.error();
    const auto checked = std::visit(
        [&]<class Real>(const core::Values<Real>&) -> Result<void> {
            const auto values = io::read_boundary_values<Real>(source, field);
            return values ? Result<void>() : values.error();
        },
        packed.reals);
    if (!checked) return checked;
    if (io::crc32c(io::encode_boundary_values(packed, points)) == field.boundary_checksum) return {};
    return source.in_file(invalid_data(fmt::format(
        "the boundary is broken: the values of {} there are not those of the points", io::in_quotes(field.name))));
}

} // namespace

PackedFile::PackedFile(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

Result<PackedFile> PackedFile::open(const std::string& path, const PackedFileOptions& options, const Run& run) {
    return core::carry_out("opening a packed file", run, [&](const Progress&) -> Result<PackedFile> {
        auto source = io::PackedSource::open(path);
        if (!source) return source.error();
        auto data = std::make_shared<Data>();
        data->source = *std::move(source);
        data->info = info_of(*data->source);
        data->limit = options.memory ? options.memory : core::free_memory() / 2;
        return PackedFile(std::move(data));
    });
}

bool PackedFile::is_one(const std::string& path) {
    const Result<core::PlainFile> file = core::open_plain_file(path);
    std::string head(io::packed_magic.size(), '\0');
    return file && file->size >= head.size() && core::read_at(*file, path, 0, std::as_writable_bytes(std::span(head))) &&
           head == io::packed_magic;
}

const PackedFileInfo& PackedFile::info() const noexcept { return data_->info; }

Result<std::shared_ptr<io::PackedStore>> PackedFile::Data::opened_store(const Progress& progress) const {
    const std::lock_guard lock(mutex);
    if (store) return store;
    auto opened = io::PackedStore::open(source, limit, progress);
    if (opened) store = *opened;
    return opened;
}

Result<const io::FieldEntry*> PackedFile::Data::find(std::string_view field, std::size_t step) const {
    if (step >= info.steps)
        return invalid_argument(fmt::format("step {} is not there, but the file has {} step{}, counted from 0", step,
                                            info.steps, info.steps == 1 ? "" : "s"));
    std::vector<std::string> names;
    const io::FieldEntry* found = nullptr;
    for (const io::FieldEntry& entry : source->directory.fields) {
        if (entry.step != step) continue;
        names.push_back(entry.name);
        if (entry.name == field || field.empty()) found = &entry;
    }
    if (field.empty() && names.size() == 1) return found;
    if (!field.empty() && found) return found;
    names = nearest_first(field, std::move(names));
    for (std::string& name : names) name = io::in_quotes(name);
    if (field.empty())
        return invalid_argument(fmt::format("no field was named, but the file has {}", fmt::join(names, ", ")));
    return invalid_argument(fmt::format("field {} is not in the file at step {}, which has {}", io::in_quotes(field),
                                        step, fmt::join(names, ", ")));
}

Result<PackedGrid> PackedFile::grid(std::string_view field, std::size_t step, const Run& run) const {
    return core::carry_out("reading a packed file", run, [&](const Progress& progress) -> Result<PackedGrid> {
        const auto entry = data_->find(field, step);
        if (!entry) return entry.error();
        const auto store = data_->opened_store(progress);
        if (!store) return store.error();
        auto packed = io::grid_of_file(*store, **entry, progress);
        if (!packed) return packed.error();
        return PackedGrid(*std::move(packed));
    });
}

Result<PackedGrid> PackedFile::interpolated(std::string_view field, std::size_t step, double fraction,
                                            const Run& run) const {
    if (!(fraction >= 0 && fraction <= 1))
        return invalid_argument(
            fmt::format("a fraction of {} between steps was asked for, but it must be 0 to 1", fraction));
    if (fraction == 0) return grid(field, step, run);
    if (fraction == 1) return grid(field, step + 1, run);
    return core::carry_out("reading a packed file", run, [&](const Progress& progress) -> Result<PackedGrid> {
        const auto from = data_->find(field, step);
        if (!from) return from.error();
        const auto to = data_->find((*from)->name, step + 1);
        if (!to) return to.error();
        const auto store = data_->opened_store(progress);
        if (!store) return store.error();
        auto packed = io::blended_grid_of_file(*store, **from, **to, fraction, progress);
        if (!packed) return packed.error();
        return PackedGrid(*std::move(packed));
    });
}

Result<PackedGrid> PackedFile::sliced(const SliceShape& shape, std::size_t step, const Run& run) const {
    return core::carry_out("slicing", run, [&](const Progress& progress) -> Result<PackedGrid> {
        const auto& fields = data_->source->directory.fields;
        const auto any = std::ranges::find_if(fields, [&](const io::FieldEntry& entry) { return entry.step == step; });
        const auto entry = any == fields.end() ? data_->find({}, step) : Result<const io::FieldEntry*>(&*any);
        if (!entry) return entry.error();
        const auto store = data_->opened_store(progress);
        if (!store) return store.error();
        auto packed = io::sliced_grid_of_file(*store, **entry, shape, progress);
        if (!packed) return packed.error();
        return PackedGrid(*std::move(packed));
    });
}

Result<PackedGrid> PackedFile::load(std::string_view field, std::size_t step, const Run& run) const {
    return core::carry_out("reading a packed file", run, [&](const Progress& progress) -> Result<PackedGrid> {
        const auto entry = data_->find(field, step);
        if (!entry) return entry.error();
        auto packed = io::whole_grid_of_file(*data_->source, **entry, nullptr, progress);
        if (!packed) return packed.error();
        return PackedGrid(*std::move(packed));
    });
}

Result<Field> PackedFile::cell_field(std::string_view name, std::size_t step, const Run& run) const {
    return core::carry_out("reading a packed file", run, [&](const Progress& progress) -> Result<Field> {
        const io::PackedDirectory& directory = data_->source->directory;
        const io::CellFieldEntry* const entry = io::find_cell_field(directory, name, step);
        if (entry && step < data_->info.steps) {
            Result<Array> values = io::read_cell_field(*data_->source, *entry, progress);
            if (!values) return values.error();
            return Field{entry->name, *std::move(values)};
        }
        std::vector<std::string> names;
        for (const io::CellFieldEntry* const field : io::cell_fields_at(directory, step)) names.push_back(field->name);
        names = nearest_first(name, std::move(names));
        for (std::string& one : names) one = io::in_quotes(one);
        return invalid_argument(fmt::format("cell field {} is not in the file at step {}, which has {}",
                                            io::in_quotes(name), step,
                                            names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
    });
}

Result<void> PackedFile::check(const Run& run) const {
    return core::carry_out("checking a packed file", run, [&](const Progress& progress) -> Result<void> {
        const io::PackedSource& source = *data_->source;
        std::shared_ptr<const core::Packed> first;
        std::optional<std::vector<std::uint64_t>> boundary; ///< its points, where the file has it
        for (const io::FieldEntry& entry : source.directory.fields) {
            auto packed = io::whole_grid_of_file(source, entry, first.get(), progress);
            if (!packed) return packed.error();
            if (!first && source.directory.boundary) {
                auto points = check_boundary(source, **packed, progress);
                if (!points) return points.error();
                boundary = *std::move(points);
            }
            if (boundary)
                if (auto ok = check_boundary_values(source, entry, **packed, *boundary); !ok) return ok;
            if (!first) first = *std::move(packed);
        }
        for (const io::CellFieldEntry& field : data_->source->directory.cell_fields)
            if (auto read = io::read_cell_field(*data_->source, field, progress); !read) return read.error();
        return {};
    });
}

std::uint64_t PackedFile::read_ahead(std::string_view field, std::size_t step) const {
    const auto entry = data_->find(field, step);
    const std::lock_guard lock(data_->mutex);
    return entry && data_->store ? data_->store->read_ahead(**entry) : 0;
}

ResidencyReport PackedFile::residency() const {
    const std::lock_guard lock(data_->mutex);
    ResidencyReport report;
    if (data_->store) report = data_->store->cache().report();
    report.limit = data_->limit;
    report.bytes_read = data_->source->bytes_read.load(std::memory_order_relaxed);
    report.reads = data_->source->reads.load(std::memory_order_relaxed);
    return report;
}

} // namespace isotet
