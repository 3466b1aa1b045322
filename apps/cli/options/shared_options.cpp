// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "options/command_options.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>
#include <isotet/text.hpp>

#include "options/shape_text.hpp"

namespace isotet::cli {

namespace {

constexpr const char* more_files_text = "Files of further time steps, taken in the order of the numbers in their names";

void add_step(const std::string& option, const std::string& name, GridOptions& grid) {
    if (name.empty()) refuse_value(option, name, "the name of a file");
    grid.more_files.push_back(name);
    if (comes_before(name, grid.file)) std::swap(grid.more_files.back(), grid.file);
    std::ranges::stable_sort(grid.more_files, comes_before);
}

/// Whether a name can be one of a grid only.
bool is_of_grid(const std::string& name) {
    const FileKinds kinds = kinds_of(name);
    return kinds.grid && !kinds.surface;
}

/// "0,2" as 0.2; nothing for other text.
std::optional<double> with_decimal_comma(std::string text) {
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos || text.find_first_not_of("-0123456789,") != std::string::npos) return {};
    text[comma] = '.';
    return parse_number(text);
}

} // namespace

void add_bytes(const Command& command, const char* name, std::function<void(std::uint64_t)> set, const char* help) {
    command.add_value(
        name,
        [name, set = std::move(set)](const std::string& text) {
            const std::optional<std::uint64_t> bytes = parse_bytes(text);
            if (!bytes || *bytes == 0) refuse_value(name, text, "bytes, such as 2GB");
            set(*bytes);
        },
        "BYTES", help);
}

void add_bytes(const Command& command, const char* name, std::optional<std::uint64_t>& bytes, const char* help) {
    add_bytes(command, name, [&bytes](std::uint64_t given) { bytes = given; }, help);
}

void add_memory(const Command& command, std::optional<std::uint64_t>& memory) {
    const OptionGroup group(command, "Method and machine");
    add_bytes(command, "--memory", memory,
              "Of a packed file, keep at most so much in memory, such as 2GB; default: half of what is free");
}

void add_interpolate(const Command& command, std::uint64_t& between, const std::string& what) {
    constexpr std::uint64_t most = 10'000;
    command
        .add_count(
            "--interpolate", {1, most}, [&](std::uint64_t n) { between = n; }, "N",
            "N more " + what +
                " between two steps of a packed file, of values (1-w)a+wb; points likewise where they move. {step} in "
                "OUT then counts all of them")
        .needs(command.option("--all-steps"));
}

void add_time(const Command& command, GridOptions& grid) {
    const OptionGroup group(command, "Time steps");
    const Option time =
        command.add_number("--time", [&](double t) { grid.time = t; }, "T", "The time step with this time");
    command
        .add_count(
            "--step", {}, [&](std::uint64_t n) { grid.step = n; }, "N", "The time step with this number, from 0")
        .excludes(time);
}

void add_reading(const Command& command, GridOptions& grid, const std::string& format_option) {
    const OptionGroup group(command, "Reading");
    command.add_text(format_option, grid.format, "FORMAT",
                     "Format of the grid; default: content decides, then the name");
    command.add_texts(
        "--block", [&](const std::vector<std::string>& names) { grid.blocks = names; }, "NAME|NUMBER",
        "Read only this block, zone, part or region of the file, by its name or number as info lists them; may be "
        "repeated");
    command.add_texts(
        "--cells", [&](const std::vector<std::string>& cells) { grid.cells = cells; }, "FIELD=LIST",
        "Keep only cells with these values of a cell field: numbers, ranges A:B, names of regions, as in "
        "region=2,5:7,sand; all others: !FIELD=LIST; may be repeated: all must hold");
    command.add_text("--displace", grid.displace, "FIELD", "Move the points by this vector field");
    command.add_number(
        "--merge-points", [&](double t) { grid.merge_points = t; }, "TOLERANCE",
        "Merge points closer than this; 0: exactly equal coordinates. Refused when every cell collapses");
    command
        .add_choice<MergedValues>(
            "--merge-values", grid.merge_values, {{"lowest", MergedValues::lowest}, {"mean", MergedValues::mean}},
            "Value of merged points where a field jumps: that of the lowest-numbered, or the mean")
        .needs(command.option("--merge-points"));
    command.add_choice<HangingChoice>(
        "--hanging-points", grid.hanging_points,
        {{"close", HangingChoice::close}, {"interpolate", HangingChoice::interpolate}, {"leave", HangingChoice::leave}},
        "Points that hang on faces and edges of larger cells: close gives them to these cells; interpolate also takes "
        "their values from these cells; leave leaves the surface open there");
    command.add_flag("--keep-pieces", grid.keep_pieces,
                     "Do not join points of different pieces that have equal coordinates");
    command.add_flag("--allow-outside", grid.allow_outside,
                     "Index files (.pvd, .pvtu and so on) may name files outside their own folder");
}

void add_compression(const Command& command, Compression& compression, const char* format) {
    command.add_choice<Compression>(
        "--compress", compression,
        {{"none", Compression::none}, {"zlib", Compression::zlib}, {"lz4", Compression::lz4}},
        fmt::format("Packs the arrays of {}: by zlib, which every VTK reads, or by LZ4, which is read faster", format));
}

Option add_field(const Command& command, FieldChoice& field, const std::string& description) {
    const Option name = command.add_text("-f,--field", field.name, "FIELD", description);
    command.add_flag("--cell-field", field.cell_field, "Use the cell field if a point field has the same name");
    return name;
}

