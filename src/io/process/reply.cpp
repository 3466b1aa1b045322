// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Replies in a memory file:
//
//   Header | array | array | ... | description
//
// Arrays start at multiples of 64 bytes. The description (plain bytes: sentences, names, and for each array its type,
// place and size) comes last, and the header after everything else, so an unfinished reply has no valid header.
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <span>
#include <unistd.h>

#include <fmt/core.h>

#include "base/system/block.hpp"
#include "base/system/fresh_memory.hpp"
#include "base/parallel.hpp"
#include "io/process/messages.hpp"
#include "base/system/sealed_mapping.hpp"
#include "io/process/wire.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::uint64_t magic = 0x3930795f74657469; // "itet_y09", and the byte order with it
constexpr std::uint64_t alignment = 64;

struct Header {
    std::uint64_t magic = 0;
    std::uint64_t description_begin = 0;
    std::uint64_t description_size = 0;
};

/// Appends to the memory file; remembers the first failure.
class MemoryFile {
public:
    explicit MemoryFile(int descriptor) : descriptor_(descriptor), end_(alignment) {}

    std::uint64_t append(const void* data, std::uint64_t size) {
        const std::uint64_t begin = (end_ + alignment - 1) / alignment * alignment;
        put(data, size, begin);
        end_ = begin + size;
        return begin;
    }
    void put(const void* data, std::uint64_t size, std::uint64_t at) {
        const char* bytes = static_cast<const char*>(data);
        while (size > 0 && error_ == 0) {
            const std::uint64_t part = std::min<std::uint64_t>(size, 1 << 26);
            if (!has_room(part)) {
                error_ = ENOMEM;
                return;
            }
            const ssize_t written = ::pwrite(descriptor_, bytes, part, static_cast<off_t>(at));
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) {
                error_ = written < 0 ? errno : ENOSPC;
                return;
            }
            bytes += written;
            size -= static_cast<std::uint64_t>(written);
            at += static_cast<std::uint64_t>(written);
        }
    }
    int error() const noexcept { return error_; }

private:
    /// The file is memory of the control group, too.
    static bool has_room(std::uint64_t bytes) {
        core::FreshMemory& fresh = core::fresh_memory();
        return fresh.take(bytes) || (core::drop_kept_blocks() > 0 && fresh.take(bytes));
    }

    int descriptor_;
    std::uint64_t end_;
    int error_ = 0;
};

/// Writes what a reply holds: arrays into the file, everything else into the description.
class Describer {
public:
    Describer(Encoder& out, MemoryFile& file) : out_(out), file_(file) {}

