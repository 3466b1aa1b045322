// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Requests as bytes and back.
#include <array>
#include <memory>
#include <variant>

#include <isotet/active_cells.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/slice.hpp>

#include "io/process/messages.hpp"
#include "io/process/wire.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::uint32_t request_version = 0x6973000e;

using Names = std::optional<std::vector<std::string>>;

void encode_names(Encoder& out, const Names& names) {
    out.number<std::uint8_t>(names.has_value());
    if (names) out.list(*names, [&](const std::string& name) { out.text(name); });
}

Names decode_names(Decoder& in) {
    if (in.number<std::uint8_t>() == 0) return std::nullopt;
    std::vector<std::string> names;
    in.list([&] { names.push_back(in.text()); });
    return names;
}

void encode_vector(Encoder& out, const std::array<double, 3>& vector) {
    for (const double component : vector) out.number(component);
}

std::array<double, 3> decode_vector(Decoder& in) {
    std::array<double, 3> vector{};
    for (double& component : vector) component = in.number<double>();
    return vector;
}

/// The kind of a shape on the wire.
enum class ShapeKind : std::uint8_t { none, plane, sphere, cylinder };

void encode_shape(Encoder& out, const std::optional<SliceShape>& shape) {
    out.number(shape ? static_cast<ShapeKind>(shape->index() + 1) : ShapeKind::none);
    if (!shape) return;
    if (const auto* plane = std::get_if<Plane>(&*shape)) {
        encode_vector(out, plane->normal);
    } else if (const auto* sphere = std::get_if<Sphere>(&*shape)) {
        encode_vector(out, sphere->centre);
    } else if (const auto* cylinder = std::get_if<Cylinder>(&*shape)) {
        encode_vector(out, cylinder->axis);
        encode_vector(out, cylinder->point);
    }
    out.number(slice_isovalue(*shape));
}

std::optional<SliceShape> decode_shape(Decoder& in) {
    const auto kind = in.enumerator(ShapeKind::cylinder);
    if (kind == ShapeKind::none) return std::nullopt;
    const std::array<double, 3> first = decode_vector(in);
    if (kind == ShapeKind::plane) return Plane{first, in.number<double>()};
    if (kind == ShapeKind::sphere) return Sphere{first, in.number<double>()};
    const std::array<double, 3> point = decode_vector(in);
    return Cylinder{first, point, in.number<double>()};
}

/// Of what is known of the boundary all but the surface.
void encode_boundary(Encoder& out, const std::shared_ptr<StreamedBoundary>& boundary) {
    out.number<std::uint8_t>(boundary != nullptr);
    if (!boundary) return;
    out.number<std::uint8_t>(boundary->of_steps);
    out.number<std::uint8_t>(boundary->is_there && !boundary->wants_cells); // the process does not know which they are
    out.number<std::uint8_t>(boundary->wants_cells);
    for (const std::uint64_t print : boundary->print) out.number(print);
}

std::shared_ptr<StreamedBoundary> decode_boundary(Decoder& in) {
    if (in.number<std::uint8_t>() == 0) return nullptr;
    auto boundary = std::make_shared<StreamedBoundary>();
    boundary->of_steps = in.number<std::uint8_t>() != 0;
    boundary->is_there = in.number<std::uint8_t>() != 0;
    boundary->wants_cells = in.number<std::uint8_t>() != 0;
    for (std::uint64_t& print : boundary->print) print = in.number<std::uint64_t>();
    return boundary;
}

void encode_choice(Encoder& out, const RangeLevels* levels) {
    out.number<std::uint64_t>(levels ? levels->count : 0);
    out.number(levels ? levels->rounding : LevelRounding::none);
    out.number<std::uint8_t>(levels && levels->whole_range);
}

void decode_choice(Decoder& in, ReadActiveCells& active) {
    RangeLevels levels;
    levels.count = in.number<std::uint64_t>();
    levels.rounding = in.enumerator(LevelRounding::short_decimals);
    levels.whole_range = in.number<std::uint8_t>() != 0;
    if (levels.count > ActiveCellFilter::max_isovalues) return in.fail();
    if (levels.count > 0) active.choose = levels;
}

