// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/ensight/ensight_case.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "io/confined/ensight/ensight_file.hpp"
#include "io/files/text_scanner.hpp"

namespace isotet::io::confined {
namespace {

using Words = std::vector<std::string_view>;

std::optional<std::int64_t> integer_at(const Words& words, std::size_t at) {
    std::int32_t value = 0;
    if (at >= words.size() || !parse_number(words[at], value)) return std::nullopt;
    return value;
}

/// "1 2 rest", "1 rest" or "rest": the sets of a file, taken off the line.
void take_sets(std::string_view& line, EnsightCase::File& file) {
    const Words words = words_of(line);
    const auto first = integer_at(words, 0);
    if (!first || words.size() < 2) return;
    const auto second = integer_at(words, 1);
    const bool has_both = second && words.size() > 2;
    file.time_set = *first;
    if (has_both) file.file_set = *second;
    const std::string_view last = words[has_both ? 1 : 0];
    line.remove_prefix(static_cast<std::size_t>(last.data() + last.size() - line.data()));
}

std::string_view without_outer_spaces(std::string_view text) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    return text;
}

/// Takes what stands in quotes off the end of a line, or else its last word.
std::string take_last_name(std::string_view& line) {
    line = without_outer_spaces(line);
    std::string name;
    if (line.size() > 1 && (line.back() == '"' || line.back() == '\'')) {
        const char quote = line.back();
        const auto begin = line.find_last_of(quote, line.size() - 2);
        if (begin != std::string_view::npos) {
            name = line.substr(begin + 1, line.size() - begin - 2);
            line = without_outer_spaces(line.substr(0, begin));
            return name;
        }
    }
    const auto begin = line.find_last_of(" \t");
    name = line.substr(begin == std::string_view::npos ? 0 : begin + 1);
    line = begin == std::string_view::npos ? std::string_view() : without_outer_spaces(line.substr(0, begin));
    return name;
}

/// The name of a variable, without the quotes around it.
std::string unquoted(std::string_view name) {
    name = without_outer_spaces(name);
    if (name.size() > 1 && name.front() == name.back() && (name.front() == '"' || name.front() == '\''))
        name = name.substr(1, name.size() - 2);
    return std::string(name);
}

/// By what stands before the colon; nothing where it is no kind that is known.
std::optional<EnsightCase::Variable> variable_of(std::string_view key) {
    struct Kind {
        std::string_view name;
        std::size_t components;
    };
    constexpr std::array kinds{Kind{"scalar", 1},      Kind{"vector", 3},      Kind{"tensor", 6},
                               Kind{"tensor symm", 6}, Kind{"tensor asym", 9}, Kind{"tensor asymm", 9}};
    EnsightCase::Variable variable;
    constexpr std::string_view between = " per ";
    const auto per = key.find(between);
    if (per == std::string_view::npos) return std::nullopt;
    std::string_view kind = key.substr(0, per);
    const std::string_view place = key.substr(per + between.size());
    variable.is_complex = kind.starts_with("complex ");
    if (variable.is_complex) kind.remove_prefix(8);
    const auto* const found = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& k) { return k.name == kind; });
    if (found == kinds.end()) return std::nullopt;
    variable.components = found->components;
    variable.is_measured = place == "measured node";
    variable.of_nodes = place == "node" || variable.is_measured;
    if (!variable.of_nodes && place != "element") return std::nullopt;
    return variable;
}

/// Takes its name and files; false where they are not there.
bool take_files(EnsightCase::Variable& variable, std::string_view rest) {
    EnsightCase::File file;
    take_sets(rest, file);
    if (variable.is_complex) { // the files of both parts, then a frequency
        const Words words = words_of(rest);
        if (words.size() < 3) return false;
        for (const std::size_t i : {1, 2}) {
            file.name = words[i];
            variable.files.push_back(file);
        }
        variable.description = words[0];
        return true;
    }
    file.name = take_last_name(rest);
    variable.files.push_back(file);
    variable.description = unquoted(rest);
    return !variable.description.empty() && !file.name.empty();
}

