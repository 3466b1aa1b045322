// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// EnSight Gold and 6, ascii and binary: a case file names the files of geometry and variables; parts are pieces.
#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include <fmt/core.h>

#include "io/confined/ensight/ensight_grid.hpp"
#include "io/confined/loaders.hpp"
#include "io/confined/mapped_file.hpp"
#include "io/confined/progress.hpp"
#include "io/files/escape.hpp"
#include "io/files/index_file.hpp"
#include "io/pieces/block_choice.hpp"
#include "io/reader.hpp"
#include "io/vtk_xml/load.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::size_t gold_integer_width = 10, width_in_6 = 8;

MappedFile opened(const std::string& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored))
        throw EnsightError({ErrorCode::file, fmt::format("{}: there is no such file", escaped(path))});
    auto file = MappedFile::open(path);
    if (!file) throw EnsightError(file.error());
    if (file->bytes().empty()) throw EnsightError(broken(path, "the file is empty"));
    return *std::move(file);
}

/// The fields of a variable: a complex scalar is one of two components, other complex ones are two fields.
std::vector<FieldInfo> fields_of(const EnsightCase::Variable& variable) {
    const Association association = variable.of_nodes ? Association::point : Association::cell;
    const auto field = [&](const std::string& name, std::size_t components) {
        return FieldInfo{name, association, ScalarType::float32, components};
    };
    if (!variable.is_complex) return {field(variable.description, variable.components)};
    if (variable.components == 1) return {field(variable.description, 2)};
    return {field(variable.description + "_r", variable.components),
            field(variable.description + "_i", variable.components)};
}

class EnsightLoad {
public:
    EnsightLoad(const std::string& path, const EnsightCase& from, const ReadOptions& options, Depth depth)
        : path_(path), case_(from), options_(options), depth_(depth) {}

    Result<Loaded> load();

private:
    bool go_to_step(EnsightFile& file, std::size_t step, bool may_have_one) const;
    EnsightGrid geometry_of(const std::string& path, std::string_view bytes, std::size_t step, std::size_t& reached);
    void read_geometry(const EnsightTime& time);
    Result<void> choose_parts();
    bool read_file(const EnsightTime& time, const EnsightCase::File& from, EnsightField& field) const;
    void read_variable(const EnsightTime& time, const EnsightCase::Variable& variable);
    void read_variables(const EnsightTime& time);
    void give_columns(const std::string& name, EnsightField field);
    Result<Piece> piece_of(EnsightPart& part);
    LeastCounts least() const;

    EnsightPlace placed(const EnsightTime::Found& found, const std::string& name) const {
        if (!found.error.empty())
            throw EnsightError(broken(path_, fmt::format("{}, which {} needs", found.error, name)));
        EnsightPlace place = found.place.value_or(EnsightPlace{});
        if (found.place) place.name = (std::filesystem::path(path_).parent_path() / place.name).string();
        return place;
    }

    const std::string& path_;
    const EnsightCase& case_;
    const ReadOptions& options_;
    Depth depth_;
    EnsightGrid grid_;
    EnsightForm form_ = EnsightForm::ascii;
    bool big_endian_ = false;
    std::vector<std::vector<Field>> point_fields_, cell_fields_; ///< of each part
    Loaded loaded_;
};

/// False where the file has no steps. `may_have_one`: for all times, or none.
bool EnsightLoad::go_to_step(EnsightFile& file, std::size_t step, bool may_have_one) const {
    const std::size_t begin = file.position();
    std::size_t steps = 0;
    while (steps < step && file.find_step("BEGIN TIME STEP")) ++steps;
    if (steps == step || (may_have_one && steps == 1)) return true;
    if (!may_have_one || steps > 1)
        file.wrong(fmt::format("step {} is to be read, but there are {} between BEGIN TIME STEP and END TIME STEP",
                               step, steps));
    file.seek(begin);
    return false;
}

/// `reached`   how far it came, also where it throws
EnsightGrid EnsightLoad::geometry_of(const std::string& path, std::string_view bytes, std::size_t step,
                                     std::size_t& reached) {
    EnsightFile file(path, bytes, form_, big_endian_, case_.is_gold ? gold_integer_width : width_in_6);
    file.keep(depth_ == Depth::arrays);
    EnsightGrid grid;
    try {
        const bool in_step = case_.has_file_sets && go_to_step(file, step, !case_.model_names_sets);
        if (case_.is_gold) read_gold_geometry(file, grid, in_step);
        else read_6_geometry(file, grid, in_step);
        if (grid.parts.empty()) file.missing("a part", 1);
        if (in_step) file.line("END TIME STEP");
        else file.expect_whole_last_line(case_.is_gold ? gold_integer_width : width_in_6);
    } catch (const EnsightError&) {
        reached = file.position();
        throw;
    }
    return grid;
}

