// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "session/source.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/stopwatch.hpp"

namespace isotet::session {

namespace {

/// What is to be told of a grid that was made linear.
void tell(const LinearGrid& made, Told& told) {
    told.add(made.report.notes());
    told.add(notes_on(made.refinement));
}

} // namespace

void Told::add(std::vector<std::string> more) { std::ranges::move(more, std::back_inserter(notes)); }

Result<Source> Source::take(ContourInput input, const ContourOptions& options, const Source& before, bool whole,
                            const Run& run, Told& told) {
    Source source;
    if (options.refine && has_curved_cells(input.grid.cells)) {
        if (auto taken = source.curved_.take(std::move(input), options); !taken) return taken.error();
        return source;
    }
    const core::Stopwatch time;
    if (!whole && MetInput::suits(input, options)) {
        Result<std::optional<ContourInput>> part = source.met_.make(input, options, run);
        if (!part) return part.error();
        if (*part) {
            source.input_ = **std::move(part);
            told.add(source.met_.grid()->report.notes());
            told.seconds += time.seconds();
            return source;
        }
    }
    source.linear_ = before.linear_;
    Result<ContourInput> made = source.linear_.make(std::move(input), run);
    if (!made) return made.error();
    source.input_ = *std::move(made);
    if (source.linear_.grid()) told.seconds += time.seconds();
    if (source.linear_.is_new()) tell(*source.linear_.grid(), told);
    return source;
}

Source Source::of_packed(ContourInput input) {
    Source source;
    source.input_ = std::move(input);
    source.input_.packed.reset();
    return source;
}

const std::shared_ptr<const LinearGrid>& Source::linear_grid() const {
    return curved_ ? curved_.grid() : met_ ? met_.grid() : linear_.grid();
}

bool Source::suffices(std::span<const double> isovalues, const ContourOptions& options) const {
    if (met_) return met_.is_good_for(isovalues);
    return !input().lacks_cells() || std::ranges::all_of(isovalues, [&](double isovalue) {
        return std::ranges::find(options.expected_isovalues, isovalue) != options.expected_isovalues.end();
    });
}

Result<Source> Source::whole(const ContourOptions& options, const Source& known, const Run& run, Told& told) const {
    const core::Stopwatch time;
    Result<ContourInput> all = met_ ? Result<ContourInput>(met_.user()) : with_all_cells(input(), run);
    if (!all) return all.error();
    const double before = told.seconds;
    Result<Source> source = take(*std::move(all), options, known, true, run, told);
    told.seconds = before + time.seconds();
    return source;
}

Result<void> Source::refine_for(std::span<const double> isovalues, const Run& run, Told& told) {
    const core::Stopwatch time;
    input_ = {};
    Result<ContourInput> refined = curved_.refine(isovalues, run);
    if (!refined) return refined.error();
    input_ = *std::move(refined);
    told.add(curved_.grid()->report.notes());
    told.add(curved_.notes());
    told.seconds += time.seconds();
    return {};
}

} // namespace isotet::session
