// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/server/viewed_file.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "view/command_line.hpp"
#include "view/server/greeting.hpp"

namespace isotet::view {

namespace {

class GridFrames : public FrameMaker {
public:
    GridFrames(GridView& view, int threads) : view_(view), threads_(threads) {}
    Result<std::string> frame(const ShowMessage& message, double wait_seconds, std::vector<std::string>& known,
                              const Run& run) override {
        Result<Frame> frame = view_.frame(message, wait_seconds, known, {threads_, run.progress});
        if (!frame) return frame.error();
        return std::move(frame->bytes);
    }
    Result<std::string> chart(const ChartMessage& message, const Run& run) override {
        const Result<Chart> chart = view_.chart(message.field, message.step, {threads_, run.progress}, message.cells);
        if (!chart) return chart.error();
        return chart_text(message, view_.step(), *chart);
    }

    Result<std::string> spectrum(const SpectrumMessage& message, const Run& run) override {
        const Result<ContourSpectrum> spectrum =
            view_.spectrum(message.field, message.step, {threads_, run.progress}, message.cells);
        if (!spectrum) return spectrum.error();
        return spectrum_text(message, view_.step(), *spectrum);
    }

    void rest() override { view_.rest(); }

    Result<std::string> pick(const PickMessage& message, const Run& run) override {
        const Result<Picked> picked = view_.pick(message, {threads_, run.progress});
        if (!picked) return picked.error();
        return picked_text(*picked);
    }

    Result<std::string> parts(const PartsMessage& message, const Run& run) override {
        const Result<ShownParts> found = view_.parts(message, {threads_, run.progress});
        if (!found) return found.error();
        return parts_text(message, view_.step(), found->parts, found->kept);
    }