    void array(Array& values) {
        out_.number(values.type());
        out_.number<std::uint64_t>(values.tuples());
        out_.number<std::uint64_t>(values.components());
        out_.number<std::uint64_t>(values.empty() ? 0 : file_.append(values.data(), values.bytes()));
        values = Array(); // lets go of the memory
    }
    void fields(std::vector<Field>& fields) {
        out_.list(fields, [&](Field& field) {
            out_.text(field.name);
            array(field.values);
        });
    }
    void describe(const Error& error) {
        out_.number(error.code);
        out_.text(error.message);
    }
    void describe(const FileInfo& info) {
        // A member that is not sent is an error here: this counts them.
        [[maybe_unused]] const auto& [format, info_cells, field_infos, times, files, blocks, regions, left_out, least] =
            info;
        out_.text(info.format);
        out_.number(info.cells);
        out_.list(info.fields, [&](const FieldInfo& field) {
            out_.text(field.name);
            out_.number(field.association);
            out_.number(field.type);
            out_.number<std::uint64_t>(field.components);
        });
        out_.list(info.times, [&](double time) { out_.number(time); });
        out_.list(info.files, [&](const std::string& file) { out_.text(file); });
        out_.list(info.blocks, [&](const BlockInfo& block) {
            out_.number(block.number);
            out_.text(block.name);
            out_.text(block.kind);
            out_.number(block.cells);
        });
        out_.list(info.regions, [&](const RegionName& region) {
            out_.text(region.field);
            out_.number(region.number);
            out_.text(region.name);
        });
        out_.list(info.left_out, [&](const LeftOut& item) {
            out_.text(item.what);
            out_.text(item.name);
            out_.text(item.reason);
        });
        [[maybe_unused]] const auto& [points, cells, corners, coordinates, all_cells] = least;
        for (const std::uint64_t count : {points, cells, corners}) out_.number(count);
        out_.number(coordinates);
        out_.number<std::uint8_t>(all_cells);
    }
    void describe(ReadResult& result) {
        [[maybe_unused]] const auto& [whole, info, step, cells_in_file, bounds, notes, cell_numbers, chosen_cells,
                                      field, share_isovalues, digests] = result;
        [[maybe_unused]] const auto& [points, cells, point_fields, cell_fields, point_numbers, patches] = result.grid;
        describe(result.info);
        out_.number<std::uint64_t>(result.step);
        out_.number<std::uint8_t>(result.cells_in_file.has_value());
        out_.number<std::uint64_t>(result.cells_in_file.value_or(0));
        out_.number<std::uint8_t>(result.bounds.has_value());
        for (const double bound : result.bounds.value_or(std::array<double, 6>{})) out_.number(bound);
        out_.number<std::uint8_t>(result.chosen_cells.has_value());
        out_.number<std::uint64_t>(result.chosen_cells.value_or(0));
        out_.list(result.notes, [&](const std::string& note) { out_.text(note); });
        Grid& grid = result.grid;
        array(grid.points);
        describe(grid.cells);
        fields(grid.point_fields);
        fields(grid.cell_fields);
        array(grid.point_numbers);
        array(grid.patches.points);
        array(grid.patches.offsets);
        array(grid.patches.numbers);
        out_.list(grid.patches.names, [&](const PatchName& patch) {
            out_.number(patch.number);
            out_.text(patch.name);
        });
        array(result.cell_numbers);
        out_.number<std::uint8_t>(result.field.has_value());
        if (result.field) { // the rest is known
            out_.text(result.field->name);
            array(result.field->values);
            const FillValues& fill = result.field->cell_fill;
            out_.number<std::uint64_t>(fill.values);
            out_.number(fill.others.lower);
            out_.number(fill.others.upper);
            out_.list(fill.numbers, [&](const FillValues::Number& one) {
                out_.number(one.value);
                out_.number(one.count);
            });
        }
        out_.list(result.share_isovalues, [&](double isovalue) { out_.number(isovalue); });
        fields(result.digests);
    }
    void describe(Cells& cells) {
        [[maybe_unused]] const auto& [connectivity, offsets, types, uniform_type, faces, face_offsets] = cells;
        array(cells.connectivity);
        array(cells.offsets);
        array(cells.types);
        out_.number(cells.uniform_type);
        array(cells.faces);
        array(cells.face_offsets);
    }
    void describe(GridReply& reply) {
        describe(reply.read);
        StreamedBoundary& boundary = reply.boundary;
        out_.number<std::uint8_t>(boundary.is_there);
        out_.number<std::uint8_t>(reply.is_same);
        for (const std::uint64_t print : boundary.print) out_.number(print);
        array(boundary.surface.positions); // a boundary has nothing else
        array(boundary.surface.triangles);
        array(boundary.surface.edge_ends);
        describe(boundary.cells.cells);
        fields(boundary.cells.cell_fields);
    }
    void describe(const GridReport& report) {
        [[maybe_unused]] const auto& [points, cells, by_type, left_out, tets, collapsed, negative, inverted, flat,
                                      unused, lower, upper, repeated, duplicates, boundary, quads] = report;
        for (const std::size_t count : {points, cells, left_out, tets, collapsed, negative, inverted, flat, unused})
            out_.number<std::uint64_t>(count);
        out_.list(by_type, [&](const auto& of_type) {
            out_.number<std::uint8_t>(of_type.first);
            out_.number<std::uint64_t>(of_type.second);
        });
        for (const double bound : lower) out_.number(bound);
        for (const double bound : upper) out_.number(bound);
    }
    void describe(SurveyedGrid& surveyed) {
        describe(surveyed.read);
        out_.number<std::uint8_t>(surveyed.report.has_value());
        if (surveyed.report) describe(*surveyed.report);
        Array numbers = Array::own(std::move(surveyed.sampled));
        array(numbers);
    }

private:
    Encoder& out_;
    MemoryFile& file_;
};

