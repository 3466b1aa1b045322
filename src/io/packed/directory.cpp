// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/packed/directory.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <type_traits>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "io/files/crc32c.hpp"
#include "io/files/text_scanner.hpp"

namespace isotet::io {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they are in memory");

class ByteWriter {
public:
    template <class T>
    void number(T value) {
        static_assert(std::is_arithmetic_v<T>);
        const auto* const at = reinterpret_cast<const std::byte*>(&value);
        bytes_.insert(bytes_.end(), at, at + sizeof value);
    }
    void text(std::string_view text) {
        number(static_cast<std::uint32_t>(text.size()));
        const auto all = std::as_bytes(std::span(text));
        bytes_.insert(bytes_.end(), all.begin(), all.end());
    }
    void pad() { bytes_.resize((bytes_.size() + 7) / 8 * 8); }
    std::vector<std::byte> take() { return std::move(bytes_); }

private:
    std::vector<std::byte> bytes_;
};

/// Reads numbers one after another; after the end zeros come, and ok() is false.
class ByteCursor {
public:
    explicit ByteCursor(std::span<const std::byte> bytes) : bytes_(bytes) {}

    template <class T>
    T number() {
        T value{};
        if (bytes_.size() < sizeof value) {
            ok_ = false;
            return value;
        }
        std::memcpy(&value, bytes_.data(), sizeof value);
        bytes_ = bytes_.subspan(sizeof value);
        return value;
    }
    template <class T>
    void into(T& value) {
        value = number<T>();
    }
    std::string text() {
        const auto size = number<std::uint32_t>();
        if (size > bytes_.size()) {
            ok_ = false;
            return {};
        }
        std::string out(reinterpret_cast<const char*>(bytes_.data()), size);
        bytes_ = bytes_.subspan(size);
        return out;
    }
    std::span<const std::byte> part(std::uint64_t size) {
        if (size > bytes_.size()) {
            ok_ = false;
            return {};
        }
        const auto out = bytes_.first(size);
        bytes_ = bytes_.subspan(size);
        return out;
    }
    std::size_t left() const { return bytes_.size(); }
    bool ok() const { return ok_; }

private:
    std::span<const std::byte> bytes_;
    bool ok_ = true;
};

constexpr std::string_view grid_section = "GRID    ", chunk_section = "CHUNKS  ", frame_section = "FRAME   ",
                           boundary_section = "BOUNDARY", boundary_values_section = "BVALUES ",
                           field_section = "FIELD   ", cell_field_section = "CELLFLD ", points_section = "POINTS  ",
                           moved_field_section = "MFIELD  "; ///< so that readers of 1.1 do not take the old points

constexpr std::uint32_t has_wide_points = 1, has_cells = 2, has_wide_cells = 4, has_ranks = 8; ///< bits of flags

constexpr std::array report_numbers{
    &PackReport::tets,          &PackReport::pyramids,        &PackReport::wedges,        &PackReport::hexahedra,
    &PackReport::split_cells,   &PackReport::cells_left_out,  &PackReport::collapsed_tets, &PackReport::repeated_tets,
    &PackReport::negative_tets, &PackReport::inverted_tets,   &PackReport::flat_tets, &PackReport::flushed_coordinates,
    &PackReport::coarse_clusters, &PackReport::bytes,         &PackReport::source_bytes};

std::vector<std::byte> encode_grid(const PackedDirectory& d) {
    ByteWriter out;
    out.number(static_cast<std::uint8_t>(d.real_bytes()));
    out.number(static_cast<std::uint8_t>(d.point_type));
    out.number(std::uint16_t{0}); // codec: none
    out.number((d.wide_point_ids ? has_wide_points : 0) | (d.cell_ids ? has_cells : 0) |
               (d.wide_cell_ids ? has_wide_cells : 0) | (d.ranks ? has_ranks : 0));
    out.number(d.clusters);
    for (const std::uint64_t count : d.counts) out.number(count);
    out.number(d.user_points);
    out.number(d.user_cells);
    out.number(d.clusters_offset);
    out.number(d.chunks_offset);
    for (const auto* numbers : {&d.origin, &d.lower, &d.upper})
        for (const double x : *numbers) out.number(x);
    for (const auto member : report_numbers) out.number(d.report.*member);
    return out.take();
}

std::vector<std::byte> encode_chunks(const PackedDirectory& d) {
    ByteWriter out;
    for (const ChunkEntry& chunk : d.chunks) {
        out.number(chunk.clusters);
        for (const std::uint32_t count : chunk.counts) out.number(count);
        out.number(chunk.clusters_checksum);
        out.number(chunk.points_checksum);
        out.number(chunk.topology_checksum);
    }
    return out.take();
}

std::vector<std::byte> encode_frame(const Frame& frame) {
    ByteWriter out;
    const Survey& whole = frame.whole;
    for (const double x : whole.lower) out.number(x);
    for (const double x : whole.upper) out.number(x);
    out.number(whole.upright);
    out.number(static_cast<std::uint32_t>(whole.points));
    out.number(whole.field_count);
    for (std::uint32_t i = 0; i < whole.field_count; ++i) {
        const FieldSurvey& field = whole.fields[i];
        out.number(field.name);
        out.number(static_cast<std::uint64_t>(field.type));
        for (const double x : {field.lower, field.upper, field.smallest, field.largest}) out.number(x);
    }
    return out.take();
}

std::vector<std::byte> encode_points(const PointsEntry& points) {
    ByteWriter out;
    out.number(points.step);
    out.number(points.boundary_checksum);
    for (const auto* numbers : {&points.origin, &points.lower, &points.upper})
        for (const double x : *numbers) out.number(x);
    for (const std::uint64_t n :
         {points.flushed_coordinates, points.coarse_clusters, points.offset, points.boundary_offset})
        out.number(n);
    for (const std::uint32_t checksum : points.checksums) out.number(checksum);
    out.pad();
    return out.take();
}

std::vector<std::byte> encode_field(const FieldEntry& field) {
    ByteWriter out;
    out.number(field.step);
    out.number(static_cast<std::uint8_t>(field.type));
    out.number(static_cast<std::uint8_t>(field.storage.unchanged));
    out.number(static_cast<std::uint8_t>(field.gradients));
    out.number(std::uint8_t{0});
    for (const double x : {field.time, field.storage.offset, field.storage.scale, field.report.lower,
                           field.report.upper})
        out.number(x);
    for (const std::uint64_t n : {field.report.no_data, field.report.infinite, field.report.flushed,
                                  field.ranges_offset, field.values_offset})
        out.number(n);
    for (std::size_t k = 0; k < field.ranges_checksums.size(); ++k) {
        out.number(field.ranges_checksums[k]);
        out.number(field.values_checksums[k]);
    }
    out.text(field.name);
    out.pad();
    return out.take();
}

std::vector<std::byte> encode_boundary_entry(const BoundaryEntry& boundary) {
    ByteWriter out;
    for (const std::uint64_t n : {boundary.points, boundary.triangles, boundary.offset}) out.number(n);
    out.number(boundary.checksum);
    out.pad();
    return out.take();
}

std::vector<std::byte> encode_boundary_values_table(const std::vector<FieldEntry>& fields) {
    ByteWriter out;
    for (const FieldEntry& field : fields) {
        out.number(field.boundary_offset);
        out.number(field.boundary_checksum);
        out.pad();
    }
    return out.take();
}

std::vector<std::byte> encode_cell_field(const CellFieldEntry& field) {
    ByteWriter out;
    out.number(field.step);
    out.number(static_cast<std::uint8_t>(field.type));
    out.number(field.components);
    out.number(std::uint16_t{0});
    out.number(field.offset);
    for (const std::uint32_t checksum : field.checksums) out.number(checksum);
    out.text(field.name);
    out.pad();
    return out.take();
}

Error broken_directory(const std::string& what) { return invalid_data("the directory is broken: " + what); }

std::optional<ScalarType> scalar_type(std::uint64_t number) {
    if (number > static_cast<std::uint64_t>(ScalarType::float64)) return std::nullopt;
    return static_cast<ScalarType>(number);
}

Result<void> decode_grid(ByteCursor in, PackedDirectory& d) {
    const auto real_bytes = in.number<std::uint8_t>();
    const auto type = scalar_type(in.number<std::uint8_t>());
    const auto codec = in.number<std::uint16_t>();
    const auto flags = in.number<std::uint32_t>();
    if (real_bytes != 4 && real_bytes != 8)
        return broken_directory(fmt::format("numbers of {} bytes, but they must have 4 or 8", real_bytes));
    if (!type || !is_floating(*type)) return broken_directory("the type of points is not float32 or float64");
    if (codec != 0) return broken_directory(fmt::format("codec {}, but only 0 is known", codec));
    d.precision = real_bytes == 4 ? Precision::float32 : Precision::float64;
    d.point_type = *type;
    d.wide_point_ids = flags & has_wide_points;
    d.cell_ids = flags & has_cells;
    d.wide_cell_ids = flags & has_wide_cells;
    d.ranks = flags & has_ranks;
    in.into(d.clusters);
    for (std::uint64_t& count : d.counts) in.into(count);
    in.into(d.user_points);
    in.into(d.user_cells);
    in.into(d.clusters_offset);
    in.into(d.chunks_offset);
    bool finite = true;
    for (auto* numbers : {&d.origin, &d.lower, &d.upper})
        for (double& x : *numbers) {
            in.into(x);
            finite &= std::isfinite(x);
        }
    for (const auto member : report_numbers) in.into(d.report.*member);
    if (!in.ok()) return broken_directory("the section of the grid ends early");
    if (!finite) return broken_directory("bounds or the origin are not finite");
    d.report.points = d.count(Unit::points);
    d.report.clusters = d.clusters;
    return {};
}

constexpr std::size_t chunk_entry_bytes = 32;

Result<void> decode_chunks(ByteCursor in, PackedDirectory& d) {
    if (in.left() % chunk_entry_bytes != 0)
        return broken_directory(fmt::format("the chunk table has {} bytes, no multiple of {}", in.left(),
                                            chunk_entry_bytes));
    d.chunks.resize(in.left() / chunk_entry_bytes);
    for (ChunkEntry& chunk : d.chunks) {
        in.into(chunk.clusters);
        for (std::uint32_t& count : chunk.counts) in.into(count);
        in.into(chunk.clusters_checksum);
        in.into(chunk.points_checksum);
        in.into(chunk.topology_checksum);
    }
    return {};
}

Result<void> decode_frame(ByteCursor in, PackedDirectory& d) {
    Frame frame;
    Survey& whole = frame.whole;
    for (double& x : whole.lower) in.into(x);
    for (double& x : whole.upper) in.into(x);
    in.into(whole.upright);
    const auto points = scalar_type(in.number<std::uint32_t>());
    in.into(whole.field_count);
    if (!points || !is_floating(*points) || whole.field_count > Survey::max_fields)
        return broken_directory("the frame has a type or a number of fields that there is not");
    whole.points = *points;
    for (std::uint32_t i = 0; i < whole.field_count; ++i) {
        FieldSurvey& field = whole.fields[i];
        in.into(field.name);
        const auto type = scalar_type(in.number<std::uint64_t>());
        if (!type) return broken_directory("a field of the frame has a type that there is not");
        field.type = *type;
        for (double* x : {&field.lower, &field.upper, &field.smallest, &field.largest}) in.into(*x);
    }
    if (!in.ok()) return broken_directory("the frame ends early");
    d.frame = frame;
    return {};
}

Result<void> decode_boundary(ByteCursor in, PackedDirectory& d) {
    BoundaryEntry boundary;
    for (std::uint64_t* n : {&boundary.points, &boundary.triangles, &boundary.offset}) in.into(*n);
    in.into(boundary.checksum);
    if (!in.ok()) return broken_directory("the section of the boundary ends early");
    d.boundary = boundary;
    return {};
}

constexpr std::size_t boundary_values_entry_bytes = 16;

/// Needs all fields.
Result<void> decode_boundary_values(ByteCursor in, PackedDirectory& d) {
    if (in.left() != boundary_values_entry_bytes * d.fields.size())
        return broken_directory(
            fmt::format("the table of values at the boundary has {} bytes, but {} fields need {} each", in.left(),
                        d.fields.size(), boundary_values_entry_bytes));
    for (FieldEntry& field : d.fields) {
        in.into(field.boundary_offset);
        in.into(field.boundary_checksum);
        in.number<std::uint32_t>();
    }
    return {};
}

/// `chunks`   of the file
Result<void> decode_points(ByteCursor in, std::size_t chunks, PackedDirectory& d) {
    PointsEntry points;
    in.into(points.step);
    in.into(points.boundary_checksum);
    bool finite = true;
    for (auto* numbers : {&points.origin, &points.lower, &points.upper})
        for (double& x : *numbers) {
            in.into(x);
            finite &= std::isfinite(x);
        }
    for (std::uint64_t* n :
         {&points.flushed_coordinates, &points.coarse_clusters, &points.offset, &points.boundary_offset})
        in.into(*n);
    if (in.left() / 4 < chunks) return broken_directory("moved points have fewer checksums than there are chunks");
    for (std::size_t k = 0; k < chunks; ++k) points.checksums.push_back(in.number<std::uint32_t>());
    if (!in.ok()) return broken_directory("a section of moved points ends early");
    if (!finite) return broken_directory("bounds or the origin of moved points are not finite");
    d.moved_points.push_back(std::move(points));
    return {};
}

/// `chunks`   of the file
Result<void> decode_field(ByteCursor in, std::size_t chunks, PackedDirectory& d) {
    FieldEntry field;
    in.into(field.step);
    const auto type = scalar_type(in.number<std::uint8_t>());
    field.storage.unchanged = in.number<std::uint8_t>() != 0;
    field.gradients = in.number<std::uint8_t>() != 0;
    in.number<std::uint8_t>();
    for (double* x : {&field.time, &field.storage.offset, &field.storage.scale, &field.report.lower,
                      &field.report.upper})
        in.into(*x);
    for (std::uint64_t* n : {&field.report.no_data, &field.report.infinite, &field.report.flushed,
                             &field.ranges_offset, &field.values_offset})
        in.into(*n);
    if (in.left() / 8 < chunks) return broken_directory("a field has fewer checksums than there are chunks");
    for (std::size_t k = 0; k < chunks; ++k) {
        field.ranges_checksums.push_back(in.number<std::uint32_t>());
        field.values_checksums.push_back(in.number<std::uint32_t>());
    }
    field.name = in.text();
    if (!in.ok()) return broken_directory("a field ends early");
    const core::Storage& storage = field.storage;
    int exponent = 0;
    const bool power_of_two =
        storage.scale > 0 && std::isfinite(storage.scale) && std::frexp(storage.scale, &exponent) == 0.5;
    if (!type || !power_of_two || !std::isfinite(storage.offset))
        return broken_directory(fmt::format("field {} has a type, an offset or a scale that there is not",
                                            in_quotes(field.name)));
    field.type = *type;
    field.report.name = field.name;
    field.report.offset = storage.offset;
    field.report.scale = storage.scale;
    field.report.unchanged = storage.unchanged;
    d.fields.push_back(std::move(field));
    return {};
}

/// Needs the section of the grid.
Result<void> decode_cell_field(ByteCursor in, std::uint64_t file_bytes, PackedDirectory& d) {
    CellFieldEntry field;
    in.into(field.step);
    const auto type = scalar_type(in.number<std::uint8_t>());
    in.into(field.components);
    in.number<std::uint16_t>();
    in.into(field.offset);
    if (!type || field.components == 0 || !d.cell_ids)
        return broken_directory(
            "a cell field has a type or a number of components that there is not, or is in a file without "
            "source cells");
    field.type = *type;
    if (d.user_cells > file_bytes / (field.components * size_of(field.type)))
        return broken_directory(fmt::format("a cell field of {} cells has more bytes than the file", d.user_cells));
    const std::uint64_t blocks = CellFieldEntry::blocks(field.bytes(d.user_cells));
    if (in.left() / 4 < blocks) return broken_directory("a cell field has fewer checksums than blocks");
    for (std::uint64_t i = 0; i < blocks; ++i) field.checksums.push_back(in.number<std::uint32_t>());
    field.name = in.text();
    if (!in.ok()) return broken_directory("a cell field ends early");
    d.cell_fields.push_back(std::move(field));
    return {};
}

/// Whether [offset, offset + bytes) lies between the header and the end.
bool lies_within(std::uint64_t offset, std::uint64_t bytes, std::uint64_t file_bytes) {
    return offset >= packed_header_bytes && offset <= file_bytes && bytes <= file_bytes - offset;
}

/// Sums of the table against the counts of the grid, and all places against the size of the file.
Result<void> check_places(const PackedDirectory& d, std::uint64_t file_bytes) {
    std::uint64_t clusters = 0, chunk_bytes = 0, ranges_bytes = 0;
    std::array<std::uint64_t, unit_count> counts{};
    for (const ChunkEntry& chunk : d.chunks) {
        if (chunk.clusters == 0) return broken_directory("a chunk has no clusters");
        clusters += chunk.clusters;
        for (std::size_t u = 0; u < unit_count; ++u) counts[u] += chunk.counts[u];
        chunk_bytes += align_piece(d.points_bytes(chunk)) + align_piece(d.topology_bytes(chunk));
        ranges_bytes += d.ranges_bytes(chunk);
        if (chunk_bytes > file_bytes)
            return broken_directory(fmt::format("the chunks have more bytes than the file, {}", file_bytes));
    }
    if (clusters != d.clusters || counts != d.counts)
        return broken_directory(fmt::format("the chunks have {} clusters and {} points, but the grid {} and {}", clusters,
                                            counts[0], d.clusters, d.count(Unit::points)));
    if (clusters > std::numeric_limits<std::uint32_t>::max())
        return broken_directory(fmt::format("{} clusters, but there can be less than 2^32", clusters));
    if (d.count(Unit::points) > d.user_points)
        return broken_directory(
            fmt::format("{} points, but the user's grid has {}", d.count(Unit::points), d.user_points));
    const auto outside = [&](const std::string& what) {
        return broken_directory(fmt::format("{} lie outside of the file of {} bytes", what, file_bytes));
    };
    if (!lies_within(d.chunks_offset, chunk_bytes, file_bytes)) return outside("the chunks");
    if (!lies_within(d.clusters_offset, cluster_record_bytes * clusters, file_bytes)) return outside("the clusters");
    if (d.boundary) {
        constexpr std::uint64_t least = 12; // bytes of a point or a triangle
        if (d.boundary->points > d.count(Unit::points) || d.boundary->triangles > file_bytes / least ||
            !lies_within(d.boundary->offset, d.boundary_bytes(), file_bytes))
            return outside("points or triangles of the boundary");
        for (const FieldEntry& field : d.fields)
            if (!lies_within(field.boundary_offset, d.boundary->points * d.real_bytes(), file_bytes))
                return outside("values of a field at the boundary");
    }
    for (const PointsEntry& points : d.moved_points) {
        std::uint64_t positions_bytes = 0;
        for (const ChunkEntry& chunk : d.chunks) positions_bytes += align_piece(d.positions_bytes(chunk));
        if (!lies_within(points.offset, positions_bytes, file_bytes) ||
            (d.boundary && !lies_within(points.boundary_offset, 3 * d.boundary->points * d.real_bytes(), file_bytes)))
            return outside("positions of moved points");
    }
    for (const CellFieldEntry& field : d.cell_fields)
        if (!lies_within(field.offset, field.bytes(d.user_cells), file_bytes)) return outside("values of a cell field");
    for (const FieldEntry& field : d.fields) {
        std::uint64_t values_bytes = 0;
        for (const ChunkEntry& chunk : d.chunks) values_bytes += align_piece(d.values_bytes(chunk, field));
        if (!lies_within(field.ranges_offset, ranges_bytes, file_bytes) ||
            !lies_within(field.values_offset, values_bytes, file_bytes))
            return outside("values of a field");
    }
    return {};
}

Result<void> check_cell_fields(const PackedDirectory& d) {
    for (std::size_t i = 0; i < d.cell_fields.size(); ++i) {
        const CellFieldEntry& field = d.cell_fields[i];
        if (field.step > d.fields.back().step || (i > 0 && field.step < d.cell_fields[i - 1].step))
            return broken_directory("steps of cell fields do not ascend, or there is no such step");
        for (std::size_t k = i; k-- > 0 && d.cell_fields[k].step == field.step;)
            if (d.cell_fields[k].name == field.name)
                return broken_directory(fmt::format("step {} has two cell fields of the same name", field.step));
    }
    return {};
}

Result<void> check_moved_points(const PackedDirectory& d) {
    for (std::size_t i = 0; i < d.moved_points.size(); ++i) {
        const std::uint32_t step = d.moved_points[i].step, before = i == 0 ? 0 : d.moved_points[i - 1].step;
        if (step <= before || step > d.fields.back().step)
            return broken_directory("steps of moved points do not ascend from 1, or there is no such step");
    }
    return {};
}

Result<void> check_fields(const PackedDirectory& d) {
    if (d.fields.empty()) return broken_directory("it has no field");
    for (std::size_t i = 0; i < d.fields.size(); ++i) {
        const FieldEntry& field = d.fields[i];
        if (i == 0 ? field.step != 0 : field.step != d.fields[i - 1].step && field.step != d.fields[i - 1].step + 1)
            return broken_directory("steps do not ascend one by one from 0");
        for (std::size_t k = i; k-- > 0 && d.fields[k].step == field.step;)
            if (d.fields[k].name == field.name)
                return broken_directory(fmt::format("step {} has two fields of the same name", field.step));
    }
    return {};
}

} // namespace

