// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk_legacy/legacy_vtk.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "io/files/pace.hpp"
#include "io/files/text_scanner.hpp"
#include "io/vtk_legacy/legacy_cells.hpp"
#include "io/vtk_legacy/legacy_data.hpp"
#include "io/vtk_legacy/legacy_values.hpp"

namespace isotet::io {
namespace {

std::uint64_t product(const std::array<std::uint64_t, 3>& counts) {
    constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
    const std::uint64_t plane = counts[0] * counts[1]; // DIMENSIONS have 31 bits
    return plane == 0 || counts[2] <= most / plane ? plane * counts[2] : most;
}

class LegacyReader {
public:
    LegacyReader(const ByteSource& source, const LegacyWants& wants, const Progress& progress)
        : source_(source),
          values_(source, progress),
          scanner_(values_.scanner()),
          wants_(wants),
          progress_(progress),
          data_(values_, wants, file_) {}

    Result<LegacyFile> read() {
        auto done = read_sections();
        if (scanner_.error()) return *scanner_.error();
        if (!done) return done.error();
        data_.finish();
        return std::move(file_);
    }

private:
    Result<void> read_sections() {
        if (auto header = read_header(); !header) return header;
        for (;;) {
            if (progress_.cancelled()) return Pace::cancelled();
            progress_("read", static_cast<double>(scanner_.position()) / static_cast<double>(source_.size()));
            const auto keyword = lower(scanner_.word());
            if (keyword.empty()) return {};
            if (auto section = read_section(keyword); !section) return section;
        }
    }

    Result<void> read_header() {
        constexpr std::string_view start = "# vtk DataFile Version";
        Scratch scratch;
        const auto first = source_.view(0, std::min(source_.size(), utf_8_mark.size() + start.size()), scratch);
        if (!first) return first.error();
        if (!first->starts_with(start) && !(first->starts_with(utf_8_mark) && first->ends_with(start)))
            return invalid_data("the file does not start with \"# vtk DataFile Version\"");
        scanner_.next_line(); // the version: CELLS and POLYGONS tell themselves which form they have
        scanner_.next_line(); // the title
        const auto form = lower(scanner_.word());
        if (form != "ascii" && form != "binary")
            return invalid_data(fmt::format("the third line is {}, not ASCII or BINARY", in_quotes(form)));
        values_.set_binary(form == "binary");
        return {};
    }

    Result<void> read_section(const std::string& keyword) {
        if (keyword == "dataset") return read_dataset();
        if (LegacyData::is_section(keyword)) return data_.read(keyword);
        if (file_.dataset.empty()) return invalid_data(fmt::format("{} before DATASET", in_quotes(keyword)));
        if (keyword == "points") return read_points();
        if (keyword == "vertices") return read_legacy_cells(values_, keyword, list(), file_.vertices);
        if (keyword == "lines") return read_legacy_cells(values_, keyword, list(), file_.lines);
        if (keyword == "polygons") return read_legacy_cells(values_, keyword, list(), file_.polygons);
        if (keyword == "triangle_strips") return read_legacy_cells(values_, keyword, list(), file_.strips);
        if (keyword == "cells") {
            file_.has_cells = true;
            return read_legacy_cells(values_, keyword,
                                     wants_.geometry && wants_.leave_corners ? LegacyList::without_corners : list(),
                                     file_.cells);
        }
        if (keyword == "cell_types") {
            file_.has_cells = true;
            return read_legacy_cell_types(values_, wants_.geometry, file_);
        }
        if (keyword == "blanking") return read_blanking();
        if (keyword == "dimensions") return read_dimensions();
        if (keyword == "extent") return read_extent();
        if (keyword == "origin") return read_three(file_.origin, keyword);
        if (keyword == "spacing" || keyword == "aspect_ratio") return read_three(file_.spacing, keyword);
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (keyword == std::string(1, "xyz"[axis]) + "_coordinates") return read_coordinates(axis, keyword);
        return data_.read_unknown(keyword);
    }

    LegacyList list() const { return wants_.geometry ? LegacyList::whole : LegacyList::skipped; }

