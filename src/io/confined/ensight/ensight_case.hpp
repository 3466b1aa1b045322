// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What an EnSight case file says of its other files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/read.hpp>

namespace isotet::io::confined {

struct EnsightCase {
    /// A file and the sets it follows. In its name stars stand for the digits of a step or file.
    struct File {
        std::string name;
        std::int64_t time_set = 1;
        std::optional<std::int64_t> file_set; ///< none: not said
    };
    struct Variable {
        std::string description;
        std::vector<File> files; ///< two of complex variables
        std::size_t components = 1;
        bool of_nodes = true, is_measured = false, is_complex = false;
    };
    struct TimeSet {
        std::int64_t id = 1;
        std::uint64_t steps = 0;
        std::optional<std::int64_t> first_number; ///< of files; the next ones are `increment` apart
        std::int64_t increment = 1;
        std::vector<std::int64_t> numbers;        ///< of files, instead
        std::vector<double> values;
        std::string numbers_file, values_file;    ///< where these lists stand instead
    };
    /// Files that have several steps each.
    struct FileSet {
        std::int64_t id = 1;
        std::vector<std::int64_t> numbers;        ///< of files; empty: there is one, whose name has no stars
        std::vector<std::uint64_t> steps;         ///< of each file
    };
    std::string error; ///< a line that stands where it may not; empty: none
    std::vector<LeftOut> left_out; ///< sections and variables that are not read
    bool is_ensight = false, is_gold = false, has_time = false, has_file_sets = false;
    File model;
    bool model_names_sets = false;
    std::vector<Variable> variables;
    std::vector<TimeSet> time_sets;
    std::vector<FileSet> file_sets;
};

/// Empty lines, comments and blanks at the ends of lines are left out. A file name is the last word, or what stands
/// in quotes at the end of the line; the name of a variable is all before it.
EnsightCase parse_case(std::string_view text);

/// Takes the list of a file that a time set names.
void take_file_numbers(EnsightCase::TimeSet& set, std::string_view text);
void take_time_values(EnsightCase::TimeSet& set, std::string_view text);

/// The times of all time sets, ascending, each once.
std::vector<double> times_of(const EnsightCase& found);

/// Where the values of a step are.
struct EnsightPlace {
    std::string name;      ///< of a file
    std::size_t step = 1;  ///< in the file, from 1; its steps lie between BEGIN TIME STEP and END TIME STEP
};

/// Finds files of one time. Borrows the case.
class EnsightTime {
public:
    /// `step`   index into all times of the case, from 0
    EnsightTime(const EnsightCase& from, std::size_t step);

    /// A string is an error: what the case lacks.
    struct Found {
        std::optional<EnsightPlace> place; ///< nothing: there are no values at this time
        std::string error;
    };
    Found model() const;
    Found file_of(const EnsightCase::File& file) const;

private:
    Found place_of(const EnsightCase::File& file, std::size_t step, const EnsightCase::TimeSet& times) const;

    const EnsightCase& case_;
    double time_ = 0;
    double model_time_ = -1;
    std::size_t model_step_ = 1;
};

} // namespace isotet::io::confined
