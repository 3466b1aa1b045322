// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/packed_file.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

#include <fmt/core.h>

#include "base/buffer.hpp"
#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "io/files/crc32c.hpp"
#include "base/system/output_file.hpp"
#include "io/files/text_scanner.hpp"
#include "io/packed/appended_file.hpp"
#include "io/packed/boundary_piece.hpp"
#include "io/packed/cell_fields.hpp"
#include "io/packed/chunk_places.hpp"
#include "io/packed/directory.hpp"
#include "packed/residency.hpp"

namespace isotet {

namespace io {

namespace {

using core::ClusterHeader;
using core::Packed;

constexpr std::size_t most_components = 9; ///< of a cell field
constexpr std::uint32_t most_chunk_bytes = std::uint32_t{1} << 24;

/// Chunks end where their topology has `chunk_bytes` or more.
std::vector<ChunkEntry> cut_into_chunks(const Packed& packed, std::uint32_t chunk_bytes) {
    std::vector<ChunkEntry> chunks;
    std::uint64_t bytes = chunk_bytes;
    for (const ClusterHeader& h : packed.headers) {
        if (bytes >= chunk_bytes) {
            chunks.emplace_back();
            bytes = 0;
        }
        const std::array<std::uint64_t, unit_count> own{h.own_points, h.words(), core::ClusterLinks::words(h),
                                                        h.groups()};
        ChunkEntry& chunk = chunks.back();
        ++chunk.clusters;
        for (std::size_t u = 0; u < unit_count; ++u) chunk.counts[u] += static_cast<std::uint32_t>(own[u]);
        bytes += 4 * own[1] + 4 * own[2] + 2 * own[3];
    }
    return chunks;
}

/// Of the points, in the user's coordinates: into an entry with `lower` and `upper`.
template <class Entry>
void find_bounds(const Packed& packed, Entry& d) {
    d.lower.fill(std::numeric_limits<double>::max());
    d.upper.fill(std::numeric_limits<double>::lowest());
    std::visit(
        [&](const auto& reals) {
            for (std::size_t i = 0; i < reals.positions.size(); ++i) {
                const double x = static_cast<double>(reals.positions[i]);
                d.lower[i % 3] = std::min(d.lower[i % 3], x);
                d.upper[i % 3] = std::max(d.upper[i % 3], x);
            }
        },
        packed.reals);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (packed.points() == 0) d.lower[axis] = d.upper[axis] = 0;
        else {
            d.lower[axis] += packed.origin[axis];
            d.upper[axis] += packed.origin[axis];
        }
    }
}

PackedDirectory directory_of(const Packed& packed, std::uint32_t chunk_bytes) {
    PackedDirectory d;
    d.precision = packed.single() ? Precision::float32 : Precision::float64;
    d.point_type = packed.point_type;
    d.wide_point_ids = !packed.wide_point_ids.empty();
    d.cell_ids = packed.has_cell_ids();
    d.wide_cell_ids = !packed.wide_cell_ids.empty();
    d.ranks = !packed.point_ranks.empty();
    d.clusters = packed.clusters();
    d.user_points = packed.user_points;
    d.user_cells = packed.user_cells;
    d.origin = packed.origin;
    d.report = packed.report;
    d.frame = packed.frame;
    d.chunks = cut_into_chunks(packed, chunk_bytes);
    for (const ChunkEntry& chunk : d.chunks)
        for (std::size_t u = 0; u < unit_count; ++u) d.counts[u] += chunk.counts[u];
    find_bounds(packed, d);
    return d;
}

template <class T>
std::span<const std::byte> part_of(const core::SharedBuffer<T>& array, std::uint64_t first, std::uint64_t count) {
    if (array.empty()) return {};
    return std::as_bytes(std::span(array.data() + first, count));
}

} // namespace

/// Writes one file, new or behind what is there.
class PackedOutput {
public:
    using Parts = std::vector<std::span<const std::byte>>;

    /// Of a file that has this grid.
    PackedOutput(AppendedFile file, std::shared_ptr<const Packed> packed, PackedDirectory directory)
        : file_(std::move(file)),
          packed_(std::move(packed)),
          directory_(std::move(directory)),
          places_(ChunkPlaces::compact(directory_)) {}
    PackedOutput(core::OutputFile file, std::shared_ptr<const Packed> packed, std::uint32_t chunk_bytes)
        : file_(std::move(file)),
          packed_(std::move(packed)),
          directory_(directory_of(*packed_, chunk_bytes)),
          places_(ChunkPlaces::compact(directory_)) {}