    Result<std::string> share(const ShareMessage& message, const Run& run) override {
        const Result<double> isovalue = view_.isovalue_at(message, {threads_, run.progress});
        if (!isovalue) return isovalue.error();
        return share_text(message, view_.step(), *isovalue);
    }

private:
    GridView& view_;
    int threads_;
};

} // namespace

double now_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

ViewedFile::ViewedFile(const ViewerFile& file, const ViewerOptions& options, std::string other, Server& server)
    : file_(file), options_(options), other_(std::move(other)), server_(server), downloads_(options.program) {
    worker_.emplace(
        WorkerOutput{[this](PageNumber page, std::string bytes) { server_.send_bytes(page, std::move(bytes)); },
                     [this](PageNumber page, std::string text) { server_.send_text(page, std::move(text)); }},
        now_seconds);
    if (!options.out.empty()) saver_.emplace(options.program, options.out);
    reader_ = std::thread([this] { read_and_pack(); });
}

ViewedFile::~ViewedFile() {
    stop_ = true;
    reader_.join();
}

/// The lock of the news is held.
void ViewedFile::told_failure() {
    if (failure_ && !std::exchange(failure_->told, true)) failure_->at = now_seconds();
}

std::optional<ViewedFile::Failure> ViewedFile::failure() const {
    const std::lock_guard lock(news_mutex_);
    return failure_;
}

void ViewedFile::add_page(ConnectionNumber page) {
    pages_.push_back(page);
    worker_->add_page(page);
    server_.send_text(page, text_of(welcome_json(file_.name, options_.version, options_.out, other_)));
    const std::lock_guard lock(news_mutex_);
    told_failure();
    if (!grid_text_.empty()) server_.send_text(page, grid_text_);
    if (!progress_.empty()) server_.send_text(page, progress_);
}

void ViewedFile::remove_page(ConnectionNumber page) {
    std::erase(pages_, page);
    worker_->remove_page(page);
    if (saver_ && saving_for_ == page) saver_->stop();
    downloads_.forget(page);
}

void ViewedFile::tick() {
    worker_->look_for_stale_work();
    const std::lock_guard lock(news_mutex_);
    const bool tell_grid = std::exchange(grid_is_new_, false), tell_news = std::exchange(news_, false);
    for (const ConnectionNumber page : pages_) {
        if (tell_grid) server_.send_text(page, grid_text_);
        if (tell_news) server_.send_news(page, progress_);
        if (tell_grid) told_failure();
    }
}

void ViewedFile::tell_progress(std::string_view step, double fraction) {
    const std::lock_guard lock(news_mutex_);
    progress_ = progress_text(step, fraction);
    news_ = true;
}

void ViewedFile::set_grid(const ViewerInput& input) {
    const Json grid = grid_json(*view_, file_.name, input);
    const std::lock_guard lock(news_mutex_);
    grid_text_ = text_of(grid);
    grid_is_new_ = true;
}

void ViewedFile::set_failure(const Error& error) {
    if (options_.failed && error.code != ErrorCode::cancelled) options_.failed(error);
    const std::lock_guard lock(news_mutex_);
    failure_ = Failure{error, now_seconds()};
    grid_text_ = error_text("file", error.message);
    grid_is_new_ = true;
}

/// The reading thread: the first surfaces come while it packs.
void ViewedFile::read_and_pack() {
    Run run;
    run.threads = options_.threads;
    run.progress.cancel = &stop_;
    run.progress.report = [this](std::string_view step, double fraction) { tell_progress(step, fraction); };
    tell_progress("read", 0);
    Result<ViewerInput> input = file_.read(run);
    if (!input) return set_failure(input.error());
    GridViewOptions view_options;
    view_options.threads = options_.threads;
    view_options.step = input->state.step.value_or(0);
    view_options.steps = std::max<std::size_t>(1, input->times.size());
    view_options.read_step = file_.read_step;
    view_options.packed = std::move(input->packed);
    view_options.cells = input->cells;
    view_options.read_cells = file_.read_cells;
    if (file_.only_cells)
        view_options.only_cells = [this, regions = input->regions](Grid grid, const std::vector<std::string>& cells) {
            return file_.only_cells(std::move(grid), cells, regions);
        };
    view_options.refine = options_.refine;
    view_options.regions = input->regions;
    Result<std::unique_ptr<GridView>> made = GridView::create(std::move(input->grid), view_options);
    if (!made) return set_failure(made.error());
    view_ = *std::move(made);
    set_grid(*input);
    worker_->start(std::make_shared<GridFrames>(*view_, options_.threads));
    Result<void> packed, found;
    for (const bool boundary : {!input->state.isosurfaces, input->state.isosurfaces}) { // what is seen first
        tell_progress(boundary ? "boundary" : "pack", 0);
        if (boundary) found = view_->find_boundary(run);
        else packed = view_->pack(input->state.field, run, input->state.isovalues);
    }
    worker_->start_background();
    if (!packed) return tell_progress("not packed: " + packed.error().message, 1);
    tell_progress(found ? "ready" : "no boundary: " + found.error().message, 1);
}

void ViewedFile::save(ConnectionNumber from, const SaveRequest& request) {
    const auto refuse = [&](std::string_view sentence) { server_.send_text(from, error_text("save", sentence)); };
    if (!saver_)
        return refuse("Nothing can be saved on the server: isotet view --out FOLDER lets the page write there.");
    Result<std::vector<std::string>> words = save_words(request, saver_->folder(), file_.name, file_.reading);
    if (!words) return refuse(words.error().message);
    const std::string name = request.name;
    Result<void> started = saver_->start(*std::move(words), name, [this, from, name](const Result<std::string>& path) {
        server_.send_text(from, path ? text_of({{"say", "saved"}, {"name", name}, {"path", *path}})
                                     : error_text("save", path.error().message));
    });
    if (!started) return refuse(started.error().message);
    saving_for_ = from;
}

void ViewedFile::download(ConnectionNumber from, const SaveRequest& request) {
    const auto tell = [this, from](const Result<Download>& file) {
        if (file) server_.send_text(from, text_of({{"say", "download"}, {"name", file->name}, {"bytes", file->bytes}}));
        else server_.send_text(from, error_text("save", file.error().message));
    };
    const Result<void> started = downloads_.start(from, request, file_.name, file_.reading, tell);
    if (!started) tell(started.error());
}

void ViewedFile::answer(ConnectionNumber from, PageMessage message) {
    if (auto* show = std::get_if<ShowMessage>(&message)) {
        if (show->refined) worker_->ask_refined(from, std::move(*show));
        else worker_->wish(from, std::move(*show));
    } else if (std::holds_alternative<ShownMessage>(message)) worker_->acknowledge(from);
    else if (auto* chart = std::get_if<ChartMessage>(&message)) worker_->ask_chart(from, std::move(*chart));
    else if (auto* spectrum = std::get_if<SpectrumMessage>(&message)) worker_->ask_spectrum(from, std::move(*spectrum));
    else if (auto* pick = std::get_if<PickMessage>(&message)) worker_->ask_pick(from, std::move(*pick));
    else if (auto* parts = std::get_if<PartsMessage>(&message)) worker_->ask_parts(from, std::move(*parts));
    else if (auto* share = std::get_if<ShareMessage>(&message)) worker_->ask_share(from, std::move(*share));
    else if (const auto* wanted = std::get_if<SaveMessage>(&message)) {
        if (wanted->download) download(from, wanted->request);
        else save(from, wanted->request);
    } else if (std::holds_alternative<PartMessage>(message))
        server_.send_bytes(from, part_bytes(downloads_.next_part(from)));
    else if (const auto* command = std::get_if<CommandMessage>(&message)) {
        server_.send_text(
            from, text_of({{"say", "command"},
                           {"render", shell_text(render_words(command->state, file_.name, file_.reading))},
                           {"extract", shell_text(extract_words(command->state, file_.name, file_.reading))},
                           {"extract_all", shell_text(extract_all_words(command->state, file_.name, file_.reading))}}));
    } else if (const auto* paste = std::get_if<PasteMessage>(&message)) {
        const Result<PastedCommand> pasted = state_of_command(paste->text, file_.reading);
        if (!pasted) return server_.send_text(from, error_text("paste", pasted.error().message));
        const bool other = !pasted->file.empty() && pasted->file != file_.name;
        server_.send_text(from, pasted_text(*pasted, other));
    }
}

} // namespace isotet::view
