// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/ensight/ensight_check.hpp"

#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "io/confined/ensight/ensight_walk.hpp"
#include "io/confined/mapped_file.hpp"
#include "io/files/escape.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {
namespace {

MappedFile opened(const std::string& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored))
        throw EnsightError({ErrorCode::file, fmt::format("{}: there is no such file", escaped(path))});
    auto file = MappedFile::open(path);
    if (!file) throw EnsightError(file.error());
    if (file->bytes().empty()) throw EnsightError(broken(path, "the file is empty"));
    return *std::move(file);
}

/// The form of a geometry, as VTK's reader finds it: "C Binary" and "Fortran Binary".
EnsightForm form_of(std::string_view bytes, bool is_gold) {
    const bool fortran = is_fortran(bytes);
    const std::string_view line = bytes.substr(fortran ? 4 : 0, 80);
    const auto words = words_of(line.substr(0, line.find('\n')));
    const bool binary =
        words.size() > 1 && (words[1].starts_with("Binary") || (is_gold && words[1].starts_with("binary")));
    return binary ? (fortran ? EnsightForm::fortran : EnsightForm::c) : EnsightForm::ascii;
}

class EnsightCheck {
public:
    EnsightCheck(const std::string& path, const EnsightCase& from, std::size_t step)
        : path_(path), case_(from), time_(from, step) {}

    EnsightFound run(const std::vector<bool>& wanted) {
        walk_geometry();
        for (std::size_t i = 0; i < case_.variables.size(); ++i) {
            EnsightFound::Variable& found = found_.variables.emplace_back();
            if (!wanted[i]) continue;
            try {
                walk_all_files(i, found);
            } catch (const EnsightError& error) {
                found.problem = error.error().message;
            }
        }
        found_.is_big_endian = order_ == EnsightOrder::big;
        return std::move(found_);
    }

private:
    [[noreturn]] void refuse(const std::string& what) const { throw EnsightError(broken(path_, what)); }

    std::optional<EnsightPlace> placed(const EnsightTime::Found& found, const std::string& name) const {
        if (!found.error.empty()) refuse(fmt::format("{}, which {} needs", found.error, name));
        return found.place;
    }
    std::string beside(const std::string& name) const {
        return (std::filesystem::path(path_).parent_path() / name).string();
    }

    void walk_all_files(std::size_t at, EnsightFound::Variable& found) {
        const EnsightCase::Variable& variable = case_.variables[at];
        if (variable.is_measured) refuse("it is a variable of measured points, which have no cells");
        if (!case_.is_gold && variable.components > 6) refuse("EnSight 6 has no tensors of 9 components");
        for (const EnsightCase::File& file : variable.files) {
            if (auto place = walk_variable(variable, file)) found.places.push_back(*std::move(place));
        }
    }

    void walk_geometry() {
        const auto place = placed(time_.model(), case_.model.name);
        const std::string path = beside(place->name);
        const auto mapped = opened(path);
        const std::string_view bytes = mapped.text();
        found_.model = {path, place->step};
        form_ = form_of(bytes, case_.is_gold);
        if (form_ == EnsightForm::fortran && (!case_.is_gold || case_.has_file_sets))
            throw EnsightError(
                broken(path, case_.is_gold ? "VTK's reader does not read Fortran binary with a FILE section in the case"
                                           : "VTK's reader does not read EnSight 6 as Fortran binary"));
        if (!case_.is_gold && is_fortran(bytes))
            throw EnsightError(broken(path, "VTK's reader does not read EnSight 6 as Fortran binary"));
        EnsightFile file(path, bytes, form_);
        try {
            walk_geometry_in(file, place->step);
        } catch (const EnsightError&) {
            if (case_.is_gold || file.order() == EnsightOrder::unknown || !walk_in_other_order(file, place->step))
                throw;
        }
        found_.form = form_;
    }