    Result<void> write_cells(const Progress& progress);
    Result<void> write_boundary(const Progress& progress);
    Result<void> compare_cells() const;
    void take_boundary(std::vector<std::uint64_t> points) { boundary_points_ = std::move(points); }
    Result<void> write_field(const Packed& packed, std::uint32_t step, std::optional<double> time);
    Result<void> write_cell_field(const Field& field);
    Result<std::uint64_t> finish();
    std::uint32_t last_step() const { return directory_.fields.back().step; }
    double last_time() const { return directory_.fields.back().time; }

private:
    Result<std::uint32_t> write_piece(const Parts& parts, bool aligned);
    Parts points_of(const Packed& packed, std::size_t k) const;
    Parts positions_of(const Packed& packed, std::size_t k) const;
    Parts topology_of(std::size_t k) const;
    std::vector<std::uint16_t> clusters_of(std::size_t k) const;
    Result<void> write_chunk(std::size_t k);
    Result<void> write_clusters();
    Result<void> write(std::span<const std::byte> bytes) {
        return std::visit([&](auto& file) { return file.write(bytes); }, file_);
    }
    std::uint64_t bytes() const {
        return std::visit([](const auto& file) { return file.bytes(); }, file_);
    }
    Result<void> align();
    Result<void> check_new_field(const Packed& packed, std::uint32_t step) const;
    Result<bool> has_numbers_of_chunk(std::size_t k, std::uint64_t at) const;
    bool has_points_of_chunks(const Packed& packed) const;
    bool has_points_of(const Packed& packed, std::uint32_t step) const;
    void remember_points(const Packed& packed) {
        std::visit([&](const auto& reals) { positions_ = reals.positions; }, packed.reals);
    }
    Result<void> write_points(const Packed& packed, std::uint32_t step);
    Result<void> take_points(const Packed& packed, std::uint32_t step);
    template <class Real>
    Result<void> write_values(const Packed& packed, FieldEntry& entry);