/// The words before the colon with a space between them.
std::string key_of(std::string_view line, std::size_t colon) {
    if (colon == std::string_view::npos) return {};
    return fmt::format("{}", fmt::join(words_of(line.substr(0, colon)), " "));
}

Words words_of_lines(std::string_view text) {
    Words words;
    TextScanner scanner(without_byte_order_mark(text));
    for (auto word = scanner.word(); !word.empty(); word = scanner.word()) words.push_back(word);
    return words;
}

void keep_steps(EnsightCase::TimeSet& set) {
    set.numbers.resize(std::min<std::size_t>(set.numbers.size(), set.steps));
    set.values.resize(std::min<std::size_t>(set.values.size(), set.steps));
}

void add_file_numbers(EnsightCase::TimeSet& set, const Words& words) {
    std::int32_t number = 0;
    for (const std::string_view word : words)
        if (parse_number(word, number)) set.numbers.push_back(number);
}

void add_time_values(EnsightCase::TimeSet& set, const Words& words) {
    double value = 0;
    for (const std::string_view word : words)
        if (parse_number(word, value)) set.values.push_back(value);
}

std::string in_lower_case(std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower;
}

/// Sections of the format that are not read, and those that are not known: words in capitals.
bool begins_other_section(std::string_view line) {
    return std::ranges::all_of(line, [](char c) { return (c >= 'A' && c <= 'Z') || c == ' ' || c == '_'; });
}

class CaseParser {
public:
    EnsightCase parse(std::string_view text) {
        while (!text.empty()) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            std::string_view line = text.substr(0, end);
            text.remove_prefix(std::min(end + 1, text.size()));
            line = without_outer_spaces(line);
            if (!line.empty() && line[0] != '#') take(line);
        }
        for (auto& set : found_.time_sets) keep_steps(set);
        return std::move(found_);
    }

