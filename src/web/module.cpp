// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet as WebAssembly: a packed grid in memory, looked at by the page of `isotet view` as if a server were there.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <isotet/extract.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/pack.hpp>

#include "io/packed/file_grid.hpp"
#include "view/greeting.hpp"
#include "view/grid_view.hpp"
#include "view/messages.hpp"

/// What the page gives: it takes a text, or the bytes of a frame, and copies them.
extern "C" {
__attribute__((import_module("page"), import_name("text"))) void
page_takes_text(const char* bytes, std::size_t count);
__attribute__((import_module("page"), import_name("surface"))) void
page_takes_surface(const void* positions, std::size_t position_bytes, const void* triangles,
                   std::size_t triangle_bytes);
__attribute__((import_module("page"), import_name("frame"))) void
page_takes_frame(const char* bytes, std::size_t count);
}

namespace isotet::web {

namespace {

using namespace view;

constexpr const char* grid_path = "/grid.isotet"; ///< as the page's file system has it (web/wasi.js)

void say_text(const std::string& text) { page_takes_text(text.data(), text.size()); }

/// The grid of the file at a step, with all its fields.
Result<Grid> read_step(std::size_t step, const Run& run) {
    const auto source = io::PackedSource::open(grid_path);
    if (!source) return source.error();
    std::vector<Field> fields;
    std::shared_ptr<const core::Packed> cells;
    for (const io::FieldEntry& entry : (*source)->directory.fields) {
        if (entry.step != step) continue;
        const auto packed = io::whole_grid_of_file(**source, entry, cells.get(), run.progress);
        if (!packed) return packed.error();
        cells = *packed;
        Result<Field> values = unpack_field(PackedGrid(cells), run);
        if (!values) return values.error();
        fields.push_back(*std::move(values));
    }
    if (!cells) return Error{ErrorCode::invalid_argument, "the packed grid has no such step"};
    Result<Grid> grid = unpack(PackedGrid(cells), run);
    if (grid) grid->point_fields = std::move(fields);
    return grid;
}

class Looker {
public:
    /// Errors   as PackedFile::open() and PackedFile::load(), GridView::create()
    static Result<std::unique_ptr<Looker>> open(const ViewState& state);

    void answer(PageMessage message);
    const GridView& view() const { return *view_; }
    std::vector<double> times;

private:
    void show(const ShowMessage& message);

