// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Medit files as grids: vertices, cells and the values at vertices, text and binary alike.
#include "io/own/read_medit.hpp"

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "io/own/cell_list.hpp"
#include "io/own/pace.hpp"
#include "io/own/read_medit_parts.hpp"
#include "io/reader.hpp"

namespace isotet::io {

namespace {

using namespace medit;

constexpr std::string_view reference_name = "medit:ref";

/// A section's count, checked against what the rest of the file can hold.
template <class Source>
Result<std::uint64_t> read_count(std::int32_t keyword, Source& source, std::size_t integers, std::size_t reals) {
    std::int64_t count = 0;
    if (!source.count(count)) return broken(keyword, "has no count, at " + source.where());
    const std::uint64_t most = source.records_left(integers, reals);
    if (count < 0 || static_cast<std::uint64_t>(count) > most) {
        return broken(keyword, fmt::format("states {} entries, but there is room for {} at most", count, most));
    }
    return static_cast<std::uint64_t>(count);
}

template <class Source>
Error missing(std::int32_t keyword, std::uint64_t count, std::uint64_t index, const Source& source) {
    return broken(keyword, fmt::format("states {} entries, but entry {} is broken or missing at {}", count, index + 1,
                                       source.where()));
}

template <class Source>
Result<int> read_dimension(Source& source) {
    std::int64_t value = 0;
    if (!source.small(value) || (value != 2 && value != 3)) {
        return broken(dimension, fmt::format("is {}, but 2 or 3 is the rule, at {}", value, source.where()));
    }
    return static_cast<int>(value);
}

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
    std::uint64_t max_points_; ///< no vertex takes fewer than 4 bytes
    int dimension_ = 0;
    bool has_vertices_ = false;
    std::uint64_t count_ = 0; ///< of vertices
    std::vector<double> points_;
    std::vector<float> single_points_;
    CellList cells_;
    std::vector<std::int32_t> point_references_, cell_references_;
};

/// A field of SolAtVertices.
struct SolutionField {
    FieldInfo info;
    bool wanted = false;
    std::vector<double> values;
    std::vector<float> single_values;
};

class SolutionReader {
public:
    /// `values`   false: only the kinds of fields are read
    SolutionReader(std::string_view bytes, bool values, const ReadOptions& options, const Progress& progress)
        : options_(options), pace_(progress, bytes.size()), reads_values_(values) {}

    template <class Source>
    Result<void> section(std::int32_t keyword, Source& source) {
        if (keyword == dimension) {
            const auto value = read_dimension(source);
            if (!value) return value.error();
            dimension_ = *value;
            return {};
        }
        if (dimension_ == 0) return broken(keyword, "stands before Dimension");
        if (!fields_.empty()) return broken(keyword, "occurs twice, but a file has one");
        return source.single() ? read_fields<float>(source) : read_fields<double>(source);
    }

    bool reads_values() const { return reads_values_; }
    std::uint64_t count() const { return count_; }
    std::vector<SolutionField>& fields() { return fields_; }

private:
    template <class Real, class Source>
    Result<void> read_fields(Source& source) {
        std::int64_t count = 0, kinds = 0;
        if (!source.count(count)) return broken(sol_at_vertices, "has no count, at " + source.where());
        constexpr std::int64_t max_kinds = 1000; // libMeshb's limit
        if (!source.small(kinds) || kinds < 0 || kinds > max_kinds) {
            return broken(sol_at_vertices, fmt::format("states {} fields, but 0 to {} are the rule, at {}", kinds,
                                                       max_kinds, source.where()));
        }
        std::size_t components = 0;
        for (std::int64_t i = 0; i < kinds; ++i) {
            std::int64_t kind = 0;
            if (!source.small(kind) || kind < 1 || kind > 4) {
                return broken(sol_at_vertices, fmt::format("field {} is of kind {}, but 1 to 4 are the rule, at {}",
                                                           i + 1, kind, source.where()));
            }
            const std::size_t of_kind[] = {1, size(), size() * (size() + 1) / 2, size() * size()};
            SolutionField field;
            field.info = {i == 0 ? "sol" : fmt::format("sol_{}", i), Association::point, scalar_type_of<Real>(),
                          of_kind[kind - 1]};
            field.wanted = reads_values_ && wanted(options_, Association::point, field.info.name);
            components += field.info.components;
            fields_.push_back(std::move(field));
        }
        const std::uint64_t most = components ? source.records_left(0, components) : 0;
        if (count < 0 || (components > 0 && static_cast<std::uint64_t>(count) > most)) {
            return broken(sol_at_vertices,
                          fmt::format("states {} entries, but there is room for {} at most", count, most));
        }
        count_ = static_cast<std::uint64_t>(count);
        return components && reads_values_ ? read_values<Real>(source) : Result<void>();
    }