    std::variant<core::OutputFile, AppendedFile> file_;
    std::shared_ptr<const Packed> packed_;
    PackedDirectory directory_;
    ChunkPlaces places_;
    std::vector<std::uint64_t> boundary_points_; ///< packed ones, where the file has the boundary
    /// Those of the last step, once a grid with them was given.
    std::optional<std::variant<core::SharedBuffer<float>, core::SharedBuffer<double>>> positions_;
};

static std::uint32_t checksum_of(const PackedOutput::Parts& parts) {
    std::uint32_t checksum = 0;
    for (const auto& part : parts) checksum = crc32c(part, checksum);
    return checksum;
}

Result<void> PackedOutput::align() {
    static constexpr std::array<std::byte, piece_alignment> zeros{};
    return write(std::span(zeros).first(align_piece(bytes()) - bytes()));
}

/// Returns the checksum.
Result<std::uint32_t> PackedOutput::write_piece(const Parts& parts, bool aligned) {
    std::uint32_t checksum = 0;
    for (const auto& part : parts) {
        checksum = crc32c(part, checksum);
        if (auto ok = write(part); !ok) return ok.error();
    }
    if (aligned)
        if (auto ok = align(); !ok) return ok.error();
    return checksum;
}

PackedOutput::Parts PackedOutput::positions_of(const Packed& packed, std::size_t k) const {
    const std::uint64_t first = places_.of(Unit::points, k), count = directory_.chunks[k].count(Unit::points);
    return std::visit([&](const auto& reals) { return Parts{part_of(reals.positions, 3 * first, 3 * count)}; },
                      packed.reals);
}

PackedOutput::Parts PackedOutput::points_of(const Packed& packed, std::size_t k) const {
    const std::uint64_t first = places_.of(Unit::points, k), count = directory_.chunks[k].count(Unit::points);
    return std::visit(
        [&](const auto& reals) {
            return Parts{part_of(reals.positions, 3 * first, 3 * count), part_of(packed.point_ids, first, count),
                         part_of(packed.wide_point_ids, first, count), part_of(packed.point_ranks, first, count)};
        },
        packed.reals);
}

PackedOutput::Parts PackedOutput::topology_of(std::size_t k) const {
    const ChunkEntry& chunk = directory_.chunks[k];
    const std::uint64_t words = places_.of(Unit::words, k), count = chunk.count(Unit::words);
    return {part_of(packed_->cells, words, count),
            part_of(packed_->links, places_.of(Unit::links, k), chunk.count(Unit::links)),
            part_of(packed_->cell_ids, words, count), part_of(packed_->wide_cell_ids, words, count)};
}

std::vector<std::uint16_t> PackedOutput::clusters_of(std::size_t k) const {
    std::vector<std::uint16_t> records;
    for (std::uint64_t c = places_.first_cluster[k]; c < places_.first_cluster[k + 1]; ++c) {
        const ClusterHeader& h = packed_->headers[c];
        records.insert(records.end(), {h.own_points, h.ghost_points, h.cells[0], h.cells[1], h.cells[2], h.cells[3],
                                       h.neighbours, h.own_seams, h.ghost_seams, h.wide_seams});
    }
    return records;
}

Result<void> PackedOutput::write_chunk(std::size_t k) {
    const auto of_points = write_piece(points_of(*packed_, k), true);
    if (!of_points) return of_points.error();
    const auto of_topology = write_piece(topology_of(k), true);
    if (!of_topology) return of_topology.error();
    directory_.chunks[k].points_checksum = *of_points;
    directory_.chunks[k].topology_checksum = *of_topology;
    return {};
}

Result<void> PackedOutput::write_clusters() {
    directory_.clusters_offset = bytes();
    for (std::size_t k = 0; k < directory_.chunks.size(); ++k) {
        const std::vector<std::uint16_t> records = clusters_of(k);
        const auto checksum = write_piece({std::as_bytes(std::span(records))}, false);
        if (!checksum) return checksum.error();
        directory_.chunks[k].clusters_checksum = *checksum;
    }
    return align();
}

/// Whether the user's numbers and the ranks of a chunk's points are those of the file that is added to, which has the points
/// at `at`.
Result<bool> PackedOutput::has_numbers_of_chunk(std::size_t k, std::uint64_t at) const {
    const std::uint64_t positions = directory_.positions_bytes(directory_.chunks[k]);
    core::Buffer<std::byte> there(directory_.points_bytes(directory_.chunks[k]) - positions);
    if (auto ok = std::get<AppendedFile>(file_).read(at + positions, {there.data(), there.size()}); !ok)
        return ok.error();
    Parts numbers = points_of(*packed_, k);
    numbers.erase(numbers.begin());
    return checksum_of(numbers) == crc32c({there.data(), there.size()});
}

/// The packed grid against the checksums of the file. Points may have moved.
Result<void> PackedOutput::compare_cells() const {
    const Packed& packed = *packed_;
    const PackedDirectory own = directory_of(packed, most_chunk_bytes);
    const auto differs = [&](const std::string& what) {
        return invalid_argument(
            fmt::format("{}, so steps of this grid do not go into the file: it must be packed in the same "
                        "way, with the same cells and points",
                        what));
    };
    if (own.clusters != directory_.clusters || own.counts != directory_.counts ||
        own.user_points != directory_.user_points || own.user_cells != directory_.user_cells ||
        own.precision != directory_.precision)
        return differs(
            fmt::format("the file has {} packed points and {} clusters of a grid of {} points and {} cells, and the "
                        "new step {} and {} of {} and {}, or another precision",
                        directory_.count(Unit::points), directory_.clusters, directory_.user_points,
                        directory_.user_cells, own.count(Unit::points), own.clusters, own.user_points, own.user_cells));
    const PieceOffsets there(directory_);
    for (std::size_t k = 0; k < directory_.chunks.size(); ++k) {
        const ChunkEntry& chunk = directory_.chunks[k];
        const std::vector<std::uint16_t> records = clusters_of(k);
        if (checksum_of({std::as_bytes(std::span(records))}) != chunk.clusters_checksum ||
            checksum_of(topology_of(k)) != chunk.topology_checksum)
            return differs(fmt::format("the cells of chunk {} differ", k));
        if (checksum_of(points_of(packed, k)) == chunk.points_checksum) continue;
        const Result<bool> same = has_numbers_of_chunk(k, there.points[k]);
        if (!same) return same.error();
        if (!*same) return differs(fmt::format("the points of chunk {} have other numbers", k));
    }
    return {};
}

bool PackedOutput::has_points_of_chunks(const Packed& packed) const {
    for (std::size_t k = 0; k < directory_.chunks.size(); ++k)
        if (checksum_of(points_of(packed, k)) != directory_.chunks[k].points_checksum) return false;
    return packed.origin == directory_.origin;
}

/// Whether the points of a grid of the same cells are those that a step has so far.
bool PackedOutput::has_points_of(const Packed& packed, std::uint32_t step) const {
    const auto is_same = [&](const auto& reals) {
        using Buffer = std::remove_cvref_t<decltype(reals.positions)>;
        const auto* const known = positions_ ? std::get_if<Buffer>(&*positions_) : nullptr;
        return known && known->data() == reals.positions.data();
    };
    if (std::visit(is_same, packed.reals)) return true;
    const PointsEntry* const moved = directory_.points_at(step);
    if (!moved) return has_points_of_chunks(packed);
    for (std::size_t k = 0; k < directory_.chunks.size(); ++k)
        if (checksum_of(positions_of(packed, k)) != moved->checksums[k]) return false;
    return packed.origin == moved->origin;
}

/// The points of a step, which the file does not have.
Result<void> PackedOutput::write_points(const Packed& packed, std::uint32_t step) {
    PointsEntry entry;
    entry.step = step;
    entry.origin = packed.origin;
    find_bounds(packed, entry);
    entry.flushed_coordinates = packed.report.flushed_coordinates;
    entry.coarse_clusters = packed.report.coarse_clusters;
    entry.offset = bytes();
    for (std::size_t k = 0; k < directory_.chunks.size(); ++k) {
        const auto checksum = write_piece(positions_of(packed, k), true);
        if (!checksum) return checksum.error();
        entry.checksums.push_back(*checksum);
    }
    if (directory_.boundary) {
        entry.boundary_offset = bytes();
        const auto checksum = write_piece({encode_boundary_positions(packed, boundary_points_)}, true);
        if (!checksum) return checksum.error();
        entry.boundary_checksum = *checksum;
    }
    directory_.moved_points.push_back(std::move(entry));
    return {};
}

/// Writes the points of the first field of a step where they are new; another field must have the same.
Result<void> PackedOutput::take_points(const Packed& packed, std::uint32_t step) {
    if (!has_points_of(packed, step)) {
        const std::string name = in_quotes(packed.field_report.name);
        if (directory_.fields.empty() || directory_.fields.back().step == step)
            return invalid_argument(
                fmt::format("field {} of step {} has other points than the fields before it", name, step));
        if (packed.point_type != directory_.point_type)
            return invalid_argument(fmt::format("the points of step {} are {}, but those of the file {}", step,
                                                name_of(packed.point_type), name_of(directory_.point_type)));
        if (auto ok = write_points(packed, step); !ok) return ok;
    }
    remember_points(packed);
    return {};
}

Result<void> PackedOutput::write_cells(const Progress& progress) {
    if (auto ok = write(encode_packed_header()); !ok) return ok;
    directory_.chunks_offset = bytes();
    for (std::size_t k = 0; k < directory_.chunks.size(); ++k) {
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "saving was cancelled"};
        if (auto ok = write_chunk(k); !ok) return ok;
        progress("write", 0.8 * static_cast<double>(k + 1) / static_cast<double>(directory_.chunks.size()));
    }
    remember_points(*packed_);
    return write_clusters();
}

