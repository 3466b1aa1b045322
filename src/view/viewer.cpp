// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/viewer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <sys/random.h>

#include "view/server/page.hpp"
#include "view/server/server.hpp"
#include "view/server/viewed_file.hpp"

namespace isotet::view {

namespace {

constexpr int forwarded_port = 8123; ///< in what is told of a Unix socket
constexpr double hello_seconds = 5;  ///< within which a page says its token
constexpr double alive_seconds = 4;  ///< between two messages that tell a page that the line is there

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
    const std::atomic<bool>* asked_to_stop = nullptr;
    std::vector<std::unique_ptr<ViewedFile>> files; ///< in the order of ServerOptions::sockets

    /// Who is connected: `admitted` once the token was right.
    struct Page {
        std::size_t file = 0; ///< number of the one that it shows
        bool admitted = false;
        double since = 0;
    };
    std::map<ConnectionNumber, Page> pages; ///< of the server's thread
    std::optional<double> alone_until;      ///< while there is no admitted page: when it all ends
    bool was_opened = false;                ///< a page was admitted
    Parting last_parting = Parting::closed; ///< of the page that may come back longest
    std::optional<double> longest_wait;     ///< for a page that went since one was admitted
    double said_alive = 0;
    std::string reason; ///< why it ended

    void start();
    void take_message(ConnectionNumber from, std::string_view text);
    void take_hello(ConnectionNumber from, const HelloMessage& message);
    void page_closed(ConnectionNumber which, Parting parting);
    bool has_failed(double now) const;
    bool was_left(double now);
    void say_alive(double now);
    bool tick();
    std::size_t admitted() const;
};

void Viewer::Data::start() {
    alone_until = now_seconds() + options.unopened_seconds;
    const auto name = [](const ViewerFile* file) { return file ? file->name : std::string(); };
    const ViewerFile* second = options.second ? &*options.second : nullptr;
    files.push_back(std::make_unique<ViewedFile>(options.file, options, name(second), *server));
    if (second) files.push_back(std::make_unique<ViewedFile>(*second, options, options.file.name, *server));
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
        return refuse("pages",
                      fmt::format("{} {} open already, which is the limit; isotet view --pages N sets another one.",
                                  options.max_pages, options.max_pages == 1 ? "page is" : "pages are"));
    pages[from].admitted = was_opened = true;
    alone_until.reset();
    longest_wait.reset();
    files[pages[from].file]->add_page(from);
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
        if (!hello) files[page->second.file]->answer(from, *std::move(message));
    } else if (hello) take_hello(from, *hello);
    else server->close(from);
}

void Viewer::Data::page_closed(ConnectionNumber which, Parting parting) {
    const auto page = pages.find(which);
    if (page == pages.end()) return;
    const Page gone = page->second;
    pages.erase(page);
    if (!gone.admitted) return;
    files[gone.file]->remove_page(which);
    const double until = now_seconds() + (parting == Parting::lost ? options.lost_seconds : options.linger_seconds);
    if (!longest_wait || *longest_wait < until) {
        longest_wait = until;
        last_parting = parting;
    }
    if (admitted() == 0) alone_until = longest_wait;
}

/// Whether no file can be read, and a page was told of each, or there is none to tell it to.
bool Viewer::Data::has_failed(double now) const {
    constexpr double last_words = 1; // seconds for a page to take what it is told
    return std::ranges::all_of(files, [&](const auto& file) {
        const auto failure = file->failure();
        return failure && now - failure->at > (failure->told ? last_words : options.failure_seconds);
    });
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
    reason = !was_opened ? fmt::format("no page was opened within {}; with --keep isotet view waits on",
                                       duration_text(options.unopened_seconds))
             : last_parting == Parting::lost
                 ? fmt::format("no page came back in the {} after its connection was lost",
                               duration_text(options.lost_seconds))
                 : fmt::format("the last page was closed {} ago; with --keep isotet view goes on",
                               duration_text(options.linger_seconds));
    return true;
}

bool Viewer::Data::tick() {
    const double now = now_seconds();
    for (const auto& [number, page] : pages)
        if (!page.admitted && now - page.since > hello_seconds) server->close(number);
    for (const auto& file : files) file->tick();
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
    if (data->options.second) server_options.sockets.emplace_back("second");
    Data* all = data.get();
    ServerEvents events;
    events.opened = [all](ConnectionNumber which, std::size_t socket) {
        all->pages[which] = {socket, false, now_seconds()};
    };
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
    const std::string place = (data_->options.second ? "beside.html?second#" : "#") + data_->options.token;
    if (listen.starts_with("unix:")) return fmt::format("http://localhost:{}/{}", forwarded_port, place);
    const bool anywhere = listen.empty() || listen == "0.0.0.0" || listen == "::";
    const bool brackets = !anywhere && listen.find(':') != std::string::npos;
    return fmt::format("http://{}{}{}:{}/{}", brackets ? "[" : "", anywhere ? "127.0.0.1" : listen, brackets ? "]" : "",
                       port(), place);
}

const std::string& Viewer::reason() const noexcept { return data_->reason; }

Result<void> Viewer::run(const std::atomic<bool>& stop) {
    data_->asked_to_stop = &stop;
    data_->start();
    data_->server->run();
    std::optional<Error> error;
    std::size_t failed = 0;
    for (const auto& file : data_->files)
        if (const auto failure = file->failure(); failure && failure->error.code != ErrorCode::cancelled) {
            ++failed;
            if (!error) error = failure->error;
        }
    const bool all_failed = failed == data_->files.size();
    data_->files.clear();
    if (all_failed) return *error;
    return {};
}

} // namespace isotet::view
