// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet's own readers as WebAssembly: files that were dropped on a page become the grid that it looks at.
#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include <isotet/first_view.hpp>
#include <isotet/jobs/first_choice.hpp>
#include <isotet/read.hpp>

#include "io/files/escape.hpp"
#include "io/formats.hpp"
#include "module.hpp"
#include "page.hpp"
#include "view/server/greeting.hpp"
#include "webgpu/card.hpp"

namespace isotet::web {

using namespace view;

namespace {

void say_progress(std::string_view step, double fraction) { say_text(progress_text(step, fraction)); }

/// Tells the page how far it is, at each hundredth.
void say_hundredths(std::string_view step, double fraction) {
    static int said = -1;
    static std::string last;
    const int hundredths = static_cast<int>(100 * fraction);
    if (hundredths == said && step == last) return;
    said = hundredths;
    last = step;
    say_progress(step, fraction);
}

Run telling_run() {
    Run run{1, {}};
    run.progress.report = say_hundredths;
    return run;
}

ReadOptions options_of(const Told& told) {
    ReadOptions options;
    options.more_files.assign(told.files.begin() + 1, told.files.end());
    return options;
}

/// What is shown first, as `isotet view` does.
void choose_first_view(const ReadResult& read, Told& told) {
    const FirstView first = first_view(read.grid, read.info.fields);
    take_first_view(first, told.state);
    if (is_of_reservoirs(read.info.format)) told.state.stretch = default_stretch(read.grid.points);
    told.notes.push_back(first.field.empty() ? std::string("no field varies that would be contoured: this is the grid")
                                             : jobs::note_of(first));
}

/// Errors   as read() and GridView::create()
Result<std::unique_ptr<Looker>> looker_of_files(Told& told) {
    const ReadOptions options = options_of(told);
    Result<ReadResult> read = isotet::read(told.files.front(), options, telling_run());
    if (!read) return read.error();
    told.notes.insert(told.notes.end(), read->notes.begin(), read->notes.end());
    choose_first_view(*read, told);
    GridViewOptions view_options;
    view_options.threads = 1;
    view_options.engine = card_engine();
    view_options.regions = read->info.regions;
    view_options.steps = std::max<std::size_t>(1, read->info.times.size());
    view_options.read_step = [file = told.files.front(), options](std::size_t step, const Run& run) -> Result<Grid> {
        ReadOptions of_step = options;
        of_step.step = step;
        Result<ReadResult> again = isotet::read(file, of_step, {1, run.progress});
        if (!again) return again.error();
        return std::move(again->grid);
    };
    if (read->info.times.size() > 1) told.state.step = 0;
    Result<std::unique_ptr<GridView>> view = GridView::create(std::move(read->grid), view_options);
    if (!view) return view.error();
    return std::make_unique<Looker>(*std::move(view), std::move(read->info.times));
}

std::string packed_later; ///< field that prepare() packs; empty: nothing is to be done

bool is_packed(const std::string& path) {
    const auto reader = io::choose_reader(path, {});
    return reader && (*reader)->format.name == "isotet";
}

void read_files(const Told& given) {
    Told told = given;
    looker.reset(); // its memory first
    packed_later.clear();
    if (told.files.empty()) return say_text(error_text("file", "no file was given"));
    if (told.files.size() == 1 && is_packed(told.files.front())) return open_packed(told.files.front(), told);
    Result<std::unique_ptr<Looker>> opened = looker_of_files(told);
    if (!opened) return say_text(error_text("file", opened.error().message));
    looker = *std::move(opened);
    packed_later = told.state.field;
    looker->say_grid(told);
    say_progress("pack", 0);
}

/// Errors are told as progress: the surface is extracted directly then.
void prepare() {
    if (!looker || packed_later.empty()) return;
    const std::string field = std::exchange(packed_later, {});
    const Run run = telling_run();
    const Result<void> packed = looker->view().pack(field, run);
    say_progress("boundary", 0);
    const Result<void> found = looker->view().find_boundary(run);
    if (!packed) return say_progress("not packed: " + packed.error().message, 1);
    say_progress(found ? "ready" : "no boundary: " + found.error().message, 1);
}

} // namespace

} // namespace isotet::web

// What the page calls.
extern "C" {

/// Reads the grid of the files that the text in the room names, and tells the page.
__attribute__((export_name("read"))) void isotet_read() {
    using namespace isotet;
    const Result<web::Told> told = web::Told::parse(web::room);
    if (!told) return web::say_text(view::error_text("file", told.error().message));
    web::read_files(*told);
}

/// Packs what read() read, and finds its boundary: once a first surface is shown.
__attribute__((export_name("prepare"))) void isotet_prepare() { isotet::web::prepare(); }
}
