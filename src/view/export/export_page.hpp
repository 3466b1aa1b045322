// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From a grid file to a page of one file, as `isotet export` does.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <isotet/isovalues.hpp>
#include <isotet/jobs/field_choice.hpp>
#include <isotet/jobs/grid_source.hpp>
#include <isotet/jobs/job.hpp>
#include <isotet/jobs/pack_file.hpp>
#include <isotet/jobs/range_shares.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/pack.hpp>
#include <isotet/result.hpp>

namespace isotet::view {

/// What is in a page.
enum class PageContent : std::uint8_t {
    fitting, ///< the grid where that fits and nothing asks for certain isosurfaces, else isosurfaces
    surfaces,
    grid ///< packed
};

struct ExportJob {
    jobs::GridOptions grid;
    jobs::FieldChoice field;
    std::string out;                        ///< .html
    std::vector<std::string> other_outputs; ///< of the caller: no file of the grid may be one
    PageContent as = PageContent::fitting;
    std::vector<double> isovalues;                         ///< these; empty: `surfaces` of them
    std::vector<IsovalueShare> shares;                     ///< more, of the first step
    std::optional<std::uint64_t> surfaces;                 ///< nothing: 63
    std::vector<double> between;                           ///< none, or two: where they lie evenly
    jobs::RangeShares between_shares;                      ///< of the first step that is shown: in place of both ends
    std::string color_by;                                  ///< a field; empty: each isovalue has its colour
    std::optional<RefineOptions> refine = RefineOptions{}; ///< of curved cells; nothing: they are split at their nodes
    bool all_steps = false;
    std::uint64_t max_size = 20'000'000; ///< of the file, in bytes
};

struct ExportedSurfaces {
    std::vector<double> isovalues; ///< that are there, rising
    std::size_t left_out = 0;      ///< of those that were asked for
    std::size_t steps = 0;
    std::uint64_t triangles = 0; ///< of all surfaces
    bool boundary = false;
    double read_seconds = 0, extract_seconds = 0, write_seconds = 0;
};

struct ExportedGrid {
    jobs::PackNumbers packed;
    std::size_t left_out = 0; ///< of the fields
    bool rounded = false;     ///< values, to 16 bits
};

struct ExportNumbers {
    std::variant<ExportedSurfaces, ExportedGrid> content;
    std::uint64_t bytes = 0; ///< of the page
};

/// Decides what is in the page, and writes it. Notes tell what was left out, and why.
/// Errors   as jobs::pack_file() and save_surfaces(); invalid_argument: an option or a name; the grid that must be in the
///          page does not fit
Result<ExportNumbers> export_page(const ExportJob& job, jobs::Caller& caller);

/// The name of a file without its folder, for those who read the page.
std::string shown_name(const std::string& file);

std::vector<std::string> names_of(const std::vector<FieldReport>& fields);

} // namespace isotet::view
