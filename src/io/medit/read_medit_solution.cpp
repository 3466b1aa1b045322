// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/medit/read_medit_solution.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "io/files/pace.hpp"
#include "io/files/scalars.hpp"
#include "io/medit/read_medit_parts.hpp"
#include "io/pieces/loaded.hpp"
#include "io/pieces/tensor_order.hpp"
#include "io/reader.hpp"

namespace isotet::io::medit {

namespace {

Association association_of(std::int32_t keyword) {
    return keyword == sol_at_vertices ? Association::point : Association::cell;
}

std::string what_of(Association association) {
    return association == Association::point ? "point field" : "cell field";
}

class SolutionReader {
public:
    SolutionReader(std::string_view bytes, const ReadOptions* options, const Progress& progress)
        : options_(options), pace_(progress, bytes.size()) {}

    template <class Source>
    Result<void> section(std::int32_t keyword, Source& source) {
        if (keyword == dimension) {
            const auto value = read_dimension(source);
            if (!value) return value.error();
            dimension_ = static_cast<std::size_t>(*value);
            return {};
        }
        if (dimension_ == 0) return broken(keyword, "stands before Dimension");
        open_ = SolutionSection{keyword, 0, {}};
        auto read = source.single() ? read_fields<float>(source) : read_fields<double>(source);
        if (!read) return read;
        solution_.sections.push_back(std::exchange(open_, {}));
        return {};
    }

    /// Values of what has no volume are told, and skipped.
    bool skips(std::int32_t keyword) {
        if (keyword == dimension || keyword == sol_at_vertices) return false;
        const SolutionKind* const kind = solution_kind(keyword);
        if (kind && kind->of != 0) return false;
        if (kind) leave_out_section(kind->name, "it belongs to cells without a volume");
        return true;
    }

    void unknown(std::string_view name) {
        if (name.find("Sol") != std::string_view::npos) leave_out_section(name, "it is not known");
    }

    /// Fields of the section that was being read.
    void leave_out_rest(const Error& error) {
        const std::string reason = "the .sol file beside it: " + error.message;
        if (open_.fields.empty())
            solution_.left_out.push_back(
                {what_of(association_of(open_.keyword == 0 ? std::int32_t{sol_at_vertices} : open_.keyword)), "sol",
                 reason});
        for (const SolutionField& field : open_.fields)
            solution_.left_out.push_back({what_of(field.info.association), field.info.name, reason});
    }

    bool reads_values() const { return options_ != nullptr; }
    Solution take() { return std::move(solution_); }

private:
    template <class Real, class Source>
    Result<void> read_fields(Source& source) {
        const std::int32_t keyword = open_.keyword;
        std::int64_t count = 0, kinds = 0;
        if (!source.count(count)) return broken(keyword, "has no count, at " + source.where());
        constexpr std::int64_t max_kinds = 1000; // libMeshb's limit
        if (!source.small(kinds) || kinds < 0 || kinds > max_kinds) {
            return broken(keyword, fmt::format("states {} fields, but 0 to {} are the rule, at {}", kinds, max_kinds,
                                               source.where()));
        }
        std::size_t before = 0;
        for (const SolutionSection& section : solution_.sections)
            if (section.keyword == keyword) before += section.fields.size();
        std::size_t components = 0;
        for (std::int64_t i = 0; i < kinds; ++i) {
            std::int64_t kind = 0;
            if (!source.small(kind) || kind < 1 || kind > 4) {
                return broken(keyword, fmt::format("field {} is of kind {}, but 1 to 4 are the rule, at {}", i + 1,
                                                   kind, source.where()));
            }
            const std::size_t of_kind[] = {1, dimension_, dimension_ * (dimension_ + 1) / 2, dimension_ * dimension_};
            const std::size_t number = before + static_cast<std::size_t>(i);
            SolutionField field;
            field.info = {number == 0 ? "sol" : fmt::format("sol_{}", number), association_of(keyword),
                          scalar_type_of<Real>(), of_kind[kind - 1]};
            field.wanted = options_ && wanted(*options_, field.info.association, field.info.name);
            components += field.info.components;
            open_.fields.push_back(std::move(field));
        }
        const std::uint64_t most = components ? source.records_left(0, components) : 0;
        if (count < 0 || (components > 0 && static_cast<std::uint64_t>(count) > most)) {
            return broken(keyword, fmt::format("states {} entries, but there is room for {} at most", count, most));
        }
        open_.count = static_cast<std::uint64_t>(count);
        return components && options_ ? read_values<Real>(source) : Result<void>();
    }

    /// Values of fields that are not wanted are skipped.
    template <class Real, class Source>
    Result<void> read_values(Source& source) {
        std::vector<std::vector<Real>> values(open_.fields.size());
        for (std::size_t f = 0; f < values.size(); ++f)
            if (open_.fields[f].wanted)
                values[f].reserve(static_cast<std::size_t>(open_.count) * open_.fields[f].info.components);
        for (std::uint64_t i = 0; i < open_.count; ++i) {
            for (std::size_t f = 0; f < values.size(); ++f) {
                for (std::size_t c = 0; c < open_.fields[f].info.components; ++c) {
                    double value = 0;
                    if (!source.real(value)) return missing(open_.keyword, open_.count, i, source);
                    if (open_.fields[f].wanted) values[f].push_back(static_cast<Real>(value));
                }
            }
            if (!pace_.goes_on(source.position())) return Pace::cancelled();
        }
        for (std::size_t f = 0; f < values.size(); ++f) {
            const std::size_t components = open_.fields[f].info.components;
            if (components == 6) order_as_vtk(values[f], order_of_lower_rows);
            if (dimension_ == 2 && components == 3) // XX XY YY
                for (std::size_t i = 0; i < values[f].size(); i += 3) std::swap(values[f][i + 1], values[f][i + 2]);
            if (open_.fields[f].wanted) open_.fields[f].values = Array::own(std::move(values[f]), components);
        }
        return {};
    }