    Result<void> read_dataset() {
        const auto kind = lower(scanner_.word());
        if (!wants_.dataset(kind)) return invalid_data(fmt::format("this is a dataset of kind {}", in_quotes(kind)));
        file_.dataset = kind;
        return {};
    }

    Result<void> read_points() {
        if (file_.has_points) return values_.before_here("POINTS occurs twice");
        const auto count = values_.read_count("the number of points");
        if (!count) return count.error();
        file_.point_count = *count;
        data_.expect_names(3);
        const auto type = values_.read_type();
        if (!type) return type.error();
        auto points = values_.read_floating(*type, *count, 3, "POINTS", wants_.geometry);
        if (!points) return points.error();
        file_.points = std::move(*points);
        file_.has_points = true;
        return {};
    }

    /// Of a structured grid: 0 hides a point.
    Result<void> read_blanking() {
        const auto count = values_.read_count("the number of marks");
        if (!count) return count.error();
        if (*count != product(file_.dimensions))
            return invalid_data(fmt::format("BLANKING has {} marks, but the grid {} x {} x {} points", *count,
                                            file_.dimensions[0], file_.dimensions[1], file_.dimensions[2]));
        const auto type = values_.read_type();
        if (!type) return type.error();
        auto marks = values_.read_values(*type, *count, 1, "BLANKING", wants_.geometry);
        if (!marks) return marks.error();
        constexpr std::uint8_t hidden = 2;
        if (wants_.geometry)
            file_.point_data.push_back({"vtkGhostType", mapped<std::uint8_t>(*marks, [](auto mark) {
                                            return mark == 0 ? hidden : std::uint8_t{0};
                                        })});
        return {};
    }

    Result<void> read_dimensions() {
        for (std::uint64_t& count : file_.dimensions)
            if (!scanner_.number(count) || count > std::numeric_limits<std::int32_t>::max())
                return values_.before_here("DIMENSIONS are not three counts");
        return {};
    }

    /// In place of DIMENSIONS: the first and the last index along each axis.
    Result<void> read_extent() {
        constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
        file_.size_keyword = "EXTENT";
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::int64_t first = 0, last = 0;
            if (!scanner_.number(first) || !scanner_.number(last) || first < -most || last > most || last < first - 1)
                return values_.before_here("EXTENT is not three pairs of a first and a last index");
            file_.first_index[axis] = first;
            file_.dimensions[axis] = static_cast<std::uint64_t>(last - first + 1);
        }
        return {};
    }

    Result<void> read_three(std::array<double, 3>& numbers, std::string_view keyword) {
        for (double& number : numbers)
            if (!scanner_.number(number)) return values_.before_here(fmt::format("{} is not three numbers", keyword));
        return {};
    }

    Result<void> read_coordinates(std::size_t axis, std::string_view keyword) {
        const auto count = values_.read_count("the number of coordinates");
        if (!count) return count.error();
        data_.expect_names(1);
        const auto type = values_.read_type();
        if (!type) return type.error();
        auto values = values_.read_floating(*type, *count, 1, keyword, wants_.geometry);
        if (!values) return values.error();
        file_.coordinates[axis] = std::move(*values);
        return {};
    }

    const ByteSource& source_;
    LegacyValues values_;
    SourceScanner& scanner_;
    const LegacyWants& wants_;
    const Progress& progress_;
    LegacyFile file_;
    LegacyData data_;
};

} // namespace

std::uint64_t LegacyFile::points_announced() const {
    const bool implied = dataset == "structured_points" || dataset == "rectilinear_grid";
    return implied ? product(dimensions) : point_count;
}

std::uint64_t LegacyFile::cells_announced() const {
    if (dataset == "unstructured_grid") return cell_type_count;
    if (dataset == "polydata") return vertices.count + lines.count + polygons.count + strips.count;
    std::array<std::uint64_t, 3> along = dimensions;
    for (std::uint64_t& count : along)
        if (count > 1) --count;
    return product(along);
}

Result<LegacyFile> read_legacy_vtk(const ByteSource& source, const LegacyWants& wants, const Progress& progress) {
    return LegacyReader(source, wants, progress).read();
}

} // namespace isotet::io
