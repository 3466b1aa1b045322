// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Medit files as grids: vertices, cells and the values at vertices, text and binary alike.
#include "io/medit/read_medit.hpp"

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "io/files/pace.hpp"
#include "io/medit/read_medit_parts.hpp"
#include "io/medit/read_medit_solution.hpp"
#include "io/pieces/cell_list.hpp"
#include "io/pieces/loaded.hpp"
#include "io/reader.hpp"

namespace isotet::io {

namespace {

using namespace medit;

constexpr std::string_view reference_name = "medit:ref";

/// Reads the reference that ends each vertex and each cell.
template <class Source>
bool read_reference(Source& source, std::vector<std::int32_t>* references) {
    std::int64_t value = 0;
    if (!source.integer(value)) return false;
    if (value < std::numeric_limits<std::int32_t>::min() || value > std::numeric_limits<std::int32_t>::max())
        return false;
    if (references) references->push_back(static_cast<std::int32_t>(value));
    return true;
}

class MeshReader {
public:
    MeshReader(std::string_view bytes, const ReadOptions& options, const Progress& progress)
        : options_(options), pace_(progress, bytes.size()), max_points_(bytes.size() / 4), cells_(max_points_) {}

    template <class Source>
    Result<void> section(std::int32_t keyword, Source& source) {
        if (keyword == dimension) {
            const auto value = read_dimension(source);
            if (!value) return value.error();
            dimension_ = *value;
            return {};
        }
        if (keyword == vertices)
            return source.single() ? read_vertices(source, single_points_) : read_vertices(source, points_);
        return read_cells(*cell_kind(keyword), source);
    }

    Result<void> finish(ReadResult& result) {
        if (!has_vertices_) return Error{ErrorCode::invalid_data, "has no section Vertices"};
        if (cells_.size() > 0 && cells_.highest() >= count_) {
            return Error{ErrorCode::invalid_data,
                         fmt::format("a cell has vertex {}, but there are {} Vertices", cells_.highest() + 1, count_)};
        }
        Grid& grid = result.grid;
        grid.points =
            single_points_.empty() ? Array::own(std::move(points_), 3) : Array::own(std::move(single_points_), 3);
        grid.cells = cells_.finish();
        if (wanted(options_, Association::point, reference_name)) {
            grid.point_fields.push_back({std::string(reference_name), Array::own(std::move(point_references_))});
        }
        if (wanted(options_, Association::cell, reference_name)) {
            grid.cell_fields.push_back({std::string(reference_name), Array::own(std::move(cell_references_))});
        }
        return {};
    }

    const std::vector<CellRun>& runs() const { return runs_; }

private:
    template <class Source, class Real>
    Result<void> read_vertices(Source& source, std::vector<Real>& points) {
        if (has_vertices_) return broken(vertices, "occurs twice, but a file has one");
        if (dimension_ == 0) return broken(vertices, "stands before Dimension");
        const auto count = read_count(vertices, source, 1, static_cast<std::size_t>(dimension_));
        if (!count) return count.error();
        has_vertices_ = true;
        count_ = *count;
        points.reserve(3 * count_);
        auto* references = wanted(options_, Association::point, reference_name) ? &point_references_ : nullptr;
        for (std::uint64_t i = 0; i < count_; ++i) {
            double x = 0, y = 0, z = 0;
            if (!source.real(x) || !source.real(y) || (dimension_ == 3 && !source.real(z)) ||
                !read_reference(source, references)) {
                return missing(vertices, count_, i, source);
            }
            points.insert(points.end(), {static_cast<Real>(x), static_cast<Real>(y), static_cast<Real>(z)});
            if (!pace_.goes_on(source.position())) return Pace::cancelled();
        }
        return {};
    }