Result<void> PackedOutput::write_boundary(const Progress& progress) {
    auto found = core::find_boundary(*packed_, progress);
    if (!found) return found.error();
    BoundaryEntry entry{found->points.size(), found->triangles.tuples(), bytes(), 0};
    const auto checksum = write_piece({encode_boundary(*packed_, *found)}, true);
    if (!checksum) return checksum.error();
    entry.checksum = *checksum;
    directory_.boundary = entry;
    boundary_points_ = std::move(found->points);
    return {};
}

Result<void> PackedOutput::check_new_field(const Packed& packed, std::uint32_t step) const {
    const std::string& name = packed.field_report.name;
    if (packed.headers.data() != packed_->headers.data() || packed.reals.index() != packed_->reals.index())
        return invalid_argument(fmt::format(
            "field {} is of other cells than the file, but must be of the same packed grid", in_quotes(name)));
    for (const FieldEntry& field : directory_.fields)
        if (field.step == step && field.name == name)
            return invalid_argument(fmt::format("step {} has field {} already", step, in_quotes(name)));
    return {};
}

template <class Real>
Result<void> PackedOutput::write_values(const Packed& packed, FieldEntry& entry) {
    const auto& reals = packed.as<Real>();
    entry.ranges_offset = bytes();
    for (std::size_t k = 0; k < directory_.chunks.size(); ++k) {
        const std::uint64_t first = places_.first_cluster[k], count = directory_.chunks[k].clusters;
        const auto checksum =
            write_piece({part_of(reals.ranges, first, count), part_of(packed.has_no_data, first, count)}, false);
        if (!checksum) return checksum.error();
        entry.ranges_checksums.push_back(*checksum);
    }
    if (auto ok = align(); !ok) return ok;
    entry.values_offset = bytes();
    for (std::size_t k = 0; k < directory_.chunks.size(); ++k) {
        const ChunkEntry& chunk = directory_.chunks[k];
        const std::uint64_t points = places_.of(Unit::points, k), count = chunk.count(Unit::points);
        const auto checksum =
            write_piece({part_of(reals.values, points, count),
                         part_of(packed.group_ranges, places_.of(Unit::groups, k), chunk.count(Unit::groups)),
                         part_of(packed.gradients, points, count)},
                        true);
        if (!checksum) return checksum.error();
        entry.values_checksums.push_back(*checksum);
    }
    if (!directory_.boundary) return {};
    entry.boundary_offset = bytes();
    const auto checksum = write_piece({encode_boundary_values(packed, boundary_points_)}, true);
    if (!checksum) return checksum.error();
    entry.boundary_checksum = *checksum;
    return {};
}

