// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "looker.hpp"

#include <optional>
#include <utility>
#include <variant>

#include "page.hpp"
#include "view/server/greeting.hpp"
#include "webgpu/card.hpp"

namespace isotet::web {

using namespace view;

namespace {

std::string word_of(const Json& told, std::string_view key) {
    const Json* value = find(told, key);
    const std::string* found = value ? view::text(*value) : nullptr;
    return found ? *found : std::string();
}

std::vector<std::string> words_of(const Json& told, std::string_view key) {
    std::vector<std::string> words;
    if (const Json* values = find(told, key); values && values->is_array())
        for (const Json& value : *values)
            if (const std::string* word = view::text(value)) words.push_back(*word);
    return words;
}

} // namespace

Result<Told> Told::parse(std::string_view text) {
    const std::optional<Json> json = parse_json(text);
    if (!json) return Error{ErrorCode::invalid_argument, "what is told of the grid is no JSON"};
    Told told{
        word_of(*json, "file"), word_of(*json, "version"), {}, words_of(*json, "notes"), words_of(*json, "files")};
    if (const Json* given = find(*json, "state")) {
        Result<ViewState> state = state_of(*given);
        if (!state) return state.error();
        told.state = *std::move(state);
    }
    return told;
}

void Looker::say_grid(const Told& told) const {
    ViewerInput input;
    input.state = told.state;
    if (times_.size() > 1) input.times = times_;
    input.notes = told.notes;
    say_text(text_of(welcome_json(told.file, told.version, "")));
    Json grid = grid_json(*view_, told.file, input);
    grid["saved"] = "grid";
    say_text(text_of(grid));
}

void Looker::show(const ShowMessage& message) {
    const Card::Asking asking(card());
    const Result<view::Frame> frame = view_->frame(message, 0, known_, {1, {}});
    if (say_wanted()) return;
    if (frame) page_takes_frame(frame->bytes.data(), frame->bytes.size());
    else say_text(refusal_text(message.number, frame.error().message));
}

void Looker::answer(PageMessage message) {
    const Run run{1, {}};
    if (const auto* wish = std::get_if<ShowMessage>(&message)) return show(*wish);
    if (const auto* chart = std::get_if<ChartMessage>(&message)) {
        const Result<Chart> made = view_->chart(chart->field, chart->step, run);
        return say_text(made ? chart_text(*chart, view_->step(), *made) : error_text("chart", made.error().message));
    }
    if (const auto* wanted = std::get_if<SpectrumMessage>(&message)) {
        const Result<ContourSpectrum> made = view_->spectrum(wanted->field, wanted->step, run);
        return say_text(made ? spectrum_text(*wanted, view_->step(), *made)
                             : error_text("spectrum", made.error().message));
    }
    if (const auto* pick = std::get_if<PickMessage>(&message)) {
        const Result<Picked> picked = view_->pick(*pick, run);
        return say_text(picked ? picked_text(*picked) : error_text("pick", picked.error().message));
    }
    if (const auto* parts = std::get_if<PartsMessage>(&message)) {
        const Result<ShownParts> found = view_->parts(*parts, run);
        return say_text(found ? parts_text(*parts, view_->step(), found->parts, found->kept)
                              : error_text("parts", found.error().message));
    }
    if (const auto* share = std::get_if<ShareMessage>(&message)) {
        const Result<double> isovalue = view_->isovalue_at(*share, run);
        return say_text(isovalue ? share_text(*share, view_->step(), *isovalue)
                                 : error_text("share", isovalue.error().message));
    }
}

} // namespace isotet::web
