// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/ensight_check.hpp"

#include <filesystem>
#include <optional>

#include <fmt/core.h>

#include "io/own/loaded.hpp"
#include "io/vtk/ensight_walk.hpp"
#include "io/vtk/mapped_file.hpp"

namespace isotet::io::vtk {
namespace {

/// Nothing where it is not there: VTK's reader tells.
std::optional<MappedFile> opened(const std::string& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return std::nullopt;
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

    std::optional<EnsightBinary6> run() {
        if (!walk_geometry()) return std::nullopt;
        for (std::size_t i = 0; i < case_.variables.size(); ++i) {
            const EnsightCase::Variable& variable = case_.variables[i];
            if (case_.has_file_sets && !variable.files[0].file_set)
                refuse(
                    fmt::format("variable \"{}\" names no file set, which VTK's reader needs from every variable once "
                                "there is one",
                                variable.description));
            if (variable.is_complex && case_.has_time) expect_time_of_complex(variable, i);
            if (variable.is_measured || (!case_.is_gold && variable.components > 6)) continue;
            for (const EnsightCase::File& file : variable.files) walk_variable(variable, file);
        }
        if (case_.is_gold || form_ == EnsightForm::ascii) return std::nullopt;
        return EnsightBinary6{order_ == EnsightOrder::big};
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

    /// VTK's reader takes the time set of another variable.
    void expect_time_of_complex(const EnsightCase::Variable& variable, std::size_t at) const {
        std::size_t complex = 0;
        for (std::size_t i = 0; i < at; ++i) complex += case_.variables[i].is_complex ? 1 : 0;
        std::size_t real = 0;
        for (const auto& other : case_.variables)
            if (!other.is_complex && real++ == complex && other.files[0].time_set == variable.files[0].time_set &&
                !case_.has_file_sets)
                return;
        refuse(fmt::format("VTK's reader does not find the time of complex variable \"{}\"", variable.description));
    }

    bool walk_geometry() {
        const auto place = placed(time_.model(), case_.model.name);
        const std::string path = beside(place->name);
        const auto mapped = opened(path);
        if (!mapped) return false;
        const std::string_view bytes = mapped->text();
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
        return true;
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

    void walk_variable(const EnsightCase::Variable& variable, const EnsightCase::File& from) {
        const auto place = placed(time_.file_of(from), from.name);
        if (!place) return; // no values at this time
        const std::string path = beside(place->name);
        const auto mapped = opened(path);
        if (!mapped) return;
        const std::string_view bytes = mapped->text();
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
            return;
        }
        const auto begins = walk_steps(file, place->step, OtherSteps::before, walk);
        if (case_.is_gold) check_gold_index(file, place->step, begins);
    }

    const std::string& path_;
    const EnsightCase& case_;
    EnsightTime time_;
    EnsightGrid grid_;
    EnsightForm form_ = EnsightForm::ascii;
    EnsightOrder order_ = EnsightOrder::unknown;
};

} // namespace

Result<std::optional<EnsightBinary6>> check_ensight(const std::string& case_file, std::size_t step) {
    const auto text = MappedFile::open(case_file);
    if (!text) return text.error();
    const EnsightCase found = parse_case(text->text());
    if (!found.is_ensight) return std::optional<EnsightBinary6>(); // VTK's reader tells
    if (!found.error.empty()) return broken(case_file, found.error);
    if (found.model.name.empty()) return broken(case_file, "it names no geometry: \"model:\" is missing");
    try {
        return EnsightCheck(case_file, found, step).run();
    } catch (const EnsightError& error) {
        return error.error();
    }
}

} // namespace isotet::io::vtk