/// Of the options of extraction those that tell which cells are active.
void encode_active(Encoder& out, const std::optional<ReadActiveCells>& active) {
    const RangeLevels* const levels = active ? active->choose.target<RangeLevels>() : nullptr;
    const bool can_be_told =
        active && (!active->choose || levels) && active->options.extract.cell_fields.empty() && !active->options.frame;
    out.number<std::uint8_t>(can_be_told);
    if (!can_be_told) return;
    out.text(active->field);
    out.list(active->isovalues, [&](double isovalue) { out.number(isovalue); });
    out.number<std::uint8_t>(active->options.extract.ties == Ties::keep);
    out.number<std::uint8_t>(active->options.extract.source_cells);
    out.number<std::uint8_t>(active->options.precision == Precision::float64);
    out.number<std::uint8_t>(active->options.extract.normals == Normals::gradient);
    out.number<std::uint8_t>(active->bounds);
    out.number<std::uint8_t>(active->averages);
    out.number<std::uint8_t>(active->digests);
    encode_shape(out, active->shape);
    encode_boundary(out, active->boundary);
    encode_choice(out, levels);
    out.list(active->shares, [&](const IsovalueShare& share) {
        out.number(share.of);
        out.number(share.percent);
    });
    out.list(active->conditions, [&](const CellCondition& condition) {
        out.text(condition.field);
        out.list(condition.ranges, [&](const std::array<double, 2>& range) {
            for (const double end : range) out.number(end);
        });
        out.number<std::uint8_t>(condition.others);
    });
}

std::optional<ReadActiveCells> decode_active(Decoder& in) {
    if (in.number<std::uint8_t>() == 0) return std::nullopt;
    ReadActiveCells active;
    active.field = in.text();
    in.list([&] { active.isovalues.push_back(in.number<double>()); });
    if (in.number<std::uint8_t>() != 0) active.options.extract.ties = Ties::keep;
    active.options.extract.source_cells = in.number<std::uint8_t>() != 0;
    if (in.number<std::uint8_t>() != 0) active.options.precision = Precision::float64;
    if (in.number<std::uint8_t>() != 0) active.options.extract.normals = Normals::gradient;
    active.bounds = in.number<std::uint8_t>() != 0;
    active.averages = in.number<std::uint8_t>() != 0;
    active.digests = in.number<std::uint8_t>() != 0;
    active.shape = decode_shape(in);
    active.boundary = decode_boundary(in);
    decode_choice(in, active);
    in.list([&] {
        IsovalueShare& share = active.shares.emplace_back();
        share.of = in.enumerator(IsovalueShare::Of::points);
        share.percent = in.number<double>();
    });
    in.list([&] {
        CellCondition& condition = active.conditions.emplace_back();
        condition.field = in.text();
        in.list([&] {
            for (double& end : condition.ranges.emplace_back()) end = in.number<double>();
        });
        condition.others = in.number<std::uint8_t>() != 0;
    });
    return active;
}

} // namespace

std::string encode(const Request& request) {
    Encoder out;
    out.number(request_version);
    out.number(request.task);
    out.text(request.format);
    out.text(request.path);
    const ReadOptions& options = request.options;
    encode_names(out, options.point_fields);
    encode_names(out, options.cell_fields);
    out.number<std::uint8_t>(options.step.has_value());
    out.number<std::uint64_t>(options.step.value_or(0));
    out.number<std::uint8_t>(options.merge_pieces_by_coordinates);
    out.number<std::uint8_t>(options.allow_outside);
    out.number<std::uint8_t>(options.patches);
    out.text(options.displace);
    out.number(options.memory_limit);
    out.list(options.blocks, [&](const std::string& block) { out.text(block); });
    encode_active(out, options.active_cells);
    out.list(request.readable, [&](const std::string& place) { out.text(place); });
    return out.bytes();
}

Result<Request> decode_request(std::string_view bytes) {
    Decoder in(bytes);
    const bool known = in.number<std::uint32_t>() == request_version;
    Request request;
    request.task = in.enumerator(Task::survey);
    request.format = in.text();
    request.path = in.text();
    ReadOptions& options = request.options;
    options.point_fields = decode_names(in);
    options.cell_fields = decode_names(in);
    const bool has_step = in.number<std::uint8_t>() != 0;
    const auto step = in.number<std::uint64_t>();
    if (has_step) options.step = step;
    options.merge_pieces_by_coordinates = in.number<std::uint8_t>() != 0;
    options.allow_outside = in.number<std::uint8_t>() != 0;
    options.patches = in.number<std::uint8_t>() != 0;
    options.displace = in.text();
    options.memory_limit = in.number<std::uint64_t>();
    in.list([&] { options.blocks.push_back(in.text()); });
    options.active_cells = decode_active(in);
    in.list([&] { request.readable.push_back(in.text()); });
    if (!known || !in.finished())
        return Error{ErrorCode::system, "the program isotet-reader that was found is of another version than isotet: "
                                        "install both from one build"};
    return request;
}

} // namespace isotet::io::confined