std::vector<std::byte> encode_directory(const PackedDirectory& directory) {
    std::vector<std::byte> out;
    const auto add = [&](std::string_view name, const std::vector<std::byte>& content) {
        ByteWriter head;
        for (const char c : name) head.number(c);
        head.number(static_cast<std::uint64_t>(content.size()));
        for (const std::vector<std::byte>& bytes : {head.take(), content})
            out.insert(out.end(), bytes.begin(), bytes.end());
    };
    add(grid_section, encode_grid(directory));
    add(chunk_section, encode_chunks(directory));
    if (directory.frame) add(frame_section, encode_frame(*directory.frame));
    for (const PointsEntry& points : directory.moved_points) add(points_section, encode_points(points));
    for (const FieldEntry& field : directory.fields)
        add(directory.points_at(field.step) ? moved_field_section : field_section, encode_field(field));
    for (const CellFieldEntry& field : directory.cell_fields) add(cell_field_section, encode_cell_field(field));
    if (!directory.boundary) return out;
    add(boundary_section, encode_boundary_entry(*directory.boundary));
    add(boundary_values_section, encode_boundary_values_table(directory.fields));
    return out;
}

Result<PackedDirectory> decode_directory(std::span<const std::byte> bytes, std::uint64_t file_bytes) {
    PackedDirectory d;
    ByteCursor in(bytes);
    bool grid = false, chunks = false;
    std::optional<ByteCursor> boundary_values;
    while (in.left() > 0) {
        const auto name_bytes = in.part(grid_section.size());
        const std::string_view name(reinterpret_cast<const char*>(name_bytes.data()), name_bytes.size());
        const ByteCursor content(in.part(in.number<std::uint64_t>()));
        if (!in.ok()) return broken_directory("a section ends behind it");
        Result<void> decoded;
        if (name == grid_section && !grid) {
            decoded = decode_grid(content, d);
            grid = true;
        } else if (name == chunk_section && !chunks) {
            decoded = decode_chunks(content, d);
            chunks = true;
        } else if (name == frame_section) {
            decoded = decode_frame(content, d);
        } else if (name == points_section) {
            decoded = chunks ? decode_points(content, d.chunks.size(), d)
                             : broken_directory("moved points stand before the chunks");
        } else if (name == field_section || name == moved_field_section) {
            decoded = chunks ? decode_field(content, d.chunks.size(), d)
                             : broken_directory("a field stands before the chunks");
        } else if (name == cell_field_section) {
            decoded = grid ? decode_cell_field(content, file_bytes, d)
                           : broken_directory("a cell field stands before the grid");
        } else if (name == boundary_section) {
            decoded = decode_boundary(content, d);
        } else if (name == boundary_values_section) {
            boundary_values = content;
        } // else of a newer minor version
        if (!decoded) return decoded.error();
    }
    if (!grid || !chunks) return broken_directory("the section of the grid or of the chunks is missing");
    if (auto ok = check_fields(d); !ok) return ok.error();
    if (auto ok = check_cell_fields(d); !ok) return ok.error();
    if (auto ok = check_moved_points(d); !ok) return ok.error();
    if (d.boundary.has_value() != boundary_values.has_value())
        return broken_directory("the section of the boundary or that of its values is missing");
    if (boundary_values)
        if (auto ok = decode_boundary_values(*boundary_values, d); !ok) return ok.error();
    if (auto ok = check_places(d, file_bytes); !ok) return ok.error();
    return d;
}

