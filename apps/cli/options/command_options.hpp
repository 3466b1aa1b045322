// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The options of every command, written into the option tree once.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "options/option_tree.hpp"
#include "options/options.hpp"

namespace isotet::cli {

void add_commands(const Command& program, CommandLine& line);

/// FILE, OUT and --output.
void add_grid_and_surface(const Command& command, ExtractJob& job);
/// What surfaces are like, and how they are made. `solids` is the help of --solid.
void add_surface_options(const Command& command, ExtractJob& job, const std::string& solids);
void add_common(const Command& command, CommonOptions& common);
/// A finite number.
double parse_end(const std::string& option, std::string_view text);
/// "0.1:0.5"; its ends may be shares.
SolidRange parse_range(const std::string& option, const std::string& text, RangeShares& shares);
/// The value of --keep.
PartChoice parse_parts(const std::string& text);
void add_info_command(const Command& program, InfoCommand& info);
void add_extract_command(const Command& program, ExtractCommand& extract);
void add_slice_command(const Command& program, SliceCommand& slice);
void add_clip_command(const Command& program, ClipCommand& clip);
void add_view_command(const Command& program, ViewCommand& view);
void add_export_command(const Command& program, ExportCommand& exported);
void add_page_command(const Command& program, PageCommand& page);
void add_check_command(const Command& program, CheckCommand& check);
void add_pack_command(const Command& program, PackCommand& pack);
Command add_render_command(const Command& program, RenderCommand& render);
Command add_bench_command(const Command& program, BenchCommand& bench);

// Options that several commands have.
/// Which device, which grid, and what every command has.
void add_machine_and_input(const Command& command, DeviceChoice& device, GridOptions& grid, CommonOptions& common);
/// An option whose value is a number of bytes, more than 0.
void add_bytes(const Command& command, const char* name, std::function<void(std::uint64_t)> set, const char* help);
void add_bytes(const Command& command, const char* name, std::optional<std::uint64_t>& bytes, const char* help);
/// Of a packed file.
void add_memory(const Command& command, std::optional<std::uint64_t>& memory);
/// `what`   is made between two steps
void add_interpolate(const Command& command, std::uint64_t& between, const std::string& what);
void add_time(const Command& command, GridOptions& grid);
void add_reading(const Command& command, GridOptions& grid, const std::string& format_option);
/// `format`   the ending of files that can be packed
void add_compression(const Command& command, Compression& compression, const char* format);
Option add_field(const Command& command, FieldChoice& field, const std::string& description);
void add_centre(const Command& command, FieldChoice& field);
/// Grids behind FILE, which are further time steps.
void add_more_files(const Command& command, GridOptions& grid);

/// The same, and OUT among them: the last name that is not one of a grid only. -o is there already.
void add_out_and_more_files(const Command& command, GridOptions& grid, std::string& out, const std::string& what);

/// For a list of numbers of which the first two may be shares, which stand as 0 until the grid is read.
Command::OtherWords shares_of_ends(std::vector<double>& numbers, RangeShares& shares, const char* rule);
/// `isovalues` are numbers, `shares` the others.
///
/// `decimal_comma`   becomes what two isovalues are with a comma for a decimal sign; may be null
Option add_isovalues(const Command& command, std::vector<double>& isovalues, std::vector<IsovalueShare>& shares,
                     std::optional<double>* decimal_comma = nullptr);
/// `asked`   becomes true with any of the options; may be null
void add_refinement(const Command& command, RefineChoice& refine, bool* asked = nullptr);
void add_color_scale(const Command& command, ColorScale& scale, std::vector<double>& range);
void add_device(const Command& command, DeviceChoice& device);
void add_device_memory(const Command& command, DeviceChoice& device);

} // namespace isotet::cli