/// C binary files do not tell their byte order: it is the one in which the geometry can be read.
void EnsightLoad::read_geometry(const EnsightTime& time) {
    const auto place = placed(time.model(), case_.model.name);
    const auto mapped = opened(place.name);
    form_ = ensight_form(mapped.text());
    std::size_t reached = 0, reached_as_big = 0;
    try {
        grid_ = geometry_of(place.name, mapped.text(), place.step, reached);
    } catch (const EnsightError& little) {
        if (form_ != EnsightForm::c) throw;
        big_endian_ = true;
        try {
            grid_ = geometry_of(place.name, mapped.text(), place.step, reached_as_big);
        } catch (const EnsightError& big) {
            throw reached_as_big > reached ? big : little;
        }
    }
}

/// Of structured parts none: their cells are made.
LeastCounts EnsightLoad::least() const {
    LeastCounts least;
    least.all_cells = true;
    for (const EnsightPart& part : grid_.parts) {
        if (case_.is_gold || part.is_structured) least.points += part.nodes;
        if (part.is_structured) continue;
        least.cells += part.cells;
        for (const auto& [type, runs] : part.elements)
            if (const EnsightElement* const element = ensight_element(type))
                least.corners += count_of(runs) * std::max<std::uint64_t>(element->nodes, 1);
    }
    return least;
}

Result<void> EnsightLoad::choose_parts() {
    for (const EnsightPart& part : grid_.parts) {
        BlockInfo& block = loaded_.info.blocks.emplace_back();
        block.number = static_cast<std::int64_t>(loaded_.info.blocks.size());
        block.name = part.name;
        block.kind = "part";
        block.cells = part.cells;
    }
    const auto chosen = chosen_blocks(loaded_.info.blocks, options_);
    if (!chosen) return chosen.error();
    for (std::size_t i = 0; i < grid_.parts.size(); ++i)
        grid_.parts[i].is_wanted = depth_ == Depth::arrays && (*chosen)[i];
    return {};
}

/// False where there are no values at this time.
bool EnsightLoad::read_file(const EnsightTime& time, const EnsightCase::File& from, EnsightField& field) const {
    const auto place = placed(time.file_of(from), from.name);
    if (place.name.empty()) return false;
    const auto mapped = opened(place.name);
    const EnsightForm binary = has_fortran_records(mapped.text()) ? EnsightForm::fortran : EnsightForm::c;
    EnsightFile file(place.name, mapped.text(), form_ == EnsightForm::ascii ? form_ : binary, big_endian_,
                     case_.is_gold ? gold_integer_width : width_in_6);
    const bool in_step = case_.has_file_sets && go_to_step(file, place.step, false);
    const auto description = case_.is_gold ? file.line("its description") : file.raw_line("its description");
    if (description.starts_with("BEGIN TIME STEP")) file.wrong("it has time steps, but the case has no FILE section");
    file.keep(depth_ == Depth::arrays);
    if (case_.is_gold) read_gold_values(file, grid_, field);
    else read_6_values(file, grid_, field);
    if (in_step) file.line("END TIME STEP");
    else file.expect_whole_last_line(12);
    return true;
}

void EnsightLoad::give_columns(const std::string& name, EnsightField field) {
    const bool of_nodes = field.variable.of_nodes;
    const Array shared = Array::own(std::move(field.columns.back()), field.width);
    for (std::size_t i = 0; i < grid_.parts.size(); ++i) {
        const EnsightPart& part = grid_.parts[i];
        Array values = !case_.is_gold && of_nodes && !part.is_structured
                           ? shared
                           : Array::own(std::move(field.columns[i]), field.width);
        if (!values.empty()) (of_nodes ? point_fields_ : cell_fields_)[i].push_back({name, std::move(values)});
    }
}

void EnsightLoad::read_variable(const EnsightTime& time, const EnsightCase::Variable& variable) {
    if (variable.is_measured)
        throw EnsightError(broken(path_, "it is a variable of measured points, which have no cells"));
    const std::vector<FieldInfo> fields = fields_of(variable);
    std::vector<EnsightField> made;
    for (std::size_t i = 0; i < variable.files.size(); ++i) {
        if (i < fields.size())
            made.push_back({variable, fields[i].components, 0, EnsightColumns(grid_.parts.size() + 1)});
        else made.back().column = i;
        if (!read_file(time, variable.files[i], made.back())) return;
    }
    for (std::size_t i = 0; i < made.size(); ++i) give_columns(fields[i].name, std::move(made[i]));
}

