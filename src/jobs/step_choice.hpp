// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which time steps options ask for, whatever fields they have: what choose_first() begins with.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/jobs/grid_source.hpp>
#include <isotet/result.hpp>

namespace isotet::jobs {

/// "0, 0.1, 0.2 ... 4": the first few and the last.
std::string list_of(const std::vector<double>& times);

/// The step of a time; of steps of the same time, as restarted runs append them, the last.
/// Errors   invalid_argument: there is none, with those that there are
Result<std::size_t> step_at(const std::vector<double>& times, double time);

/// Which step was taken where none was asked for. `why`   that one: ", and ..."; empty: it is the first
std::string note_of_step(const std::vector<double>& times, std::size_t taken, std::string_view why);

/// The steps that --time, --step or --all-steps ask for; the first, with a note, when none does and there are several.
/// Errors   invalid_argument: a step or time that the file does not have, with those that it has
Result<std::vector<std::size_t>> choose_steps(const FileInfo& info, const GridOptions& options, Steps steps,
                                              Caller& caller);

/// Those behind `first` that are looked at before all others for something that the first lacks.
std::vector<std::size_t> steps_to_look_at(std::size_t first, std::size_t count);

/// A step that has what `first` lacks: of steps_to_look_at() the first, and where it begins before it; else, in up to 1,000
/// steps, the first of all. The last one that was looked at, if any has it.
///
/// `has`   Result<bool>(std::size_t step)
template <class Has>
Result<std::optional<std::size_t>> first_step_with(std::size_t first, std::size_t count, const Has& has) {
    const std::vector<std::size_t> some = steps_to_look_at(first, count);
    std::size_t lacks = first;
    for (std::size_t step : some) {
        const Result<bool> there = has(step);
        if (!there) return there.error();
        if (!*there) {
            lacks = step;
            continue;
        }
        while (step - lacks > 1) {
            const std::size_t middle = lacks + (step - lacks) / 2;
            const Result<bool> found = has(middle);
            if (!found) return found.error();
            (*found ? step : lacks) = middle;
        }
        if (const Result<bool> again = has(step); !again) return again.error();
        return std::optional(step);
    }
    constexpr std::size_t most = 1000; // what is sought is perhaps a slip
    for (std::size_t step = first + 1; step < count && count <= most; ++step) {
        if (std::ranges::binary_search(some, step)) continue;
        const Result<bool> there = has(step);
        if (!there) return there.error();
        if (*there) return std::optional(step);
    }
    return std::optional<std::size_t>();
}

} // namespace isotet::jobs