/// Reads what Describer wrote, with every place checked against the size of the mapping.
class Undescriber {
public:
    Undescriber(Decoder& in, const std::byte* mapping, std::uint64_t arrays_end, std::shared_ptr<const void> owner)
        : in_(in), mapping_(mapping), arrays_end_(arrays_end), owner_(std::move(owner)) {}

    Array array() {
        const auto type = in_.enumerator(ScalarType::float64);
        const auto tuples = in_.number<std::uint64_t>();
        const auto components = in_.number<std::uint64_t>();
        const auto begin = in_.number<std::uint64_t>();
        if (components == 0) return in_.fail(), Array();
        if (tuples == 0) return Array(type, nullptr, 0, components, nullptr);
        const std::uint64_t most = arrays_end_ / size_of(type);
        if (components > most || tuples > most / components || begin % alignment != 0 || begin < alignment ||
            begin > arrays_end_ || tuples * components * size_of(type) > arrays_end_ - begin)
            return in_.fail(), Array();
        return Array(type, mapping_ + begin, tuples, components, owner_);
    }
    std::vector<Field> fields() {
        std::vector<Field> result;
        in_.list([&] {
            Field& field = result.emplace_back();
            field.name = in_.text();
            field.values = array();
        });
        return result;
    }
    Error error() {
        const auto code = in_.enumerator(ErrorCode::internal);
        return {code, in_.text()};
    }
    FileInfo info() {
        FileInfo result;
        result.format = in_.text();
        result.cells = in_.number<std::uint64_t>();
        in_.list([&] {
            FieldInfo& field = result.fields.emplace_back();
            field.name = in_.text();
            field.association = in_.enumerator(Association::cell);
            field.type = in_.enumerator(ScalarType::float64);
            field.components = in_.number<std::uint64_t>();
        });
        in_.list([&] { result.times.push_back(in_.number<double>()); });
        in_.list([&] { result.files.push_back(in_.text()); });
        in_.list([&] {
            BlockInfo& block = result.blocks.emplace_back();
            block.number = in_.number<std::int64_t>();
            block.name = in_.text();
            block.kind = in_.text();
            block.cells = in_.number<std::uint64_t>();
        });
        in_.list([&] {
            RegionName& region = result.regions.emplace_back();
            region.field = in_.text();
            region.number = in_.number<decltype(region.number)>();
            region.name = in_.text();
        });
        in_.list([&] {
            LeftOut& item = result.left_out.emplace_back();
            item.what = in_.text();
            item.name = in_.text();
            item.reason = in_.text();
        });
        LeastCounts& least = result.least;
        for (std::uint64_t* const count : {&least.points, &least.cells, &least.corners})
            *count = in_.number<std::uint64_t>();
        least.coordinates = in_.enumerator(ScalarType::float64);
        least.all_cells = in_.number<std::uint8_t>() != 0;
        return result;
    }
    ReadResult result() {
        ReadResult result;
        result.info = info();
        result.step = in_.number<std::uint64_t>();
        const bool only_active = in_.number<std::uint8_t>() != 0;
        const auto cells_in_file = in_.number<std::uint64_t>();
        if (only_active) result.cells_in_file = cells_in_file;
        const bool has_bounds = in_.number<std::uint8_t>() != 0;
        std::array<double, 6> bounds;
        for (double& bound : bounds) bound = in_.number<double>();
        if (has_bounds) result.bounds = bounds;
        const bool has_chosen = in_.number<std::uint8_t>() != 0;
        const auto chosen = in_.number<std::uint64_t>();
        if (has_chosen) result.chosen_cells = chosen;
        in_.list([&] { result.notes.push_back(in_.text()); });
        Grid& grid = result.grid;
        grid.points = array();
        grid.cells = cells();
        grid.point_fields = fields();
        grid.cell_fields = fields();
        grid.point_numbers = array();
        grid.patches.points = array();
        grid.patches.offsets = array();
        grid.patches.numbers = array();
        in_.list([&] {
            PatchName& patch = grid.patches.names.emplace_back();
            patch.number = in_.number<decltype(patch.number)>();
            patch.name = in_.text();
        });
        result.cell_numbers = array();
        if (in_.number<std::uint8_t>() != 0) {
            std::string name = in_.text();
            result.field = PointField{std::move(name), array(), true, {}};
            FillValues& fill = result.field->cell_fill;
            fill.values = in_.number<std::uint64_t>();
            fill.others.lower = in_.number<double>();
            fill.others.upper = in_.number<double>();
            in_.list([&] {
                FillValues::Number& one = fill.numbers.emplace_back();
                one.value = in_.number<double>();
                one.count = in_.number<std::uint64_t>();
            });
            if (result.field->values.tuples() != grid.points.tuples() || result.field->values.components() != 1)
                in_.fail();
        }
        in_.list([&] { result.share_isovalues.push_back(in_.number<double>()); });
        result.digests = fields();
        return result;
    }
    Cells cells() {
        Cells cells;
        cells.connectivity = array();
        cells.offsets = array();
        cells.types = array();
        cells.uniform_type = in_.number<CellType>();
        cells.faces = array();
        cells.face_offsets = array();
        return cells;
    }
    GridReply grid_reply() {
        GridReply reply;
        reply.read = result();
        StreamedBoundary& boundary = reply.boundary;
        boundary.is_there = in_.number<std::uint8_t>() != 0;
        reply.is_same = in_.number<std::uint8_t>() != 0;
        for (std::uint64_t& print : boundary.print) print = in_.number<std::uint64_t>();
        boundary.surface.positions = array();
        boundary.surface.triangles = array();
        boundary.surface.edge_ends = array();
        boundary.cells.cells = cells();
        boundary.cells.cell_fields = fields();
        boundary.cells.points = reply.read.grid.points;
        if (!is_sound(boundary.surface, reply.read.grid.points.tuples())) in_.fail();
        return reply;
    }
    SurveyedGrid surveyed() {
        SurveyedGrid surveyed;
        surveyed.read = result();
        if (in_.number<std::uint8_t>() != 0) surveyed.report = report();
        const Array numbers = array();
        if (!numbers.empty() && numbers.type() != ScalarType::uint64) return in_.fail(), SurveyedGrid();
        if (!numbers.empty()) {
            const auto sampled = numbers.as<std::uint64_t>();
            surveyed.sampled.assign(sampled.begin(), sampled.end());
        }
        if (surveyed.report && !is_sample(surveyed)) in_.fail();
        return surveyed;
    }

private:
    GridReport report() {
        GridReport report;
        for (std::size_t* const count :
             {&report.points, &report.cells, &report.cells_left_out, &report.tets, &report.collapsed_tets,
              &report.negative_tets, &report.inverted_tets, &report.flat_tets, &report.unused_points})
            *count = in_.number<std::uint64_t>();
        in_.list([&] {
            const auto type = in_.number<std::uint8_t>();
            report.cells_by_type[type] = in_.number<std::uint64_t>();
        });
        for (double& bound : report.lower) bound = in_.number<double>();
        for (double& bound : report.upper) bound = in_.number<double>();
        return report;
    }
    /// Whether it is none, or one with vertices that are there, at points that are.
    static bool is_sound(const Surface& surface, std::uint64_t points) {
        const Array &positions = surface.positions, &triangles = surface.triangles, &ends = surface.edge_ends;
        if (positions.empty() && triangles.empty() && ends.empty()) return true;
        if (!is_floating(positions.type()) || positions.components() != 3 || triangles.components() != 3) return false;
        if (ends.type() != ScalarType::int64 || ends.components() != 2 || ends.tuples() != positions.tuples())
            return false;
        if (triangles.type() != ScalarType::uint32 && triangles.type() != ScalarType::uint64) return false;
        const auto are_below = [](const Array& numbers, std::uint64_t count) {
            return numbers.visit([&](auto values) {
                std::atomic<bool> all = true;
                core::parallel_ranges(values.size(), std::size_t{1} << 16, [&](std::size_t begin, std::size_t end) {
                    for (std::size_t i = begin; i < end; ++i)
                        if (static_cast<std::uint64_t>(values[i]) >= count) all = false;
                });
                return all.load();
            });
        };
        return are_below(triangles, positions.tuples()) && are_below(ends, points);
    }
    /// Whether the numbers are of cells of the file, one for each cell that is there, and cell fields of all cells.
    static bool is_sample(const SurveyedGrid& surveyed) {
        const std::uint64_t cells = surveyed.read.cells_in_file.value_or(0);
        return surveyed.sampled.size() == surveyed.read.grid.cells.count() &&
               std::ranges::all_of(surveyed.sampled, [&](std::uint64_t number) { return number < cells; }) &&
               std::ranges::all_of(surveyed.read.grid.cell_fields,
                                   [&](const Field& field) { return field.values.tuples() == cells; });
    }

