// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet as WebAssembly: a packed grid in memory, looked at by the page of `isotet view` as if a server were there.
#include "module.hpp"

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <isotet/extract.hpp>
#include <isotet/pack.hpp>
#include <isotet/packed_file.hpp>

#include "io/packed/file_grid.hpp"
#include "page.hpp"
#include "webgpu/card.hpp"

namespace isotet::web {

using namespace view;

namespace {

constexpr const char* grid_path = "/grid.isotet"; ///< of a page that holds one grid

/// The grid of the file at a step, with all its fields.
Result<Grid> read_step(const std::string& path, std::size_t step, const Run& run) {
    const auto source = io::PackedSource::open(path);
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

/// Errors   as PackedFile::open() and PackedFile::load(), GridView::create()
Result<std::unique_ptr<Looker>> looker_at(const std::string& path, ViewState& state) {
    const Result<PackedFile> file = PackedFile::open(path);
    if (!file) return file.error();
    GridViewOptions options;
    options.threads = 1;
    options.engine = card_engine();
    options.step = state.step.value_or(0);
    options.steps = file->info().steps;
    options.read_step = [path](std::size_t step, const Run& run) { return read_step(path, step, run); };
    options.refine.reset();
    Result<Grid> grid = read_step(path, options.step, {});
    if (!grid) return grid.error();
    if (state.field.empty() && !grid->point_fields.empty()) state.field = grid->point_fields.front().name;
    Result<std::unique_ptr<GridView>> view = GridView::create(*std::move(grid), options);
    if (!view) return view.error();
    const Result<PackedGrid> packed = file->load(state.field, options.step);
    if (!packed) return packed.error();
    if (Result<void> taken = (*view)->take_packed(*packed, state.field, {}); !taken) return taken.error();
    if (Result<void> found = (*view)->find_boundary({}); !found) say_text(error_text("grid", found.error().message));
    return std::make_unique<Looker>(*std::move(view), file->info().times);
}

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

} // namespace

void open_packed(const std::string& path, const Told& told) {
    Told shown = told;
    Result<std::unique_ptr<Looker>> opened = looker_at(path, shown.state);
    if (!opened) return say_text(error_text("file", opened.error().message));
    looker = *std::move(opened);
    looker->say_grid(shown);
    say_text(progress_text("ready", 1));
}

} // namespace isotet::web

// What the page calls.
extern "C" {

/// Memory for a text of so many bytes.
__attribute__((export_name("room"))) char* isotet_room(std::size_t bytes) {
    isotet::web::room.resize(bytes);
    return isotet::web::room.data();
}

/// Opens the grid, of which the text in the room tells.
__attribute__((export_name("open"))) void isotet_open() {
    using namespace isotet;
    const Result<web::Told> told = web::Told::parse(web::room);
    if (!told) return web::say_text(view::error_text("file", told.error().message));
    web::open_packed(web::grid_path, *told);
}

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
