// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/step_choice.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>

#include "jobs/refuse.hpp"

namespace isotet::jobs {

std::string list_of(const std::vector<double>& times) {
    constexpr std::size_t max_shown = 10;
    std::string list;
    for (std::size_t i = 0; i < std::min(times.size(), max_shown); ++i) list += (i ? ", " : "") + shortest(times[i]);
    if (times.size() > max_shown) list += " ... " + shortest(times.back());
    return list;
}

Result<std::size_t> step_at(const std::vector<double>& times, double time) {
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (std::abs(times[i] - time) <= std::abs(times[nearest] - time)) nearest = i;
    }
    constexpr double tolerance = 1e-12; // relative: a time that went through text and back
    if (times.empty()) {
        return refusal("time {} was asked for, but the file knows no time", shortest(time));
    }
    if (std::abs(times[nearest] - time) <= tolerance * std::max(std::abs(time), std::abs(times[nearest])))
        return nearest;
    if (static_cast<float>(time) == static_cast<float>(times[nearest])) return nearest; // a file of single precision
    return refusal("time {} was asked for, but the file has {} times: {}; the nearest is {}", shortest(time),
                   times.size(), list_of(times), shortest(times[nearest]));
}

std::string note_of_step(const std::vector<double>& times, std::size_t taken, std::string_view why) {
    return fmt::format("the file has {} time steps{}: step {}, time {}, was taken; `time` and `step` choose another",
                       times.size(), why, taken, shortest(times[taken]));
}

Result<std::vector<std::size_t>> choose_steps(const FileInfo& info, const GridOptions& options, Steps steps,
                                              Caller& caller) {
    const std::size_t count = std::max<std::size_t>(info.times.size(), 1);
    if (steps == Steps::all) {
        std::vector<std::size_t> all(count);
        for (std::size_t i = 0; i < count; ++i) all[i] = i;
        return all;
    }
    if (options.time) {
        const Result<std::size_t> step = step_at(info.times, *options.time);
        if (!step) return step.error();
        return std::vector<std::size_t>{*step};
    }
    if (options.step) {
        if (*options.step < count) return std::vector<std::size_t>{static_cast<std::size_t>(*options.step)};
        return refusal("step {} was asked for, but the file has {} time step{}, numbered from 0", *options.step, count,
                       count == 1 ? "" : "s");
    }
    if (count > 1) caller.note(note_of_step(info.times, 0, {}));
    return std::vector<std::size_t>{0};
}

std::vector<std::size_t> steps_to_look_at(std::size_t first, std::size_t count) {
    constexpr std::size_t most = 32;
    std::vector<std::size_t> steps;
    const std::size_t others = count - 1 - first, some = std::min(others, most);
    for (std::size_t i = 1; i <= some; ++i) steps.push_back(first + i * others / some);
    return steps;
}

} // namespace isotet::jobs
