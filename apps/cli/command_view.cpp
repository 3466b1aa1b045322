// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet view`: a grid in the browser.
#include <filesystem>
#include <mutex>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <isotet/jobs/grid_source.hpp>
#include <isotet/jobs/number_text.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/text.hpp>
#include <isotet/version.hpp>

#include "browser.hpp"
#include "commands.hpp"
#include "output/console.hpp"
#include "output/json_output.hpp"
#include "output/signals.hpp"
#include "output/standard_streams.hpp"
#include "output/text.hpp"
#include "view_record.hpp"
#include "view/first_input.hpp"
#include "view/note_keeper.hpp"
#include "view/viewer.hpp"

namespace isotet::cli {

namespace {

/// Files of further steps, and options that say how all are read and refined, for command lines of the page.
std::vector<std::string> reading_options(const GridOptions& grid, const RefineChoice& refine) {
    std::vector<std::string> words;
    for (const std::string& file : grid.more_files) words.push_back((file.starts_with('-') ? "./" : "") + file);
    const auto add = [&](const char* name, const std::string& value) { words.insert(words.end(), {name, value}); };
    if (!grid.format.empty()) add("--format", grid.format);
    if (grid.merge_points) add("--merge-points", shortest(*grid.merge_points));
    if (grid.merge_values == MergedValues::mean) add("--merge-values", "mean");
    if (grid.hanging_points != HangingChoice::close)
        add("--hanging-points", grid.hanging_points == HangingChoice::leave ? "leave" : "interpolate");
    if (grid.keep_pieces) words.emplace_back("--keep-pieces");
    if (grid.allow_outside) words.emplace_back("--allow-outside");
    if (!grid.displace.empty()) add("--displace", grid.displace);
    for (const std::string& block : grid.blocks) add("--block", block);
    for (const std::string& cells : grid.cells) add("--cells", cells);
    const RefineOptions usual;
    if (!refine) add("--tolerance", "nodes");
    else if (refine->tolerance > 0) add("--tolerance", shortest(refine->tolerance));
    else if (refine->relative_tolerance > 0 && refine->relative_tolerance != usual.relative_tolerance)
        add("--tolerance", shortest(100 * refine->relative_tolerance) + "%");
    if (refine && refine->distance > 0) add("--distance", shortest(refine->distance));
    if (refine && refine->geometry_tolerance > 0) add("--geometry-tolerance", shortest(refine->geometry_tolerance));
    return words;
}

/// A file of the command line, and what the viewer is told of it.
class OpenedFile {
public:
    /// `command`   whose grid it is
    explicit OpenedFile(const ViewCommand& command) : command_(command), console_(command.common) {}

    /// Errors   as GridSource::open() and view::check_view_fields(); of outputs and steps
    Result<void> open() {
        Result<GridSource> source = GridSource::open(command_.grid, notes_);
        if (!source) return source.error();
        source_ = *std::move(source);
        if (auto paths = check_output_paths(source_->info().files, {command_.common.json}); !paths)
            return paths.error();
        return check_fields();
    }

    std::vector<std::string> files() const {
        return source_ ? source_->info().files : std::vector<std::string>{command_.grid.file};
    }

    /// As open(), but fields that it does not have are only noted; other errors are those of reading it.
    void open_beside() {
        Result<void> opened = open();
        if (!opened && source_ && !check_fields()) {
            notes_.note(command_.grid.file + ": " + opened.error().message);
            command_.field = {};
            command_.color_by.clear();
            command_.isovalues.clear();
            command_.shares.clear();
            opened = open();
        }
        if (!opened) error_ = opened.error();
    }

    view::ViewerFile to_view() {
        view::ViewerFile file;
        file.name = valid_utf8(command_.grid.file);
        file.reading = reading_options(command_.grid, command_.refine);
        file.read = [this](const Run& run) -> Result<view::ViewerInput> {
            if (error_) return *error_;
            const view::ViewStart start{command_.grid,   command_.field,         command_.isovalues,
                                        command_.shares, command_.color_by,      view::FirstCells::some,
                                        false,           command_.decimal_comma, command_.memory};
            return view::read_first_input(start, *source_, notes_, run);
        };
        file.read_step = [this](std::size_t step, const Run& run) -> Result<Grid> {
            const std::lock_guard lock(reading_);
            Result<ReadResult> read = source_->read_some(all_fields(), step, notes_, run);
            if (!read) return read.error();
            return std::move(read->grid);
        };
        file.read_cells = [this](std::size_t step, const Run& run) {
            const std::lock_guard lock(reading_);
            return source_->read(all_fields(), step, notes_, run);
        };
        file.only_cells = [this](Grid grid, const std::vector<std::string>& cells,
                                 const std::vector<RegionName>& regions) {
            return source_->only_cells(std::move(grid), cells, regions);
        };
        return file;
    }

    Console& console() noexcept { return console_; }

private:
    Result<void> check_fields() {
        const ChoiceWish wish = view::view_wish(Steps::one, command_.field, command_.color_by);
        return view::check_view_fields(*source_, wish, command_.grid, notes_);
    }