private:
    enum class List : std::uint8_t { none, numbers, values };
    enum class Section : std::uint8_t { none, format, geometry, variable, time, file, other };

    /// True for the first line of a section.
    bool begin_section(std::string_view line) {
        struct Name {
            std::string_view word;
            Section section;
        };
        for (const Name& name :
             {Name{"FORMAT", Section::format}, Name{"GEOMETRY", Section::geometry}, Name{"VARIABLE", Section::variable},
              Name{"TIME", Section::time}, Name{"FILE", Section::file}})
            if (line == name.word || in_lower_case(line) == in_lower_case(name.word) ||
                (line.starts_with(name.word) && is_space(line[name.word.size()]))) {
                section_ = name.section;
                return true;
            }
        if (!begins_other_section(line)) return false;
        section_ = Section::other;
        found_.left_out.push_back({"section", std::string(line), "its content is not read"});
        return true;
    }

    void refuse(std::string_view line, std::string_view expected) {
        if (found_.error.empty())
            found_.error = fmt::format("{} stands where {} was expected", in_quotes(line), expected);
    }

    void take(std::string_view line) {
        if (begin_section(line)) {
            list_ = List::none;
            found_.has_time = found_.has_time || section_ == Section::time;
            found_.has_file_sets = found_.has_file_sets || section_ == Section::file;
            return;
        }
        const auto colon = line.find(':');
        const std::string key = key_of(line, colon);
        const std::string_view rest = line.substr(colon == std::string_view::npos ? 0 : colon + 1);
        const Words words = words_of(rest);
        if (colon != std::string_view::npos) list_ = List::none;
        switch (section_) {
        case Section::none: return refuse(line, "FORMAT");
        case Section::format:
            if (found_.is_ensight) return refuse(line, "GEOMETRY");
            found_.is_ensight = true;
            found_.is_gold = words.size() > 1 && in_lower_case(words[1]) == "gold";
            if (key != "type" || words.empty() || in_lower_case(words[0]) != "ensight" ||
                (words.size() > 1 && !found_.is_gold))
                refuse(line, "\"type: ensight\" or \"type: ensight gold\"");
            return;
        case Section::geometry:
            if (key == "model") return take_model(rest);
            if (!line.starts_with('m') && key != "boundary" && key != "rigid_body") refuse(line, "model:");
            return;
        case Section::variable:
            if (line.starts_with("constant"))
                found_.left_out.push_back({"variable", std::string(line), "it is a constant, no field"});
            else if (auto variable = variable_of(key)) {
                if (take_files(*variable, rest)) found_.variables.push_back(*std::move(variable));
                else found_.left_out.push_back({"variable", std::string(line), "a name and a file are not there"});
            } else if (key.empty()) refuse(line, "a variable");
            else found_.left_out.push_back({"variable", std::string(line), "no kind of variable that is known"});
            return;
        case Section::file: return take_file_set(key, words);
        case Section::other: return;
        case Section::time: take_time_set(key, rest, words);
        }
        if (list_ == List::numbers) add_file_numbers(found_.time_sets.back(), words);
        if (list_ == List::values) add_time_values(found_.time_sets.back(), words);
    }

    void take_model(std::string_view rest) {
        const std::string_view whole = rest;
        take_sets(rest, found_.model);
        found_.model_names_sets = rest.size() < whole.size();
        if (const auto change = rest.rfind("change_coords_only"); change != std::string_view::npos)
            rest = rest.substr(0, change);
        else if (const auto parts = rest.rfind("changing_geometry_per_part"); parts != std::string_view::npos)
            rest = rest.substr(0, parts);
        found_.model.name = take_last_name(rest);
    }

    void take_time_set(std::string_view key, std::string_view rest, const Words& words) {
        const auto number = integer_at(words, 0);
        if (key == "time set") found_.time_sets.emplace_back().id = number.value_or(0);
        if (found_.time_sets.empty()) return;
        EnsightCase::TimeSet& set = found_.time_sets.back();
        if (key == "number of steps")
            set.steps = static_cast<std::uint64_t>(std::max<std::int64_t>(number.value_or(0), 0));
        else if (key == "filename start number") set.first_number = number;
        else if (key == "filename increment") set.increment = number.value_or(0);
        else if (key == "filename numbers") list_ = List::numbers;
        else if (key == "time values") list_ = List::values;
        else if (key == "filename numbers file") set.numbers_file = take_last_name(rest);
        else if (key == "time values file") set.values_file = take_last_name(rest);
    }

    void take_file_set(std::string_view key, const Words& words) {
        const auto number = integer_at(words, 0);
        if (key == "file set") found_.file_sets.emplace_back().id = number.value_or(0);
        if (found_.file_sets.empty()) return;
        EnsightCase::FileSet& set = found_.file_sets.back();
        if (key == "filename index") set.numbers.push_back(number.value_or(0));
        if (key == "number of steps")
            set.steps.push_back(static_cast<std::uint64_t>(std::max<std::int64_t>(number.value_or(0), 0)));
    }

    EnsightCase found_;
    Section section_ = Section::none;
    List list_ = List::none;
};

std::string with_number(std::string name, std::int64_t number) {
    const auto first = name.find('*');
    if (first == std::string::npos) return name;
    const auto stars = std::min(name.find_first_not_of('*', first), name.size()) - first;
    return name.replace(first, stars, fmt::format("{:0{}}", number, stars));
}

std::optional<std::int64_t> number_of_file(const EnsightCase::TimeSet& set, std::size_t step) {
    if (set.first_number) return *set.first_number + static_cast<std::int64_t>(step - 1) * set.increment;
    if (step <= set.numbers.size()) return set.numbers[step - 1];
    return std::nullopt;
}