namespace {

template <class T>
void put_number(std::span<std::byte> bytes, std::size_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

template <class T>
T number_at(std::span<const std::byte> bytes, std::size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

constexpr std::size_t identity_bytes = 20; ///< that the header's own checksum covers

/// Nothing where the slot is empty or broken.
std::optional<DirectorySlot> decode_slot(std::span<const std::byte> bytes) {
    const auto content = bytes.first(packed_slot_bytes - 4);
    if (number_at<std::uint32_t>(bytes, packed_slot_bytes - 4) != crc32c(content)) return std::nullopt;
    DirectorySlot slot{number_at<std::uint64_t>(bytes, 0), number_at<std::uint64_t>(bytes, 8),
                       number_at<std::uint64_t>(bytes, 16), number_at<std::uint64_t>(bytes, 24), 0};
    slot.checksum = number_at<std::uint32_t>(bytes, 32);
    if (slot.count == 0) return std::nullopt;
    return slot;
}

} // namespace

std::array<std::byte, packed_header_bytes> encode_packed_header() {
    std::array<std::byte, packed_header_bytes> bytes{};
    std::memcpy(bytes.data(), packed_magic.data(), packed_magic.size());
    put_number(bytes, 8, packed_major);
    put_number(bytes, packed_minor_at, packed_minor);
    put_number(bytes, 12, packed_byte_order);
    put_number(bytes, 16, static_cast<std::uint32_t>(packed_header_bytes));
    put_number(bytes, identity_bytes, crc32c(std::span(bytes).first(identity_bytes)));
    return bytes;
}

std::array<std::byte, packed_slot_bytes> encode_slot(const DirectorySlot& slot) {
    std::array<std::byte, packed_slot_bytes> bytes{};
    put_number(bytes, 0, slot.count);
    put_number(bytes, 8, slot.offset);
    put_number(bytes, 16, slot.bytes);
    put_number(bytes, 24, slot.file_bytes);
    put_number(bytes, 32, slot.checksum);
    put_number(bytes, 36, crc32c(std::span(bytes).first(packed_slot_bytes - 4)));
    return bytes;
}

Result<DirectorySlot> decode_packed_header(std::span<const std::byte> bytes, std::uint64_t file_bytes,
                                           std::size_t* place) {
    if (bytes.size() < packed_header_bytes)
        return invalid_data(fmt::format("a packed file has at least {} bytes, but this one has {}", packed_header_bytes,
                                        bytes.size()));
    if (std::memcmp(bytes.data(), packed_magic.data(), packed_magic.size()) != 0)
        return invalid_data("it does not begin as packed files do");
    const auto major = number_at<std::uint16_t>(bytes, 8);
    if (number_at<std::uint32_t>(bytes, 12) == std::uint32_t{0x04030201})
        return invalid_data("it was written on a big-endian machine, which is not read");
    if (number_at<std::uint32_t>(bytes, identity_bytes) != crc32c(bytes.first(identity_bytes)))
        return invalid_data("its header is broken: the checksum differs");
    if (major != packed_major)
        return invalid_data(fmt::format("it has version {}.{} of the format, but this isotet reads {}.x", major,
                                        number_at<std::uint16_t>(bytes, packed_minor_at), packed_major));
    std::optional<DirectorySlot> newest;
    for (std::size_t i = 0; i < packed_slots.size(); ++i) {
        const auto slot = decode_slot(bytes.subspan(packed_slots[i], packed_slot_bytes));
        if (!slot || (newest && slot->count <= newest->count)) continue;
        newest = slot;
        if (place) *place = i;
    }
    if (!newest) return invalid_data("its header is broken: no slot tells where the directory is");
    if (newest->file_bytes > file_bytes)
        return invalid_data(
            fmt::format("it was cut short: {} bytes are there, but it had {}", file_bytes, newest->file_bytes));
    if (!lies_within(newest->offset, newest->bytes, newest->file_bytes))
        return invalid_data(fmt::format("its directory of {} bytes at {} lies outside of the file of {}", newest->bytes,
                                        newest->offset, newest->file_bytes));
    return newest.value();
}

} // namespace isotet::io