void add_centre(const Command& command, FieldChoice& field) {
    command.add_value(
        "--centre",
        [&field](const std::string& text) {
            if (text != "mean" && text != "own") refuse_value("--centre", text, "mean or own");
            field.own_centres = text == "own";
        },
        "mean|own",
        "Polyhedra, of a cell field: the value at the point inside around which a polyhedron is split is the mean of "
        "its points (default), or the cell's own: sharper, and beyond the values around");
}

void add_more_files(const Command& command, GridOptions& grid) {
    command.add_texts(
        "MORE",
        [&grid](const std::vector<std::string>& names) {
            for (const std::string& name : names) {
                refuse_loose_number(name);
                add_step("MORE", name, grid);
            }
        },
        "FILES", more_files_text);
}

void add_out_and_more_files(const Command& command, GridOptions& grid, std::string& out, const std::string& what) {
    const auto by_place = std::make_shared<bool>(false); // OUT was given by its place
    const auto take = [&grid, &out, by_place](const std::string& option, const std::string& name) {
        if (name.empty()) refuse_value(option, name, "the name of a file");
        const bool is_named = !out.empty() && !*by_place; // by -o
        if (is_of_grid(name) || (is_named && kinds_of(name).grid)) return add_step(option, name, grid);
        if (is_named) refuse_value(option, name, "nothing beside -o but grids of further time steps");
        if (*by_place) add_step(option, out, grid); // the last one is OUT
        out = name;
        *by_place = true;
    };
    command.add_value("OUT", [take](const std::string& name) { take("OUT", name); }, "OUT_FILE", what);
    command.add_texts(
        "MORE",
        [take](const std::vector<std::string>& names) {
            for (const std::string& name : names) {
                refuse_loose_number(name);
                take("MORE", name);
            }
        },
        "FILES", std::string(more_files_text) + "; OUT is then the last name");
}

double parse_end(const std::string& option, std::string_view text) {
    const std::optional<double> number = parse_number(text);
    if (!number) refuse_value(option, text, "a finite number, or a share such as 90%v or p95");
    return *number;
}

SolidRange parse_range(const std::string& option, const std::string& text, RangeShares& shares) {
    const std::size_t colon = text.find(':');
    SolidRange out;
    const bool divided = colon != std::string::npos;
    const std::string_view first = std::string_view(text).substr(0, colon);
    const std::string_view second = divided ? std::string_view(text).substr(colon + 1) : std::string_view();
    shares = {parse_share(first), parse_share(second)};
    const std::optional<double> lower = parse_number(first), upper = parse_number(second);
    if (lower) out.lower = *lower;
    if (upper) out.upper = *upper;
    if (!divided || (!lower && !shares.lower) || (!upper && !shares.upper) || !(out.lower < out.upper))
        refuse_value(option, text, "two isovalues A:B, A below B: numbers, or shares such as 90%v");
    return out;
}

Command::OtherWords shares_of_ends(std::vector<double>& numbers, RangeShares& shares, const char* rule) {
    const auto take = [&numbers, &shares](std::string_view word) {
        const std::optional<IsovalueShare> share = parse_share(word);
        if (!share || numbers.size() > 1) return false;
        (numbers.empty() ? shares.lower : shares.upper) = share;
        numbers.push_back(0);
        return true;
    };
    return {take, rule};
}

Option add_isovalues(const Command& command, std::vector<double>& isovalues, std::vector<IsovalueShare>& shares,
                     std::optional<double>* decimal_comma) {
    return command.add_numbers("-i,--isovalue", isovalues, "V[,W...]",
                               "Isovalues, separated by commas: numbers, 90%v (with 90 % of the grid's volume below), "
                               "p95 (95th percentile of the point values); or @NAME: from that file, separated by "
                               "blanks, commas or line ends, # begins a comment; may be repeated",
                               {[&shares](std::string_view word) {
                                    const std::optional<IsovalueShare> share = parse_share(word);
                                    if (share) shares.push_back(*share);
                                    return share.has_value();
                                },
                                "finite numbers, or shares such as 90%v or p95",
                                [decimal_comma](const std::vector<std::string>& lists) {
                                    if (decimal_comma && lists.size() == 1)
                                        *decimal_comma = with_decimal_comma(lists.front());
                                }});
}

void add_device(const Command& command, DeviceChoice& choice) {
    const OptionGroup group(command, "Method and machine");
    command.add_value(
        "--device",
        [&choice](const std::string& name) {
            if (name.empty()) refuse_value("--device", name, "a device of isotet devices, software or none");
            choice.name = name;
        },
        "DEVICE",
        "The Vulkan device: its number or a part of its name in isotet devices, software, or none; default: the best "
        "graphics card");
}

void add_device_memory(const Command& command, DeviceChoice& choice) {
    const OptionGroup group(command, "Method and machine");
    add_bytes(command, "--device-memory", choice.memory,
              "Memory of the device to take at most, such as 2GB; default: what is free");
}

void add_common(const Command& command, CommonOptions& common) {
    const OptionGroup group(command, "Threads and messages");
    command.add_file("--json", common.json, "FILE",
                     "Write the numbers as JSON too; - is standard output, which then has no table");
    command.add_count(
        "-j,--threads", {0, 4096}, [&](std::uint64_t n) { common.threads = static_cast<int>(n); }, "N",
        "Threads; 0 or not given: all");
    const Option quiet = command.add_flag("-q,--quiet", common.quiet, "No table, no notes, no progress: only errors");
    command.add_flag("-v,--verbose", common.verbose, "Say more").excludes(quiet);
}

void add_machine_and_input(const Command& command, DeviceChoice& device, GridOptions& grid, CommonOptions& common) {
    add_device(command, device);
    add_device_memory(command, device);
    add_time(command, grid);
    add_reading(command, grid, "--format");
    add_common(command, common);
}

} // namespace isotet::cli