    void leave_out_section(std::string_view name, const char* reason) {
        solution_.left_out.push_back({"section", std::string(name.substr(0, 40)), reason});
    }

    const ReadOptions* options_;
    Pace pace_;
    std::size_t dimension_ = 0;
    SolutionSection open_;
    Solution solution_;
};

/// Where the cells are that a section has values for; those of higher order where there are no others.
std::vector<CellRun> runs_of(const SolutionSection& section, std::span<const CellRun> runs) {
    const SolutionKind& kind = *solution_kind(section.keyword);
    std::vector<CellRun> own, higher;
    for (const CellRun& run : runs) {
        if (run.keyword == kind.of) own.push_back(run);
        if (run.keyword == kind.of_higher_order) higher.push_back(run);
    }
    return own.empty() ? higher : own;
}

std::uint64_t cells_in(std::span<const CellRun> runs) {
    std::uint64_t count = 0;
    for (const CellRun& run : runs) count += run.count;
    return count;
}

/// Copies values, one tuple a cell, to the places of the cells.
template <class Real>
void scatter(const Array& values, std::span<const CellRun> runs, std::vector<Real>& to) {
    const auto from = values.as<Real>();
    const std::size_t components = values.components();
    std::size_t next = 0;
    for (const CellRun& run : runs) {
        const std::size_t count = static_cast<std::size_t>(run.count) * components;
        std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(next), count,
                    to.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(run.first) * components));
        next += count;
    }
}

/// The cell field of one name, of all sections that have a part of it.
template <class Real>
Array cell_values(const FieldInfo& info, const std::vector<std::pair<const Array*, std::vector<CellRun>>>& parts,
                  std::size_t cells) {
    std::vector<Real> values(cells * info.components, std::numeric_limits<Real>::quiet_NaN());
    for (const auto& [part, runs] : parts) scatter(*part, runs, values);
    return Array::own(std::move(values), info.components);
}

} // namespace

Result<Solution> read_solution(std::string_view bytes, const ReadOptions* options, const Progress& progress) {
    SolutionReader reader(bytes, options, progress);
    SectionVisitor visitor;
    visitor.skips = [&](std::int32_t keyword) { return reader.skips(keyword); };
    visitor.unknown = [&](std::string_view name) { reader.unknown(name); };
    visitor.headers_only = !reader.reads_values();
    visitor.text = [&](std::int32_t keyword, TextSource& source) { return reader.section(keyword, source); };
    visitor.binary = [&](std::int32_t keyword, BinarySource& source) { return reader.section(keyword, source); };
    const auto whole = visit_sections(bytes, visitor);
    if (!whole && whole.error().code != ErrorCode::invalid_data) return whole.error();
    if (!whole) reader.leave_out_rest(whole.error());
    Solution solution = reader.take();
    solution.whole = !whole || *whole;
    if (whole && !*whole && solution.sections.empty() && solution.left_out.empty())
        solution.left_out.push_back(
            {"point field", "sol", "the .sol file beside it is cut short: it has neither SolAtVertices nor End"});
    return solution;
}

void give_solution(Solution solution, std::span<const CellRun> runs, ReadResult& result) {
    Grid& grid = result.grid;
    std::vector<FieldInfo> announced;
    std::swap(announced, result.info.fields);
    const auto does_not_fit = [&](const SolutionSection& section, const FieldInfo& info, std::uint64_t needed) {
        const std::string_view of =
            section.keyword == sol_at_vertices ? "vertices" : name_of_keyword(solution_kind(section.keyword)->of);
        leave_out(result.info, {what_of(info.association), info.name,
                                fmt::format("the .sol file beside it has values for {} {}, but there are {}",
                                            section.count, of, needed)});
    };
    for (const FieldInfo& info : announced) {
        std::vector<std::pair<const Array*, std::vector<CellRun>>> parts;
        bool is_solution = false, is_wanted = false, fits = false;
        for (const SolutionSection& section : solution.sections)
            for (const SolutionField& field : section.fields) {
                if (field.info.name != info.name || field.info.association != info.association) continue;
                is_solution = true;
                is_wanted = field.wanted;
                const bool point = info.association == Association::point;
                auto own = point ? std::vector<CellRun>{{0, 0, grid.points.tuples()}} : runs_of(section, runs);
                if (cells_in(own) != section.count) {
                    does_not_fit(section, info, cells_in(own));
                } else if (field.info.components != info.components) {
                    leave_out(result.info,
                              {what_of(info.association), info.name,
                               fmt::format("{} has {} components, but another section has {}",
                                           name_of_keyword(section.keyword), field.info.components, info.components)});
                } else {
                    fits = true;
                    parts.emplace_back(&field.values, std::move(own));
                }
            }
        if (is_solution && !fits) continue;
        result.info.fields.push_back(info);
        if (!is_solution || !is_wanted) continue;
        const bool point = info.association == Association::point;
        const std::size_t tuples = point ? grid.points.tuples() : grid.cells.count();
        Array values = point ? *parts.front().first
                             : (info.type == ScalarType::float32 ? cell_values<float>(info, parts, tuples)
                                                                 : cell_values<double>(info, parts, tuples));
        auto& fields = point ? grid.point_fields : grid.cell_fields;
        // Before the references, as they are announced.
        fields.insert(fields.end() - (fields.empty() || fields.back().name != "medit:ref" ? 0 : 1),
                      {info.name, std::move(values)});
    }
}

} // namespace isotet::io::medit