    template <class Source>
    Result<void> read_cells(const CellKind& kind, Source& source) {
        const auto count = read_count(kind.keyword, source, kind.corners + 1, 0);
        if (!count) return count.error();
        cells_.reserve(*count * kind.corners);
        runs_.push_back({kind.keyword, cells_.size(), *count});
        auto* references = wanted(options_, Association::cell, reference_name) ? &cell_references_ : nullptr;
        for (std::uint64_t i = 0; i < *count; ++i) {
            cells_.start(kind.vtk_type, kind.corners);
            for (std::uint32_t k = 0; k < kind.corners; ++k) {
                std::int64_t number = 0;
                if (!source.integer(number)) return missing(kind.keyword, *count, i, source);
                if (number < 1 || static_cast<std::uint64_t>(number) > max_points_) {
                    return broken(kind.keyword,
                                  fmt::format("entry {} has vertex {}, but vertices are counted from 1{}", i + 1,
                                              number, has_vertices_ ? fmt::format(" to {}", count_) : ""));
                }
                cells_.corner(static_cast<std::uint64_t>(number) - 1);
            }
            if (!read_reference(source, references)) return missing(kind.keyword, *count, i, source);
            if (!pace_.goes_on(source.position())) return Pace::cancelled();
        }
        return {};
    }

    const ReadOptions& options_;
    Pace pace_;
    std::vector<CellRun> runs_;
    std::uint64_t max_points_; ///< no vertex takes fewer than 4 bytes
    int dimension_ = 0;
    bool has_vertices_ = false;
    std::uint64_t count_ = 0; ///< of vertices
    std::vector<double> points_;
    std::vector<float> single_points_;
    CellList cells_;
    std::vector<std::int32_t> point_references_, cell_references_;
};

Result<bool> visit_mesh(std::string_view bytes, MeshReader& reader) {
    SectionVisitor visitor;
    visitor.skips = [](std::int32_t keyword) { return solution_kind(keyword) != nullptr; };
    visitor.text = [&](std::int32_t keyword, TextSource& source) { return reader.section(keyword, source); };
    visitor.binary = [&](std::int32_t keyword, BinarySource& source) { return reader.section(keyword, source); };
    return visit_sections(bytes, visitor);
}

FileInfo info_of(const Solution* solution) {
    FileInfo info;
    info.format = "medit";
    if (solution) {
        for (const SolutionSection& section : solution->sections)
            for (const SolutionField& field : section.fields) announce(info, field.info);
        info.left_out = solution->left_out;
    }
    for (const Association association : {Association::point, Association::cell}) {
        info.fields.push_back({std::string(reference_name), association, ScalarType::int32, 1});
    }
    return info;
}

} // namespace

Result<FileInfo> inspect_medit(std::string_view mesh, std::optional<std::string_view> solution,
                               const Progress& progress) {
    if (form_of(mesh) == Form::none) return not_medit(mesh);
    if (!solution) return info_of(nullptr);
    const auto read = read_solution(*solution, nullptr, progress);
    return read ? Result<FileInfo>(info_of(&*read)) : read.error();
}

Result<ReadResult> parse_medit(std::string_view mesh, std::optional<std::string_view> solution,
                               const ReadOptions& options, const Progress& progress) {
    ReadResult result;
    MeshReader mesh_reader(mesh, options, progress);
    const auto whole = visit_mesh(mesh, mesh_reader);
    if (!whole) return whole.error();
    if (!*whole) result.notes.emplace_back("the file does not end with the keyword End: it may be cut short");
    if (auto finished = mesh_reader.finish(result); !finished) return finished.error();
    if (!solution) {
        result.info = info_of(nullptr);
    } else {
        auto values = read_solution(*solution, &options, progress);
        if (!values) return values.error();
        if (!values->whole)
            result.notes.emplace_back("the .sol file does not end with the keyword End: it may be cut short");
        result.info = info_of(&*values);
        give_solution(*std::move(values), mesh_reader.runs(), result);
    }
    if (const auto step = choose_step(result.info, options); !step) return step.error();
    return result;
}

} // namespace isotet::io