Result<void> PackedOutput::write_field(const Packed& packed, std::uint32_t step, std::optional<double> time) {
    if (auto ok = check_new_field(packed, step); !ok) return ok;
    if (auto ok = take_points(packed, step); !ok) return ok;
    FieldEntry entry;
    entry.name = packed.field_report.name;
    entry.step = step;
    if (time) entry.time = *time;
    entry.type = packed.field.type();
    entry.gradients = !packed.gradients.empty();
    entry.storage = packed.storage;
    entry.report = packed.field_report;
    if (auto ok = packed.single() ? write_values<float>(packed, entry) : write_values<double>(packed, entry); !ok)
        return ok;
    directory_.fields.push_back(std::move(entry));
    return {};
}

/// Of the last step.
Result<void> PackedOutput::write_cell_field(const Field& field) {
    const Array& values = field.values;
    if (!directory_.cell_ids)
        return invalid_argument(
            fmt::format("cell field {} needs a grid that was packed with source cells, but this one was not",
                        in_quotes(field.name)));
    if (values.tuples() != directory_.user_cells || values.components() < 1 || values.components() > most_components)
        return invalid_argument(fmt::format(
            "cell field {} has {} tuples of {} components, but the grid has {} cells, and 1 to "
            "{} components are packed",
            in_quotes(field.name), values.tuples(), values.components(), directory_.user_cells, most_components));
    CellFieldEntry entry{field.name,    last_step(),
                         values.type(), static_cast<std::uint8_t>(values.components()),
                         bytes(),       block_checksums(values)};
    const CellFieldEntry* const before = find_cell_field(directory_, field.name, last_step());
    if (before && before->step == last_step())
        return invalid_argument(fmt::format("step {} has cell field {} already", last_step(), in_quotes(field.name)));
    const bool same = before && before->type == entry.type && before->components == entry.components &&
                      before->checksums == entry.checksums;
    if (same) return {};
    if (auto ok = write({static_cast<const std::byte*>(values.data()), values.bytes()}); !ok) return ok;
    directory_.cell_fields.push_back(std::move(entry));
    return align();
}

Result<std::uint64_t> PackedOutput::finish() {
    const std::vector<std::byte> directory = encode_directory(directory_);
    DirectorySlot slot{1, bytes(), directory.size(), bytes() + directory.size(), crc32c(directory)};
    if (auto ok = write(directory); !ok) return ok.error();
    if (auto* const appended = std::get_if<AppendedFile>(&file_)) {
        if (auto ok = appended->commit(slot); !ok) return ok.error();
        return slot.file_bytes;
    }
    core::OutputFile& file = std::get<core::OutputFile>(file_);
    if (auto ok = file.overwrite(packed_slots[0], encode_slot(slot)); !ok) return ok.error();
    if (auto ok = file.commit(); !ok) return ok.error();
    return slot.file_bytes;
}

} // namespace io

