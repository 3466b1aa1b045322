// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "bench/isotet_contestant.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <stdexcept>

#include "bench/arrays.hpp"
#include "bench/copy_bandwidth.hpp"
#include "bench/grid_arrays.hpp"
#include "bench/must_move.hpp"
#include "numbers/level.hpp"

namespace isotet::bench {

namespace {

Array to_array(Reals reals, std::size_t components) {
    return std::visit([&](auto& values) { return Array::own(std::move(values), components); }, reals);
}

Array negated(const Array& array) {
    const auto negate = [](auto values) {
        std::vector<typename decltype(values)::value_type> out(values.size());
        std::transform(values.begin(), values.end(), out.begin(), std::negate<>());
        return Array::own(std::move(out));
    };
    return array.type() == ScalarType::float64 ? negate(array.as<double>()) : negate(array.as<float>());
}

Reply describe(const Extraction& extraction, double seconds) {
    Reply reply;
    reply.number("seconds", seconds)
        .count("vertices", extraction.surface.vertex_count())
        .count("triangles", extraction.surface.triangle_count())
        .count("tied_points", extraction.report.tied_points)
        .count("transient_bytes", extraction.report.transient_bytes);
    return reply;
}

/// Less than the processor can do, for as long as this lives.
class LowerLevel {
public:
    explicit LowerLevel(core::Level level) { core::force_level(level); }
    ~LowerLevel() { core::force_level({}); }
    LowerLevel(const LowerLevel&) = delete;
    LowerLevel& operator=(const LowerLevel&) = delete;
};

[[noreturn]] void refuse(const std::string& what, const std::string& name) {
    throw std::invalid_argument("no such " + what + ": '" + name + "'");
}

} // namespace

Reply IsotetContestant::answer(const Words& words) {
    const std::string& command = words[0];
    const auto rest = [&](std::size_t first) {
        return first < words.size() ? Words(words.begin() + static_cast<std::ptrdiff_t>(first), words.end()) : Words();
    };
    if (command == "open") return open(word(words, 1), whole_number(words, 2));
    if (command == "pack") return pack_as(word(words, 1), rest(2));
    if (command == "extract") return extract_from(word(words, 1), number(words, 2), rest(3));
    if (command == "once") return extract_direct(number(words, 1));
    if (command == "set_field") return set_field(word(words, 1));
    if (command == "copy") return Reply().number("bytes_per_second", copy_bandwidth(whole_number(words, 1)));
    if (command == "arrays")
        return write_grid_arrays(word(words, 1), word(words, 2), word(words, 3), word(words, 4),
                                 whole_number(words, 5));
    refuse("command", command);
}

Reply IsotetContestant::open(const std::string& folder, int threads) {
    packed_.clear();
    Arrays arrays = read_arrays(folder);
    threads_ = threads;
    const std::uint64_t cells = arrays.cell_count();
    grid_ = {};
    grid_.points = to_array(std::move(arrays.points), 3);
    grid_.cells.connectivity = Array::own(std::move(arrays.corners));
    if (arrays.uniform()) grid_.cells.uniform_type = static_cast<CellType>(arrays.types[0]);
    else {
        grid_.cells.offsets = Array::own(std::move(arrays.offsets));
        grid_.cells.types = Array::own(std::move(arrays.types));
    }
    field_.name = "field";
    field_.values = to_array(std::move(arrays.field), 1);
    negative_.name = "negative";
    negative_.values = negated(field_.values);
    return Reply()
        .count("points", grid_.points.tuples())
        .count("cells", cells)
        .count("input_bytes", input_bytes())
        .text("level", std::string(core::name_of(core::best_level())));
}

std::uint64_t IsotetContestant::input_bytes() const {
    return grid_.points.bytes() + grid_.cells.connectivity.bytes() + grid_.cells.offsets.bytes() +
           grid_.cells.types.bytes() + field_.values.bytes();
}

Reply IsotetContestant::pack_as(const std::string& name, const Words& words) {
    PackOptions options;
    for (const std::string& option : words) {
        if (option == "gradients") options.gradients = true;
        else if (option == "source_cells") options.source_cells = true;
        else refuse("option of packing", option);
    }
    packed_.erase(name);
    const Stopwatch watch;
    PackedGrid made = pack(grid_, field_, options, {.threads = threads_}).value();
    const double seconds = watch.seconds();

    const PackReport& report = packed_.emplace(name, std::move(made)).first->second.report();
    const std::uint64_t kept = report.bytes + report.source_bytes + report.gradient_bytes;
    return Reply()
        .number("seconds", seconds)
        .count("must_move", input_bytes() + kept)
        .count("cells", report.tets + report.pyramids + report.wedges + report.hexahedra)
        .count("points", report.points)
        .count("clusters", report.clusters)
        .count("repeated_tets", report.repeated_tets)
        .count("bytes", report.bytes)
        .count("source_bytes", report.source_bytes)
        .count("gradient_bytes", report.gradient_bytes);
}

PackedGrid& IsotetContestant::packed(const std::string& name) {
    const auto found = packed_.find(name);
    if (found == packed_.end()) refuse("packed grid", name);
    return found->second;
}

Reply IsotetContestant::extract_from(const std::string& name, double isovalue, const Words& attributes) {
    const PackedGrid& from = packed(name);
    ExtractOptions options;
    std::optional<LowerLevel> lower;
    for (const std::string& attribute : attributes) {
        if (attribute == "gradient_normals") options.normals = Normals::gradient;
        else if (attribute == "face_normals") options.normals = Normals::face;
        else if (attribute == "point_field") options.point_fields = {{"negative", negative_.values}};
        else if (attribute == "source_cells") options.source_cells = true;
        else if (attribute == "edge_ends") options.edge_ends = true;
        else if (attribute == "avx2" && core::best_level() > core::Level::avx2) lower.emplace(core::Level::avx2);
        else if (attribute == "portable" && core::best_level() > core::Level::portable)
            lower.emplace(core::Level::portable);
        else refuse("attribute", attribute);
    }
    const Stopwatch watch;
    const Extraction extraction = extract(from, isovalue, options, {.threads = threads_}).value();
    const double seconds = watch.seconds();
    return describe(extraction, seconds).count("must_move", extraction_must_move(from, isovalue, extraction.surface));
}

Reply IsotetContestant::extract_direct(double isovalue) {
    const Stopwatch watch;
    const DirectExtraction once =
        isotet::extract_direct(grid_, field_, {&isovalue, 1}, {}, {.threads = threads_}).value();
    const double seconds = watch.seconds();
    const Extraction& extraction = once.surfaces.front();
    return describe(extraction, seconds).count("must_move", input_bytes() + bytes_of(extraction.surface));
}

Reply IsotetContestant::set_field(const std::string& name) {
    const PackedGrid& before = packed(name);
    const Stopwatch watch;
    const PackedGrid changed = before.with_field(negative_, {.threads = threads_}).value();
    const double seconds = watch.seconds();
    return Reply().number("seconds", seconds).count("must_move", new_field_must_move(changed, field_.values.bytes()));
}

} // namespace isotet::bench
