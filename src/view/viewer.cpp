// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/viewer.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <sys/random.h>

#include "view/command_line.hpp"
#include "view/download.hpp"
#include "view/greeting.hpp"
#include "view/grid_view.hpp"
#include "view/page.hpp"
#include "view/server.hpp"
#include "view/worker.hpp"

namespace isotet::view {

namespace {

constexpr int forwarded_port = 8123; ///< in what is told of a Unix socket
constexpr double hello_seconds = 5;  ///< within which a page says its token
constexpr double alive_seconds = 4;  ///< between two messages that tell a page that the line is there

double now_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// "60 s", "30 minutes"
std::string duration_text(double seconds) {
    return seconds < 120 ? fmt::format("{:g} s", seconds) : fmt::format("{:g} minutes", std::round(seconds / 60));
}

/// Takes the same time wherever they differ.
bool is_same_token(const std::string& a, const std::string& b) {
    unsigned different = a.size() == b.size() ? 0 : 1;
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i)
        different |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
    return different == 0;
}

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
        const Result<Chart> chart = view_.chart(message.field, message.step, {threads_, run.progress});
        if (!chart) return chart.error();
        return chart_text(message.field, view_.step(), *chart);
    }

    Result<std::string> spectrum(const SpectrumMessage& message, const Run& run) override {
        const Result<ContourSpectrum> spectrum =
            view_.spectrum(message.field, message.step, {threads_, run.progress});
        if (!spectrum) return spectrum.error();
        return spectrum_text(message.field, view_.step(), *spectrum);
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

Result<std::string> random_token() {
    std::array<unsigned char, 16> bytes{};
    if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
        return Error{ErrorCode::system, "the system gives no random numbers for the token of the page"};
    std::string token;
    for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
    return token;
}

struct Viewer::Data {
    ViewerOptions options;
    std::optional<Server> server;
    std::atomic<bool> stop{false}; ///< of reading and packing
    const std::atomic<bool>* asked_to_stop = nullptr;

    /// Who is connected: `admitted` once the token was right.
    struct Page {
        bool admitted = false;
        double since = 0;
    };
    std::map<ConnectionNumber, Page> pages; ///< of the server's thread
    std::optional<double> alone_until;      ///< once the last admitted page went: when it all ends
    Parting last_parting = Parting::closed; ///< of the page that may come back longest
    std::optional<double> longest_wait;     ///< for a page that went since one was admitted
    bool failure_told = false;              ///< to a page
    double said_alive = 0;
    std::string reason;                     ///< why it ended

    std::mutex news_mutex; ///< of what the reading thread tells
    std::string progress;
    bool news = false;
    std::string grid_text; ///< once it is read
    bool grid_is_new = false;
    std::optional<Error> failure;
    double failed_at = 0; ///< or when a page was told first

    std::unique_ptr<GridView> view;
    std::optional<Worker> worker;
    std::unique_ptr<Downloads> downloads;
    std::unique_ptr<Saver> saver;    ///< with ViewerOptions::out
    ConnectionNumber saving_for = 0; ///< whose file is written, or was last
    std::thread reader;

    void start();
    void read_and_pack();
    void tell_progress(std::string_view step, double fraction);
    void set_grid(const ViewerInput& input);
    void set_failure(const Error& error);

    void take_message(ConnectionNumber from, std::string_view text);
    void take_hello(ConnectionNumber from, const HelloMessage& message);
    void answer(ConnectionNumber from, PageMessage message);
    void save(ConnectionNumber from, const SaveRequest& request);
    void download(ConnectionNumber from, const SaveRequest& request);
    void page_closed(ConnectionNumber which, Parting parting);
    void tell_pages();
    bool has_failed(double now);
    bool was_left(double now);
    void say_alive(double now);
    bool tick();
    std::size_t admitted() const;
};

void Viewer::Data::tell_progress(std::string_view step, double fraction) {
    const std::lock_guard lock(news_mutex);
    progress = progress_text(step, fraction);
    news = true;
}

void Viewer::Data::set_grid(const ViewerInput& input) {
    const Json grid = grid_json(*view, options.file, input);
    const std::lock_guard lock(news_mutex);
    grid_text = text_of(grid);
    grid_is_new = true;
}

void Viewer::Data::set_failure(const Error& error) {
    if (options.failed && error.code != ErrorCode::cancelled) options.failed(error);
    const std::lock_guard lock(news_mutex);
    failure = error;
    failed_at = now_seconds();
    grid_text = error_text("file", error.message);
    grid_is_new = true;
}

/// The reading thread: the first surfaces come while it packs.
void Viewer::Data::read_and_pack() {
    Run run;
    run.threads = options.threads;
    run.progress.cancel = &stop;
    run.progress.report = [this](std::string_view step, double fraction) { tell_progress(step, fraction); };
    tell_progress("read", 0);
    Result<ViewerInput> input = options.read(run);
    if (!input) return set_failure(input.error());
    GridViewOptions view_options;
    view_options.threads = options.threads;
    view_options.step = input->state.step.value_or(0);
    view_options.steps = std::max<std::size_t>(1, input->times.size());
    view_options.read_step = options.read_step;
    view_options.packed = std::move(input->packed);
    view_options.cells = input->cells;
    view_options.read_cells = options.read_cells;
    view_options.refine = options.refine;
    view_options.regions = input->regions;
    Result<std::unique_ptr<GridView>> made = GridView::create(std::move(input->grid), view_options);
    if (!made) return set_failure(made.error());
    view = *std::move(made);
    set_grid(*input);
    worker->start(std::make_shared<GridFrames>(*view, options.threads));
    Result<void> packed, found;
    for (const bool boundary : {!input->state.isosurfaces, input->state.isosurfaces}) { // what is seen first
        tell_progress(boundary ? "boundary" : "pack", 0);
        if (boundary) found = view->find_boundary(run);
        else packed = view->pack(input->state.field, run);
    }
    worker->start_background();
    if (!packed) return tell_progress("not packed: " + packed.error().message, 1);
    tell_progress(found ? "ready" : "no boundary: " + found.error().message, 1);
}

void Viewer::Data::start() {
    worker.emplace(
        WorkerOutput{[this](PageNumber page, std::string bytes) { server->send_bytes(page, std::move(bytes)); },
                     [this](PageNumber page, std::string text) { server->send_text(page, std::move(text)); }},
        now_seconds);
    downloads = std::make_unique<Downloads>(options.program);
    if (!options.out.empty()) saver = std::make_unique<Saver>(options.program, options.out);
    reader = std::thread([this] { read_and_pack(); });
}

std::size_t Viewer::Data::admitted() const {
    std::size_t count = 0;
    for (const auto& [number, page] : pages) count += page.admitted ? 1 : 0;
    return count;
}

void Viewer::Data::take_hello(ConnectionNumber from, const HelloMessage& message) {
    const auto refuse = [&](std::string_view about, std::string_view sentence) {
        server->send_text(from, error_text(about, sentence));
        server->close(from);
    };
    if (!is_same_token(message.token, options.token))
        return refuse("token", "This address is of an earlier run: open the one that isotet view printed last.");
    if (admitted() >= options.max_pages)
        return refuse("pages", fmt::format("{} pages are open already, which is the limit.", options.max_pages));
    pages[from].admitted = true;
    alone_until.reset();
    longest_wait.reset();
    worker->add_page(from);
    server->send_text(from, text_of(welcome_json(options.file, options.version, options.out)));
    const std::lock_guard lock(news_mutex);
    if (failure && !std::exchange(failure_told, true)) failed_at = now_seconds();
    if (!grid_text.empty()) server->send_text(from, grid_text);
    if (!progress.empty()) server->send_text(from, progress);
}

void Viewer::Data::save(ConnectionNumber from, const SaveRequest& request) {
    const auto refuse = [&](std::string_view sentence) { server->send_text(from, error_text("save", sentence)); };
    if (!saver)
        return refuse("Nothing can be saved on the server: isotet view --out FOLDER lets the page write there.");
    Result<std::vector<std::string>> words = save_words(request, saver->folder(), options.file, options.reading);
    if (!words) return refuse(words.error().message);
    const std::string name = request.name;
    Result<void> started = saver->start(*std::move(words), name, [this, from, name](const Result<std::string>& path) {
        server->send_text(from, path ? text_of({{"say", "saved"}, {"name", name}, {"path", *path}})
                                     : error_text("save", path.error().message));
    });
    if (!started) return refuse(started.error().message);
    saving_for = from;
}

void Viewer::Data::download(ConnectionNumber from, const SaveRequest& request) {
    const auto tell = [this, from](const Result<Download>& file) {
        if (file) server->send_text(from, text_of({{"say", "download"}, {"name", file->name}, {"bytes", file->bytes}}));
        else server->send_text(from, error_text("save", file.error().message));
    };
    const Result<void> started = downloads->start(from, request, options.file, options.reading, tell);
    if (!started) tell(started.error());
}

void Viewer::Data::answer(ConnectionNumber from, PageMessage message) {
    if (auto* show = std::get_if<ShowMessage>(&message)) {
        if (show->refined) worker->ask_refined(from, std::move(*show));
        else worker->wish(from, std::move(*show));
    } else if (std::holds_alternative<ShownMessage>(message)) worker->acknowledge(from);
    else if (auto* chart = std::get_if<ChartMessage>(&message)) worker->ask_chart(from, std::move(*chart));
    else if (auto* spectrum = std::get_if<SpectrumMessage>(&message))
        worker->ask_spectrum(from, std::move(*spectrum));
    else if (auto* pick = std::get_if<PickMessage>(&message)) worker->ask_pick(from, std::move(*pick));
    else if (auto* parts = std::get_if<PartsMessage>(&message)) worker->ask_parts(from, std::move(*parts));
    else if (auto* share = std::get_if<ShareMessage>(&message)) worker->ask_share(from, std::move(*share));
    else if (const auto* wanted = std::get_if<SaveMessage>(&message)) {
        if (wanted->download) download(from, wanted->request);
        else save(from, wanted->request);
    } else if (std::holds_alternative<PartMessage>(message))
        server->send_bytes(from, part_bytes(downloads->next_part(from)));
    else if (const auto* command = std::get_if<CommandMessage>(&message)) {
        server->send_text(
            from, text_of({{"say", "command"},
                           {"render", shell_text(render_words(command->state, options.file, options.reading))},
                           {"extract", shell_text(extract_words(command->state, options.file, options.reading))}}));
    } else if (const auto* paste = std::get_if<PasteMessage>(&message)) {
        const Result<PastedCommand> pasted = state_of_command(paste->text, options.reading);
        if (!pasted) return server->send_text(from, error_text("paste", pasted.error().message));
        const bool other = !pasted->file.empty() && pasted->file != options.file;
        server->send_text(from, pasted_text(*pasted, other));
    }
}

void Viewer::Data::take_message(ConnectionNumber from, std::string_view text) {
    const auto page = pages.find(from);
    if (page == pages.end()) return;
    Result<PageMessage> message = parse_page_message(text);
    if (!message) {
        server->send_text(from, error_text("message", message.error().message));
        if (!page->second.admitted) server->close(from);
        return;
    }
    const auto* hello = std::get_if<HelloMessage>(&*message);
    if (page->second.admitted) {
        if (!hello) answer(from, *std::move(message));
    } else if (hello) take_hello(from, *hello);
    else server->close(from);
}

void Viewer::Data::page_closed(ConnectionNumber which, Parting parting) {
    const auto page = pages.find(which);
    if (page == pages.end()) return;
    const bool was_admitted = page->second.admitted;
    pages.erase(page);
    if (!was_admitted) return;
    worker->remove_page(which);
    if (saver && saving_for == which) saver->stop();
    downloads->forget(which);
    const double until = now_seconds() + (parting == Parting::lost ? options.lost_seconds : options.linger_seconds);
    if (!longest_wait || *longest_wait < until) {
        longest_wait = until;
        last_parting = parting;
    }
    if (admitted() == 0) alone_until = longest_wait;
}

void Viewer::Data::tell_pages() {
    const std::lock_guard lock(news_mutex);
    const bool tell_grid = std::exchange(grid_is_new, false), tell_news = std::exchange(news, false);
    for (const auto& [number, page] : pages) {
        if (!page.admitted) continue;
        if (tell_grid) server->send_text(number, grid_text);
        if (tell_news) server->send_news(number, progress);
        if (tell_grid && failure && !std::exchange(failure_told, true)) failed_at = now_seconds();
    }
}

/// Whether an error of reading was told to a page, or there is none to tell it to.
bool Viewer::Data::has_failed(double now) {
    constexpr double last_words = 1; // seconds for a page to take what it is told
    const std::lock_guard lock(news_mutex);
    return failure && now - failed_at > (failure_told ? last_words : options.failure_seconds);
}

/// Pages that hear nothing take the connection for lost.
void Viewer::Data::say_alive(double now) {
    if (now - said_alive < alive_seconds) return;
    said_alive = now;
    for (const auto& [number, page] : pages)
        if (page.admitted) server->send_text(number, text_of({{"say", "alive"}}));
}

bool Viewer::Data::was_left(double now) {
    if (!alone_until || now < *alone_until || options.keep) return false;
    reason = last_parting == Parting::lost
                 ? fmt::format("no page came back in the {} after its connection was lost",
                               duration_text(options.lost_seconds))
                 : fmt::format("the last page was closed {} ago; with --keep isotet view goes on",
                               duration_text(options.linger_seconds));
    return true;
}

bool Viewer::Data::tick() {
    worker->look_for_stale_work();
    const double now = now_seconds();
    for (const auto& [number, page] : pages)
        if (!page.admitted && now - page.since > hello_seconds) server->close(number);
    tell_pages();
    say_alive(now);
    if (options.is_left && options.is_left()) return false;
    return !*asked_to_stop && !was_left(now) && !has_failed(now);
}

Viewer::Viewer(std::unique_ptr<Data> data) : data_(std::move(data)) {}
Viewer::~Viewer() = default;

Result<std::unique_ptr<Viewer>> Viewer::open(ViewerOptions options) {
    auto data = std::make_unique<Data>();
    data->options = std::move(options);
    if (data->options.token.empty()) {
        Result<std::string> token = random_token();
        if (!token) return token.error();
        data->options.token = *std::move(token);
    }
    ServerOptions server_options;
    server_options.port = data->options.port;
    server_options.hosts = data->options.hosts;
    server_options.listen = data->options.listen;
    server_options.files = page_files();
    Data* all = data.get();
    ServerEvents events;
    events.opened = [all](ConnectionNumber which) { all->pages[which] = {false, now_seconds()}; };
    events.message = [all](ConnectionNumber from, std::string_view text) { all->take_message(from, text); };
    events.closed = [all](ConnectionNumber which, Parting parting) { all->page_closed(which, parting); };
    events.tick = [all] { return all->tick(); };
    Result<Server> server = Server::open(std::move(server_options), std::move(events));
    if (!server) return server.error();
    data->server = *std::move(server);
    return std::unique_ptr<Viewer>(new Viewer(std::move(data)));
}

std::uint16_t Viewer::port() const noexcept { return data_->server->port(); }

const std::string& Viewer::token() const noexcept { return data_->options.token; }

std::string Viewer::address() const {
    const std::string& listen = data_->options.listen;
    const std::string& token = data_->options.token;
    if (listen.starts_with("unix:")) return fmt::format("http://localhost:{}/#{}", forwarded_port, token);
    const bool anywhere = listen.empty() || listen == "0.0.0.0" || listen == "::";
    const bool brackets = !anywhere && listen.find(':') != std::string::npos;
    return fmt::format("http://{}{}{}:{}/#{}", brackets ? "[" : "", anywhere ? "127.0.0.1" : listen,
                       brackets ? "]" : "", port(), token);
}

const std::string& Viewer::reason() const noexcept { return data_->reason; }

Result<void> Viewer::run(const std::atomic<bool>& stop) {
    data_->asked_to_stop = &stop;
    data_->start();
    data_->server->run();
    data_->stop = true; // of reading and packing
    data_->reader.join();
    data_->worker.reset();
    data_->saver.reset();
    data_->downloads.reset();
    const std::lock_guard lock(data_->news_mutex);
    if (data_->failure && data_->failure->code != ErrorCode::cancelled) return *data_->failure;
    return {};
}

} // namespace isotet::view