struct PackedWriter::Data {
    io::PackedOutput output;
    Run run;
    std::optional<Error> failed = {};
};

PackedWriter::PackedWriter(std::unique_ptr<Data> data) : data_(std::move(data)) {}
PackedWriter::PackedWriter(PackedWriter&&) noexcept = default;
PackedWriter& PackedWriter::operator=(PackedWriter&&) noexcept = default;
PackedWriter::~PackedWriter() = default;

Result<PackedWriter> PackedWriter::create(const PackedGrid& packed, const std::string& path,
                                          const SavePackedOptions& options, const Run& run) {
    return core::carry_out("saving a packed grid", run, [&](const Progress& progress) -> Result<PackedWriter> {
        if (options.chunk_bytes < 1 || options.chunk_bytes > io::most_chunk_bytes)
            return invalid_argument(fmt::format("chunks of {} bytes, but they must have 1 to {}", options.chunk_bytes,
                                                io::most_chunk_bytes));
        const auto whole = core::whole_of(packed.shared_data(), progress);
        if (!whole) return whole.error();
        Result<core::OutputFile> file = core::OutputFile::open(path);
        if (!file) return file.error();
        io::PackedOutput output(*std::move(file), *whole, options.chunk_bytes);
        if (auto ok = output.write_cells(progress); !ok) return ok.error();
        if (auto ok = output.write_boundary(progress); !ok) return ok.error();
        if (auto ok = output.write_field(**whole, 0, options.time); !ok) return ok.error();
        for (const PackedGrid& more : options.more_fields)
            if (auto ok = output.write_field(more.data(), 0, options.time); !ok) return ok.error();
        progress("write", 1);
        return PackedWriter(std::make_unique<Data>(Data{std::move(output), run}));
    });
}

Result<PackedWriter> PackedWriter::append(const PackedGrid& packed, const std::string& path, std::optional<double> time,
                                          const Run& run) {
    return core::carry_out("adding to a packed file", run, [&](const Progress& progress) -> Result<PackedWriter> {
        const auto whole = core::whole_of(packed.shared_data(), progress);
        if (!whole) return whole.error();
        Result<io::OpenedForAppending> opened = io::AppendedFile::open(path);
        if (!opened) return opened.error();
        io::PackedOutput output(std::move(opened->file), *whole, std::move(opened->directory));
        if (auto ok = output.compare_cells(); !ok) return ok.error();
        output.take_boundary(std::move(opened->boundary_points));
        if (auto ok = output.write_field(**whole, output.last_step() + 1, time); !ok) return ok.error();
        return PackedWriter(std::make_unique<Data>(Data{std::move(output), run}));
    });
}

Result<void> PackedWriter::add_field(const PackedGrid& packed) {
    return core::guarded("saving a field", [&]() -> Result<void> {
        if (!data_) return moved_from("the writer");
        const double time = data_->output.last_time();
        return data_->output.write_field(packed.data(), data_->output.last_step(),
                                         std::isnan(time) ? std::nullopt : std::optional(time));
    });
}

Result<void> PackedWriter::add_step(const PackedGrid& packed, std::optional<double> time) {
    return core::guarded("saving a step", [&]() -> Result<void> {
        if (!data_) return moved_from("the writer");
        return data_->output.write_field(packed.data(), data_->output.last_step() + 1, time);
    });
}

Result<void> PackedWriter::add_cell_field(const Field& field) {
    return core::guarded("saving a cell field", [&]() -> Result<void> {
        if (!data_) return moved_from("the writer");
        return data_->output.write_cell_field(field);
    });
}

Result<std::uint64_t> PackedWriter::commit() {
    return core::guarded("saving a packed grid", [&]() -> Result<std::uint64_t> {
        if (!data_) return moved_from("the writer");
        Result<std::uint64_t> bytes = data_->output.finish();
        data_.reset();
        return bytes;
    });
}

Result<void> save_packed(const PackedGrid& packed, const std::string& path, const SavePackedOptions& options,
                         const Run& run) {
    Result<PackedWriter> writer = PackedWriter::create(packed, path, options, run);
    if (!writer) return writer.error();
    const Result<std::uint64_t> bytes = writer->commit();
    return bytes ? Result<void>() : bytes.error();
}

} // namespace isotet