    /// Values of fields that are not wanted are skipped.
    template <class Real, class Source>
    Result<void> read_values(Source& source) {
        for (SolutionField& field : fields_) {
            if (field.wanted) values_of<Real>(field).reserve(count_ * field.info.components);
        }
        for (std::uint64_t i = 0; i < count_; ++i) {
            for (SolutionField& field : fields_) {
                for (std::size_t c = 0; c < field.info.components; ++c) {
                    double value = 0;
                    if (!source.real(value)) return missing(sol_at_vertices, count_, i, source);
                    if (field.wanted) values_of<Real>(field).push_back(static_cast<Real>(value));
                }
            }
            if (!pace_.goes_on(source.position())) return Pace::cancelled();
        }
        return {};
    }

    template <class Real>
    static std::vector<Real>& values_of(SolutionField& field) {
        if constexpr (std::is_same_v<Real, float>) return field.single_values;
        else return field.values;
    }
    std::size_t size() const { return static_cast<std::size_t>(dimension_); }

    const ReadOptions& options_;
    Pace pace_;
    bool reads_values_;
    int dimension_ = 0;
    std::uint64_t count_ = 0;
    std::vector<SolutionField> fields_;
};

template <class Reader>
Result<bool> visit(std::string_view bytes, Reader& reader, SectionVisitor visitor) {
    visitor.text = [&](std::int32_t keyword, TextSource& source) { return reader.section(keyword, source); };
    visitor.binary = [&](std::int32_t keyword, BinarySource& source) { return reader.section(keyword, source); };
    return visit_sections(bytes, visitor);
}

Result<bool> visit_solution(std::string_view bytes, SolutionReader& reader) {
    SectionVisitor visitor;
    visitor.skips = [](std::int32_t keyword) { return keyword != dimension && keyword != sol_at_vertices; };
    visitor.headers_only = !reader.reads_values();
    auto whole = visit(bytes, reader, std::move(visitor));
    if (!whole) return Error{whole.error().code, "the .sol file beside it: " + whole.error().message};
    if (!*whole && reader.fields().empty())
        return Error{ErrorCode::invalid_data,
                     "the .sol file beside it is cut short: it has neither SolAtVertices nor End"};
    return whole;
}

FileInfo info_of(SolutionReader* solution) {
    FileInfo info;
    info.format = "medit";
    if (solution) {
        for (const SolutionField& field : solution->fields()) info.fields.push_back(field.info);
    }
    for (const Association association : {Association::point, Association::cell}) {
        info.fields.push_back({std::string(reference_name), association, ScalarType::int32, 1});
    }
    return info;
}

} // namespace

Result<FileInfo> inspect_medit(std::string_view mesh, std::optional<std::string_view> solution,
                               const Progress& progress) {
    const ReadOptions options;
    if (form_of(mesh) == Form::none) return not_medit(mesh);
    if (!solution) return info_of(nullptr);
    SolutionReader reader(*solution, false, options, progress);
    if (const auto whole = visit_solution(*solution, reader); !whole) return whole.error();
    return info_of(&reader);
}

Result<ReadResult> parse_medit(std::string_view mesh, std::optional<std::string_view> solution,
                               const ReadOptions& options, const Progress& progress) {
    ReadResult result;
    MeshReader mesh_reader(mesh, options, progress);
    SectionVisitor visitor;
    visitor.skips = [](std::int32_t keyword) { return keyword == sol_at_vertices; };
    const auto whole = visit(mesh, mesh_reader, std::move(visitor));
    if (!whole) return whole.error();
    if (!*whole) result.notes.emplace_back("the file does not end with the keyword End: it may be cut short");
    if (auto finished = mesh_reader.finish(result); !finished) return finished.error();
    if (!solution) {
        result.info = info_of(nullptr);
    } else {
        SolutionReader reader(*solution, true, options, progress);
        const auto whole_solution = visit_solution(*solution, reader);
        if (!whole_solution) return whole_solution.error();
        if (!*whole_solution)
            result.notes.emplace_back("the .sol file does not end with the keyword End: it may be cut short");
        result.info = info_of(&reader);
        for (SolutionField& field : reader.fields()) {
            if (reader.count() != result.grid.points.tuples()) {
                return Error{ErrorCode::invalid_data,
                             fmt::format("the .sol file beside it has values for {} vertices, but there are {}",
                                         reader.count(), result.grid.points.tuples())};
            }
            if (!field.wanted) continue;
            const bool single = field.info.type == ScalarType::float32;
            result.grid.point_fields.push_back(
                {field.info.name, single ? Array::own(std::move(field.single_values), field.info.components)
                                         : Array::own(std::move(field.values), field.info.components)});
        }
    }
    if (const auto step = choose_step(result.info, options); !step) return step.error();
    return result;
}

} // namespace isotet::io