/// The place, from 1, of the last time of the set that is not behind `time`; 0: all are. Times may be listed in any order.
std::size_t step_at(const EnsightCase::TimeSet& set, double time) {
    std::size_t step = 0;
    for (std::size_t i = 0; i < set.values.size(); ++i)
        if (set.values[i] <= time && (step == 0 || set.values[i] >= set.values[step - 1])) step = i + 1;
    return step;
}

template <class Sets>
auto with_id(const Sets& sets, std::int64_t id) {
    return std::find_if(sets.begin(), sets.end(), [&](const auto& set) { return set.id == id; });
}

} // namespace

EnsightCase parse_case(std::string_view text) { return CaseParser().parse(without_byte_order_mark(text)); }

void take_file_numbers(EnsightCase::TimeSet& set, std::string_view text) {
    add_file_numbers(set, words_of_lines(text));
    keep_steps(set);
}

void take_time_values(EnsightCase::TimeSet& set, std::string_view text) {
    add_time_values(set, words_of_lines(text));
    keep_steps(set);
}

std::vector<double> times_of(const EnsightCase& found) {
    std::vector<double> all;
    for (const auto& set : found.time_sets) all.insert(all.end(), set.values.begin(), set.values.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

EnsightTime::EnsightTime(const EnsightCase& from, std::size_t step) : case_(from) {
    const std::vector<double> all = times_of(case_);
    if (!all.empty()) time_ = all[std::min(step, all.size() - 1)];
    const auto set = with_id(case_.time_sets, case_.model.time_set);
    if (set == case_.time_sets.end() || set->values.empty()) return;
    model_step_ = step_at(*set, time_);
    if (model_step_ == 0)
        model_step_ = static_cast<std::size_t>(std::ranges::min_element(set->values) - set->values.begin()) + 1;
    model_time_ = set->values[model_step_ - 1];
}

EnsightTime::Found EnsightTime::model() const {
    const auto set = with_id(case_.time_sets, case_.model.time_set);
    if (!case_.has_time || set == case_.time_sets.end()) return {EnsightPlace{case_.model.name, 1}, {}};
    return place_of(case_.model, model_step_, *set);
}

EnsightTime::Found EnsightTime::file_of(const EnsightCase::File& file) const {
    if (!case_.has_time) return {EnsightPlace{file.name, 1}, {}};
    const auto set = with_id(case_.time_sets, file.time_set);
    if (set == case_.time_sets.end()) return {{}, fmt::format("there is no time set {}", file.time_set)};
    const std::size_t step = step_at(*set, time_);
    if (step == 0 || set->values[step - 1] < model_time_) return {};
    return place_of(file, step, *set);
}

EnsightTime::Found EnsightTime::place_of(const EnsightCase::File& file, std::size_t step,
                                         const EnsightCase::TimeSet& times) const {
    EnsightPlace place{file.name, 1};
    if (!case_.has_file_sets) {
        if (const auto number = number_of_file(times, step)) place.name = with_number(file.name, *number);
        return {place, {}};
    }
    const std::int64_t id = file.file_set.value_or(case_.file_sets.empty() ? 1 : case_.file_sets.front().id);
    const auto set = with_id(case_.file_sets, id);
    if (set == case_.file_sets.end()) return {{}, fmt::format("there is no file set {}", id)};
    std::size_t index = 0;
    place.step = step;
    while (index + 1 < set->steps.size() && place.step > set->steps[index]) place.step -= set->steps[index++];
    if (index >= set->steps.size() || place.step > set->steps[index])
        return {{}, fmt::format("file set {} has no step {}", set->id, step)};
    if (!set->numbers.empty()) {
        if (index >= set->numbers.size()) return {{}, fmt::format("file set {} has no file {}", set->id, index + 1)};
        place.name = with_number(file.name, set->numbers[index]);
    }
    return {place, {}};
}

} // namespace isotet::io::confined