    Decoder& in_;
    const std::byte* mapping_;
    std::uint64_t arrays_end_;
    std::shared_ptr<const void> owner_;
};

} // namespace

Result<void> write_reply(int descriptor, Reply reply) {
    MemoryFile file(descriptor);
    Encoder out;
    Describer describer(out, file);
    out.number<std::uint8_t>(static_cast<std::uint8_t>(reply.index()));
    std::visit([&](auto& content) { describer.describe(content); }, reply);
    Header header{magic, 0, out.bytes().size()};
    header.description_begin = file.append(out.bytes().data(), out.bytes().size());
    file.put(&header, sizeof header, 0);
    if (file.error() != 0)
        return Error{file.error() == EFBIG ? ErrorCode::system : ErrorCode::out_of_memory,
                     fmt::format("the reader process could not hand the grid over: {}", std::strerror(file.error()))};
    return {};
}

Result<Reply> map_reply(int descriptor) {
    core::fresh_memory().forget();
    const Error incomplete{ErrorCode::internal, "the reader process ended without a complete reply"};
    const auto mapping = core::map_sealed(descriptor);
    if (!mapping) return mapping.error();
    const std::span<const std::byte> bytes = mapping->bytes;
    if (bytes.size() < alignment) return incomplete;

    Header header;
    std::memcpy(&header, bytes.data(), sizeof header);
    if (header.magic != magic || header.description_begin < alignment || header.description_begin > bytes.size() ||
        header.description_size > bytes.size() - header.description_begin)
        return incomplete;
    Decoder in({reinterpret_cast<const char*>(bytes.data()) + header.description_begin, header.description_size});
    Undescriber undescriber(in, bytes.data(), header.description_begin, mapping->owner);
    Reply reply;
    switch (in.number<std::uint8_t>()) {
    case 0: reply = undescriber.error(); break;
    case 1: reply = undescriber.info(); break;
    case 2: reply = undescriber.grid_reply(); break;
    case 3: reply = undescriber.surveyed(); break;
    default: in.fail();
    }
    if (!in.finished()) return incomplete;
    return reply;
}

} // namespace isotet::io::confined