void EnsightLoad::read_variables(const EnsightTime& time) {
    point_fields_.resize(grid_.parts.size());
    cell_fields_.resize(grid_.parts.size());
    std::set<std::pair<Association, std::string>> known;
    double done = 0;
    for (const EnsightCase::Variable& variable : case_.variables) {
        report_progress(++done / static_cast<double>(case_.variables.size() + 1));
        const std::vector<FieldInfo> fields = fields_of(variable);
        if (!known.emplace(fields[0].association, fields[0].name).second) {
            leave_out(loaded_.info, {"variable", fields[0].name, "the case names another one like this before"});
            continue;
        }
        const bool is_wanted = std::ranges::any_of(
            fields, [&](const FieldInfo& field) { return wanted(options_, field.association, field.name); });
        try {
            if (is_wanted || depth_ == Depth::description) read_variable(time, variable);
            for (const FieldInfo& field : fields) announce(loaded_.info, field);
        } catch (const EnsightError& error) {
            for (const FieldInfo& field : fields)
                leave_out(loaded_.info,
                          {variable.of_nodes ? "point field" : "cell field", field.name, error.error().message});
        }
    }
}

/// A line of nodes has no cells.
Result<Piece> EnsightLoad::piece_of(EnsightPart& part) {
    const std::size_t place = static_cast<std::size_t>(&part - grid_.parts.data());
    Piece piece;
    piece.name = part.name;
    piece.grid.points = case_.is_gold || part.is_structured ? part.points : grid_.points;
    if (piece.grid.points.empty()) piece.grid.points = Array(ScalarType::float32, nullptr, 0, 3, nullptr);
    piece.grid.point_fields = std::move(point_fields_[place]);
    if (part.is_structured) {
        auto cells = vtk_xml::cells_of_box({part.size[0], part.size[1], part.size[2]}, loaded_.notes);
        if (!cells) return cells.error();
        piece.grid.cells = *std::move(cells);
    } else {
        piece.grid.cells = std::move(part.made).take();
    }
    if (part.is_structured && piece.grid.cells.count() == 0) return piece;
    piece.left_out = std::move(part.left_out);
    piece.grid.cell_fields = std::move(cell_fields_[place]);
    return piece;
}

Result<Loaded> EnsightLoad::load() {
    loaded_.info.times = times_of(case_);
    for (const LeftOut& item : case_.left_out) leave_out(loaded_.info, item);
    const auto step = choose_step(loaded_.info, options_);
    if (!step) return step.error();
    loaded_.step = *step;
    const EnsightTime time(case_, *step);
    read_geometry(time);
    if (auto chosen = choose_parts(); !chosen) return chosen.error();
    if (depth_ == Depth::description) loaded_.info.least = least();
    read_variables(time);
    for (EnsightPart& part : grid_.parts) {
        if (!part.is_wanted) continue;
        auto piece = piece_of(part);
        if (!piece) return piece.error();
        loaded_.pieces.push_back(*std::move(piece));
    }
    return std::move(loaded_);
}

/// Lists of a time set may stand in files of their own.
Result<void> read_lists(const std::string& case_file, bool allow_outside, EnsightCase& found) {
    const auto take = [&](const std::string& name, auto* take_list, EnsightCase::TimeSet& set) -> Result<void> {
        if (name.empty()) return {};
        const auto path = named_file(case_file, name, allow_outside);
        if (!path) return path.error();
        const auto text = MappedFile::open(*path);
        if (!text) return text.error();
        take_list(set, text->text());
        return {};
    };
    for (EnsightCase::TimeSet& set : found.time_sets) {
        if (auto taken = take(set.numbers_file, take_file_numbers, set); !taken) return taken;
        if (auto taken = take(set.values_file, take_time_values, set); !taken) return taken;
    }
    return {};
}

Result<EnsightCase> read_case(const std::string& case_file, bool allow_outside) {
    const auto text = MappedFile::open(case_file);
    if (!text) return text.error();
    EnsightCase found = parse_case(text->text());
    if (!found.is_ensight) return broken(case_file, "it is no EnSight case: \"type: ensight\" is missing");
    if (!found.error.empty()) return broken(case_file, found.error);
    if (found.model.name.empty()) return broken(case_file, "it names no geometry: \"model:\" is missing");
    if (auto read = read_lists(case_file, allow_outside, found); !read) return read.error();
    return found;
}

Result<void> check_names(const std::string& path, const EnsightCase& found, bool allow_outside) {
    if (auto allowed = check_name(path, found.model.name, allow_outside); !allowed) return allowed;
    for (const EnsightCase::Variable& variable : found.variables)
        for (const EnsightCase::File& file : variable.files)
            if (auto allowed = check_name(path, file.name, allow_outside); !allowed) return allowed;
    return {};
}

} // namespace

Result<Loaded> load_ensight(const std::string& path, const ReadOptions& options, Depth depth) {
    const auto found = read_case(path, options.allow_outside);
    if (!found) return found.error();
    if (auto allowed = check_names(path, *found, options.allow_outside); !allowed) return allowed.error();
    try {
        return EnsightLoad(path, *found, options, depth).load();
    } catch (const EnsightError& error) {
        return error.error();
    }
}

} // namespace isotet::io::confined