    /// The count that told the byte order may be small enough in the other one, too.
    bool walk_in_other_order(const EnsightFile& tried, std::size_t step) {
        const bool was_big = tried.order() == EnsightOrder::big;
        EnsightFile file(tried.path(), tried.bytes(), form_, was_big ? EnsightOrder::little : EnsightOrder::big);
        try {
            walk_geometry_in(file, step);
        } catch (const EnsightError&) {
            return false;
        }
        return true;
    }

    void walk_geometry_in(EnsightFile& file, std::size_t step) {
        const bool binary = form_ != EnsightForm::ascii, in_step = case_.has_file_sets;
        bool is_first = true;
        const auto walk = [&](bool asked_for) {
            EnsightGrid grid = case_.is_gold ? walk_gold_geometry(file, in_step)
                               : binary      ? walk_6_binary_geometry(file, in_step)
                                             : walk_6_text_geometry(file, in_step);
            if (asked_for || is_first) grid_ = std::move(grid);
            is_first = false;
        };
        if (!in_step) {
            walk(true);
        } else {
            const OtherSteps other = !case_.is_gold || !binary ? OtherSteps::before
                                     : case_.model_names_sets  ? OtherSteps::all
                                                               : OtherSteps::all_or_only_one;
            const auto begins = walk_steps(file, step, other, walk);
            if (!case_.is_gold && binary && !grid_.ends_with_block()) expect_no_elements_behind(file);
            if (case_.is_gold) check_gold_index(file, step, begins);
        }
        order_ = file.order();
    }

    /// Nothing: there are no values at this time.
    std::optional<EnsightPlace> walk_variable(const EnsightCase::Variable& variable, const EnsightCase::File& from) {
        const auto place = placed(time_.file_of(from), from.name);
        if (!place) return std::nullopt;
        const std::string path = beside(place->name);
        const EnsightPlace found{path, place->step};
        const auto mapped = opened(path);
        const std::string_view bytes = mapped.text();
        const bool binary = form_ != EnsightForm::ascii;
        const EnsightForm form = !binary                              ? EnsightForm::ascii
                                 : case_.is_gold && is_fortran(bytes) ? EnsightForm::fortran
                                                                      : EnsightForm::c;
        EnsightFile file(path, bytes, form, order_);
        const auto walk = [&](bool asked_for) {
            if (case_.is_gold) walk_gold_variable(file, variable, grid_, asked_for);
            else if (binary) walk_6_binary_variable(file, variable, grid_, asked_for);
            else walk_6_text_variable(file, variable, grid_);
        };
        if (!case_.has_file_sets) {
            walk(true);
            expect_whole_last_line(file, 12);
            return found;
        }
        const auto begins = walk_steps(file, place->step, OtherSteps::before, walk);
        if (case_.is_gold) check_gold_index(file, place->step, begins);
        return found;
    }

    const std::string& path_;
    const EnsightCase& case_;
    EnsightTime time_;
    EnsightFound found_;
    EnsightGrid grid_;
    EnsightForm form_ = EnsightForm::ascii;
    EnsightOrder order_ = EnsightOrder::unknown;
};

} // namespace

Result<EnsightCase> read_case(const std::string& case_file) {
    const auto text = MappedFile::open(case_file);
    if (!text) return text.error();
    EnsightCase found = parse_case(text->text());
    if (!found.is_ensight) return broken(case_file, "it is no EnSight case: \"type: ensight\" is missing");
    if (!found.error.empty()) return broken(case_file, found.error);
    if (found.model.name.empty()) return broken(case_file, "it names no geometry: \"model:\" is missing");
    return found;
}

Result<EnsightFound> check_ensight(const std::string& case_file, const EnsightCase& found, std::size_t step,
                                   const std::vector<bool>& wanted) {
    try {
        return EnsightCheck(case_file, found, step).run(wanted);
    } catch (const EnsightError& error) {
        return error.error();
    }
}

} // namespace isotet::io::confined