    std::unique_ptr<GridView> view_;
    std::vector<std::string> known_;
};

Result<std::unique_ptr<Looker>> Looker::open(const ViewState& state) {
    const Result<PackedFile> file = PackedFile::open(grid_path);
    if (!file) return file.error();
    auto looker = std::make_unique<Looker>();
    looker->times = file->info().times;
    GridViewOptions options;
    options.threads = 1;
    options.step = state.step.value_or(0);
    options.steps = file->info().steps;
    options.read_step = read_step;
    options.refine.reset();
    Result<Grid> grid = read_step(options.step, {});
    if (!grid) return grid.error();
    Result<std::unique_ptr<GridView>> view = GridView::create(*std::move(grid), options);
    if (!view) return view.error();
    looker->view_ = *std::move(view);
    const Result<PackedGrid> packed = file->load(state.field, options.step);
    if (!packed) return packed.error();
    if (Result<void> taken = looker->view_->take_packed(*packed, state.field, {}); !taken)
        return taken.error();
    if (Result<void> found = looker->view_->find_boundary({}); !found)
        say_text(error_text("grid", found.error().message));
    return looker;
}

void Looker::show(const ShowMessage& message) {
    const Result<view::Frame> frame = view_->frame(message, 0, known_, {1, {}});
    if (frame) page_takes_frame(frame->bytes.data(), frame->bytes.size());
    else say_text(refusal_text(message.number, frame.error().message));
}

void Looker::answer(PageMessage message) {
    const Run run{1, {}};
    if (const auto* wish = std::get_if<ShowMessage>(&message)) return show(*wish);
    if (const auto* chart = std::get_if<ChartMessage>(&message)) {
        const Result<Chart> made = view_->chart(chart->field, chart->step, run);
        return say_text(made ? chart_text(chart->field, view_->step(), *made)
                             : error_text("chart", made.error().message));
    }
    if (const auto* wanted = std::get_if<SpectrumMessage>(&message)) {
        const Result<ContourSpectrum> made = view_->spectrum(wanted->field, wanted->step, run);
        return say_text(made ? spectrum_text(wanted->field, view_->step(), *made)
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

std::unique_ptr<Looker> looker;
std::string room;
std::optional<PackedGrid> extracted_grid; ///< of extracted_field
std::string extracted_field;

/// A surface as it is, for who draws it otherwise.
void extract_raw(const std::string& field, double isovalue) {
    if (!extracted_grid || extracted_field != field) {
        const Result<PackedFile> file = PackedFile::open(grid_path);
        if (!file) return say_text(error_text("extract", file.error().message));
        const Result<PackedGrid> loaded = file->load(field);
        if (!loaded) return say_text(error_text("extract", loaded.error().message));
        extracted_grid = *loaded;
        extracted_field = field;
    }
    const Result<Extraction> made = extract(*extracted_grid, isovalue, {}, {1, {}});
    if (!made) return say_text(error_text("extract", made.error().message));
    const Surface& surface = made->surface;
    page_takes_surface(surface.positions.data(), surface.positions.bytes(), surface.triangles.data(),
                       surface.triangles.bytes());
}

/// {"file": name, "version": ..., "state": ..., "notes": [...]}: what `isotet export` says of the grid.
void open_grid(std::string_view text) {
    const std::optional<Json> told = parse_json(text);
    const Json* json = told ? find(*told, "state") : nullptr;
    const Result<ViewState> state = json ? state_of(*json) : Result<ViewState>(ViewState{});
    if (!state) return say_text(error_text("file", state.error().message));
    Result<std::unique_ptr<Looker>> opened = Looker::open(*state);
    if (!opened) return say_text(error_text("file", opened.error().message));
    looker = *std::move(opened);
    const auto word = [&](std::string_view key) {
        const Json* value = told ? find(*told, key) : nullptr;
        const std::string* found = value ? view::text(*value) : nullptr;
        return found ? *found : std::string();
    };
    ViewerInput input;
    input.state = *state;
    if (looker->times.size() > 1) input.times = looker->times;
    if (const Json* notes = told ? find(*told, "notes") : nullptr; notes && notes->is_array())
        for (const Json& note : *notes)
            if (const std::string* sentence = view::text(note)) input.notes.push_back(*sentence);
    say_text(text_of(welcome_json(word("file"), word("version"), "")));
    Json grid = grid_json(looker->view(), word("file"), input);
    grid["saved"] = "grid";
    say_text(text_of(grid));
    say_text(progress_text("ready", 1));
}

} // namespace

} // namespace isotet::web

// What the page calls.
extern "C" {

/// Memory for a text of so many bytes.
__attribute__((export_name("room"))) char* isotet_room(std::size_t bytes) {
    isotet::web::room.resize(bytes);
    return isotet::web::room.data();
}

/// Opens the grid, of which the text in the room tells.
__attribute__((export_name("open"))) void isotet_open() { isotet::web::open_grid(isotet::web::room); }

/// The surface of the field whose name is in the room.
__attribute__((export_name("extract"))) void isotet_extract(double isovalue) {
    isotet::web::extract_raw(isotet::web::room, isovalue);
}

/// Answers the message in the room.
__attribute__((export_name("answer"))) void isotet_answer() {
    using namespace isotet;
    Result<view::PageMessage> message = view::parse_page_message(web::room);
    if (!message) return web::say_text(view::error_text("message", message.error().message));
    if (web::looker) web::looker->answer(*std::move(message));
}
}