    /// As read_first_input() reads them.
    static FieldsToRead all_fields() {
        FieldsToRead all;
        all.blocks = true;
        return all;
    }

    ViewCommand command_;
    Console console_;
    view::NoteKeeper notes_{console_};
    std::optional<GridSource> source_;
    std::optional<Error> error_; ///< of opening it
    std::mutex reading_;         ///< steps are read by several threads
};

ViewCommand of_second_file(const ViewCommand& command) {
    ViewCommand second = command;
    second.grid.file = command.beside;
    second.grid.more_files.clear();
    return second;
}

/// Opens it with the token and port of the last run with this file: addresses stay valid. A line that is not encrypted
/// may have been read: then the token is a new one each time.
Result<std::unique_ptr<view::Viewer>> open_viewer(const ViewCommand& command, view::ViewerOptions options) {
    const bool is_own = command.listen.empty() || command.listen == "127.0.0.1" || command.listen == "::1" ||
                        command.listen.starts_with("unix:");
    if (!is_own) return view::Viewer::open(std::move(options));
    const std::optional<ViewRecord> last = recall_view(command.grid.file);
    if (last) options.token = last->token;
    const bool same_port = last && options.port == 0;
    if (same_port) options.port = last->port;
    auto viewer = view::Viewer::open(options);
    const bool taken = !viewer && same_port;
    if (taken) { // perhaps by a run that goes on
        options.port = 0;
        viewer = view::Viewer::open(std::move(options));
    }
    if (viewer && !taken) remember_view(command.grid.file, {(*viewer)->token(), (*viewer)->port()});
    return viewer;
}

/// The address, before anything is read: for people, also with --quiet, or as JSON.
Result<void> tell_address(const ViewCommand& command, const view::Viewer& viewer, Browser& browser, Console& console) {
    const std::string address = viewer.address();
    if (command.common.json.empty()) {
        if (Result<void> written = write_to_stdout(address + "\n"); !written) return written;
    } else {
        Json report = json_report("view");
        report["address"] = address;
        const Result<ExitCode> told = finish(console, command.common, address + "\n", std::move(report));
        if (!told) return told.error();
    }
    constexpr std::string_view unix_prefix = "unix:";
    if (command.listen.starts_with(unix_prefix)) {
        console.note("on the machine with the browser: ssh -N -L 8123:" + command.listen.substr(unix_prefix.size()) +
                     " HOST  then open the address there");
        return {};
    }
    if (!command.listen.empty() && command.listen != "127.0.0.1" && command.listen != "::1") {
        const bool anywhere = command.listen == "0.0.0.0" || command.listen == "::";
        console.note(
            fmt::format("warning: other machines reach this page at {}, and the line is not encrypted: whoever "
                        "reads it can look at the file{}. ssh -L is the safe way",
                        anywhere ? "each address of this machine" : command.listen,
                        command.out.empty() ? "" : ", and write into --out"));
    }
    if (is_over_ssh()) {
        console.note("on the machine with the browser: " + ssh_line(viewer.port()) + "  then open the address there");
    } else if (!command.no_browser && !browser.open(address)) {
        console.note("there is no browser here that could be opened: open the address in one");
    }
    return {};
}

} // namespace

Result<ExitCode> run_view(const ViewCommand& command) {
    OpenedFile file(command), second(of_second_file(command));
    if (Result<void> opened = file.open(); !opened) return opened.error();
    view::ViewerOptions options;
    options.file = file.to_view();
    if (!command.beside.empty()) {
        second.open_beside();
        if (auto paths = check_output_paths(second.files(), {command.common.json}); !paths) return paths.error();
        options.second = second.to_view();
    }
    options.refine = command.refine;
    options.port = static_cast<std::uint16_t>(command.port);
    options.hosts = command.hosts;
    options.version = ISOTET_VERSION;
    options.keep = command.keep;
    options.max_pages = command.pages;
    options.threads = command.common.threads;
    if (!command.out.empty()) {
        std::error_code ignored;
        if (!std::filesystem::is_directory(command.out, ignored))
            return usage_error("--out is '{}', which is no folder", command.out);
        options.out = command.out;
    }
    options.program = "/proc/self/exe";
    options.listen = command.listen;
    options.is_left = is_left_by_ssh;
    options.failed = [](const Error& error) { say_error(error.message); };
    auto viewer = open_viewer(command, std::move(options));
    if (!viewer) return viewer.error();
    Browser browser;
    if (Result<void> told = tell_address(command, **viewer, browser, file.console()); !told) return told.error();
    take_time_to_stop();
    const Result<void> served = (*viewer)->run(stop_requested);
    if (!served && !stop_requested) return exit_code_of(served.error().code); // told already
    if (!served) return served.error();
    if (!(*viewer)->reason().empty()) file.console().note((*viewer)->reason());
    return ExitCode::done;
}

} // namespace isotet::cli
