// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The one file that includes Boost.
#include "view/server/server.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace isotet::view {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using AnyProtocol = asio::generic::stream_protocol; ///< TCP or a Unix socket
using AnyStream = beast::basic_stream<AnyProtocol>;
using LocalProtocol = asio::local::stream_protocol;

constexpr std::string_view unix_prefix = "unix:";

constexpr std::uint32_t max_header_bytes = 8192;

std::chrono::steady_clock::duration duration_of(double seconds) {
    return std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds));
}

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

/// "localhost:8123" gives "localhost", "[::1]:8123" gives "[::1]"; nothing for what has no port behind its colon.
std::string_view name_of_host(std::string_view host) {
    const std::size_t bracket = host.starts_with('[') ? host.find(']') : 0;
    if (bracket == std::string_view::npos) return {};
    const std::size_t colon = host.find(':', bracket);
    if (colon == std::string_view::npos) return host;
    const bool port = host.find_first_not_of("0123456789", colon + 1) == std::string_view::npos;
    return port ? host.substr(0, colon) : std::string_view();
}

/// "https://a.b:1" gives "a.b:1"; nothing for what no page of a server sends.
std::string_view host_of_origin(std::string_view origin) {
    for (const std::string_view scheme : {"http://", "https://"})
        if (origin.starts_with(scheme)) return origin.substr(scheme.size());
    return {};
}

bool is_listed(const std::vector<std::string>& hosts, std::string_view name) {
    return !name.empty() && std::ranges::find(hosts, name) != hosts.end();
}

/// "192.168.1.2" or "[fe80::1]": no name, which a foreign server could lead here.
bool is_numeric(std::string_view name) {
    const bool brackets = name.size() > 2 && name.front() == '[' && name.back() == ']';
    if (brackets) name = name.substr(1, name.size() - 2);
    beast::error_code error;
    const auto address = asio::ip::make_address(std::string(name), error);
    return !error && address.is_v6() == brackets;
}

bool is_our_host(const ServerOptions& options, std::string_view host) {
    const std::string_view name = name_of_host(host);
    return name == "localhost" || name == "127.0.0.1" || name == "[::1]" || is_listed(options.hosts, name) ||
           (options.any_address && is_numeric(name));
}

bool is_our_origin(const std::vector<std::string>& hosts, std::string_view origin, std::string_view host) {
    const std::string_view from = host_of_origin(origin);
    return !from.empty() && (from == host || is_listed(hosts, name_of_host(from)));
}

/// Whether there is a socket of this user, of a program that has ended without removing it.
bool is_left_behind(asio::io_context& io, const std::string& path) {
    struct stat status{};
    if (::lstat(path.c_str(), &status) != 0 || !S_ISSOCK(status.st_mode) || status.st_uid != ::geteuid()) return false;
    LocalProtocol::socket socket(io);
    beast::error_code error;
    socket.connect(LocalProtocol::endpoint(path), error);
    return error == asio::error::connection_refused;
}

/// The last part of a path, without what follows ?.
std::string_view last_part(std::string_view target) {
    target = target.substr(0, target.find('?'));
    return target.substr(target.rfind('/') + 1);
}

class Connection;

} // namespace

struct Server::Data {
    ServerOptions options;
    ServerEvents events;
    asio::io_context io{1};
    tcp::acceptor acceptor{io};
    LocalProtocol::acceptor local_acceptor{io};
    std::string socket_path; ///< to be removed at the end
    asio::steady_timer timer{io}, accept_timer{io};
    std::uint16_t port = 0;
    ConnectionNumber last = 0;
    std::map<ConnectionNumber, std::shared_ptr<Connection>> open; ///< all sockets

    template <class Acceptor>
    void accept_next(Acceptor& from);
    template <class Acceptor>
    void accept_later(Acceptor& from);
    void listen_locally(const std::string& path, beast::error_code& error);
    void listen_at(const tcp::endpoint& endpoint, beast::error_code& error);
    void wait_for_tick();
    void end();
    template <class Use>
    void with(ConnectionNumber number, Use use);
};

namespace {

/// A socket: first a request, then an answer or a WebSocket.
class Connection : public std::enable_shared_from_this<Connection> {
public:
    /// Work that must outlive the connection's own functions stands in `owner`.
    struct Owner {
        const ServerOptions& options;
        const ServerEvents& events;
        std::function<void(ConnectionNumber)> forget;
    };

    Connection(AnyProtocol::socket socket, ConnectionNumber number, Owner owner)
        : stream_(std::move(socket)), number_(number), owner_(std::move(owner)) {}

    void start();
    void send(std::shared_ptr<const std::string> message, bool text);
    void send_news(std::shared_ptr<const std::string> text);
    void close_when_sent();
    void drop();

private:
    struct Outgoing {
        std::shared_ptr<const std::string> message;
        bool text = true;
    };

    void answer();
    void respond(http::status status, std::string_view type, std::string_view content);
    void open_socket(std::size_t which);
    void read_next();
    void write_next();
    void finish();

    template <class Stream>
    static AnyStream& lowest(Stream& stream) {
        return beast::get_lowest_layer(stream);
    }

    AnyStream stream_;
    std::optional<websocket::stream<AnyStream>> socket_;
    ConnectionNumber number_;
    Owner owner_;
    beast::flat_buffer buffer_;
    std::optional<http::request_parser<http::empty_body>> parser_;
    http::response<http::string_body> response_;
    std::deque<Outgoing> waiting_;            ///< the first one is being written
    std::shared_ptr<const std::string> news_; ///< the newest, once nothing waits
    Parting parting_ = Parting::lost;
    bool reading_ = false, opened_ = false, closing_ = false, finished_ = false;
};

void Connection::start() {
    parser_.emplace();
    parser_->header_limit(max_header_bytes);
    parser_->body_limit(0);
    stream_.expires_after(duration_of(owner_.options.request_seconds));
    http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](beast::error_code error, std::size_t) {
        if (error) self->finish();
        else self->answer();
    });
}

void Connection::answer() {
    const auto& request = parser_->get();
    const std::string_view host = view_of(request[http::field::host]);
    if (!is_our_host(owner_.options, host))
        return respond(http::status::forbidden, "text/plain",
                       "This server answers to localhost only; isotet view --allow-host NAME allows another name.\n");
    if (websocket::is_upgrade(request)) {
        const auto& sockets = owner_.options.sockets;
        const auto named = std::ranges::find(sockets, last_part(view_of(request.target())));
        if (named == sockets.end()) return respond(http::status::not_found, "text/plain", "There is no such socket.\n");
        if (!is_our_origin(owner_.options.hosts, view_of(request[http::field::origin]), host))
            return respond(http::status::forbidden, "text/plain", "Pages of other servers cannot use this one.\n");
        return open_socket(static_cast<std::size_t>(named - sockets.begin()));
    }
    if (request.method() != http::verb::get && request.method() != http::verb::head)
        return respond(http::status::method_not_allowed, "text/plain", "Only GET and HEAD are answered.\n");
    std::string_view name = last_part(view_of(request.target()));
    if (name.empty()) name = "index.html";
    const auto& files = owner_.options.files;
    const auto found = std::ranges::find(files, name, &ServedFile::name);
    if (found == files.end()) return respond(http::status::not_found, "text/plain", "There is no such file.\n");
    respond(http::status::ok, found->type, found->content);
}

void Connection::respond(http::status status, std::string_view type, std::string_view content) {
    response_.result(status);
    response_.version(11);
    response_.keep_alive(false);
    const auto set = [&](const char* name, std::string_view value) {
        response_.set(name, beast::string_view(value.data(), value.size()));
    };
    set("Content-Type", type);
    set("Cache-Control", "no-store");
    set("X-Content-Type-Options", "nosniff");
    set("Referrer-Policy", "no-referrer");
    set("Cross-Origin-Resource-Policy", "same-origin");
    set("Content-Security-Policy", "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
                                   "img-src 'self' data:; frame-src 'self'; frame-ancestors 'self'; "
                                   "base-uri 'none'; form-action 'none'");
    response_.content_length(content.size());
    if (parser_->get().method() != http::verb::head) response_.body() = std::string(content);
    stream_.expires_after(duration_of(owner_.options.request_seconds));
    http::async_write(stream_, response_, [self = shared_from_this()](beast::error_code, std::size_t) {
        beast::error_code ignored;
        self->stream_.socket().shutdown(AnyProtocol::socket::shutdown_both, ignored);
        self->finish();
    });
}

void Connection::open_socket(std::size_t which) {
    stream_.expires_never();
    beast::error_code ignored;
    stream_.socket().set_option(tcp::no_delay(true), ignored); // not of a Unix socket
    socket_.emplace(std::move(stream_));
    websocket::stream_base::timeout timeout{};
    timeout.handshake_timeout = duration_of(owner_.options.request_seconds);
    timeout.idle_timeout = duration_of(owner_.options.idle_seconds);
    timeout.keep_alive_pings = true;
    socket_->set_option(timeout);
    socket_->read_message_max(owner_.options.max_message);
    socket_->auto_fragment(false);
    socket_->async_accept(parser_->get(), [self = shared_from_this(), which](beast::error_code error) {
        self->parser_.reset();
        if (error || self->finished_) return self->finish();
        self->opened_ = true;
        self->buffer_.clear();
        self->owner_.events.opened(self->number_, which);
        self->read_next();
    });
}

void Connection::read_next() {
    if (reading_ || closing_ || finished_ || waiting_.size() >= owner_.options.max_waiting) return;
    reading_ = true;
    socket_->async_read(buffer_, [self = shared_from_this()](beast::error_code error, std::size_t) {
        self->reading_ = false;
        if (error == websocket::error::closed) self->parting_ = Parting::closed;
        if (error) return self->finish();
        const auto bytes = self->buffer_.data();
        const std::string message(static_cast<const char*>(bytes.data()), bytes.size());
        self->buffer_.consume(self->buffer_.size());
        if (!self->closing_) self->owner_.events.message(self->number_, message);
        self->read_next();
    });
}

void Connection::send(std::shared_ptr<const std::string> message, bool text) {
    if (!opened_ || closing_ || finished_) return;
    waiting_.push_back({std::move(message), text});
    if (waiting_.size() == 1) write_next();
}

void Connection::send_news(std::shared_ptr<const std::string> text) {
    if (waiting_.empty()) send(std::move(text), true);
    else news_ = std::move(text);
}

void Connection::write_next() {
    const Outgoing& next = waiting_.front();
    socket_->text(next.text);
    socket_->async_write(asio::buffer(*next.message),
                         [self = shared_from_this()](beast::error_code error, std::size_t) {
                             if (error && self->reading_) return; // the reader ends, too, and knows why
                             if (error) return self->finish();
                             self->waiting_.pop_front();
                             if (!self->waiting_.empty()) return self->write_next();
                             if (self->closing_) return self->finish();
                             if (self->news_) self->send(std::exchange(self->news_, nullptr), true);
                             self->read_next();
                         });
}

void Connection::close_when_sent() {
    closing_ = true;
    if (waiting_.empty()) finish();
}

void Connection::drop() {
    beast::error_code ignored;
    auto& lowest_stream = socket_ ? lowest(*socket_) : stream_;
    lowest_stream.cancel();
    lowest_stream.socket().close(ignored);
}

/// Once: whatever is still going on ends with an error.
void Connection::finish() {
    if (std::exchange(finished_, true)) return;
    drop();
    if (opened_) owner_.events.closed(number_, parting_);
    owner_.forget(number_);
}

} // namespace

template <class Acceptor>
void Server::Data::accept_next(Acceptor& from) {
    from.async_accept([this, &from](beast::error_code error, typename Acceptor::protocol_type::socket socket) {
        if (error == asio::error::operation_aborted) return;
        if (!error && open.size() < options.max_connections) {
            const ConnectionNumber number = ++last;
            auto connection = std::make_shared<Connection>(
                AnyProtocol::socket(std::move(socket)), number,
                Connection::Owner{options, events, [this](ConnectionNumber gone) { open.erase(gone); }});
            open.emplace(number, connection);
            connection->start();
        }
        if (error) return accept_later(from);
        accept_next(from);
    });
}

/// After an error that may last, such as no descriptor being free: at once it would be met again.
template <class Acceptor>
void Server::Data::accept_later(Acceptor& from) {
    accept_timer.expires_after(std::chrono::milliseconds(100));
    accept_timer.async_wait([this, &from](beast::error_code error) {
        if (!error) accept_next(from);
    });
}

/// A socket that its owner alone may open. It takes the place of one without a listener.
void Server::Data::listen_locally(const std::string& path, beast::error_code& error) {
    local_acceptor.open(LocalProtocol(), error);
    if (error) return;
    // Linux gives the name the mode that the socket has, less the umask, which belongs to all threads.
    if (::fchmod(local_acceptor.native_handle(), 0600) != 0) {
        error.assign(errno, beast::system_category());
        return;
    }
    local_acceptor.bind(LocalProtocol::endpoint(path), error);
    if (error == asio::error::address_in_use && is_left_behind(io, path) && ::unlink(path.c_str()) == 0)
        local_acceptor.bind(LocalProtocol::endpoint(path), error);
    if (error) return;
    socket_path = path;
    local_acceptor.listen(16, error);
}

void Server::Data::listen_at(const tcp::endpoint& endpoint, beast::error_code& error) {
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(16, error);
    if (!error) port = acceptor.local_endpoint(error).port();
}

void Server::Data::wait_for_tick() {
    timer.expires_after(std::chrono::milliseconds(100));
    timer.async_wait([this](beast::error_code error) {
        if (error) return;
        if (events.tick && !events.tick()) return end();
        wait_for_tick();
    });
}

void Server::Data::end() {
    beast::error_code ignored;
    acceptor.close(ignored);
    local_acceptor.close(ignored);
    const auto all = open; // drop() may change it
    for (const auto& [number, connection] : all) connection->drop();
    io.stop();
}

/// Calls `use` with the connection, by the thread of run().
template <class Use>
void Server::Data::with(ConnectionNumber number, Use use) {
    asio::post(io, [this, number, use = std::move(use)] {
        const auto found = open.find(number);
        if (found == open.end()) return;
        const std::shared_ptr<Connection> connection = found->second;
        use(*connection);
    });
}

Result<Server> Server::open(ServerOptions options, ServerEvents events) {
    auto data = std::make_shared<Data>();
    data->options = std::move(options);
    data->events = std::move(events);
    const std::string& listen = data->options.listen;
    beast::error_code error;
    if (listen.starts_with(unix_prefix)) {
        const std::string path = listen.substr(unix_prefix.size());
        if (path.empty() || path.size() > 100)
            return Error{
                ErrorCode::invalid_argument,
                fmt::format("the path of a Unix socket has 1 to 100 bytes, but '{}' has {}", path, path.size())};
        data->listen_locally(path, error);
        if (error)
            return Error{ErrorCode::system, fmt::format("a socket at {} cannot be made: {}", path, error.message())};
        return Server(std::move(data));
    }
    const auto address = asio::ip::make_address(listen.empty() ? "127.0.0.1" : listen, error);
    if (error)
        return Error{ErrorCode::invalid_argument,
                     fmt::format("'{}' is neither an IP address to serve at, nor unix:PATH", listen)};
    data->options.any_address = address.is_unspecified();
    if (!address.is_unspecified()) data->options.hosts.push_back(address.is_v6() ? "[" + listen + "]" : listen);
    data->listen_at({address, data->options.port}, error);
    if (error)
        return Error{ErrorCode::system, fmt::format("port {} of {} cannot be had: {}", data->options.port,
                                                    address.to_string(), error.message())};
    return Server(std::move(data));
}

Server::Server(std::shared_ptr<Data> data) : data_(std::move(data)) {}
Server::Server(Server&&) noexcept = default;
Server& Server::operator=(Server&&) noexcept = default;
Server::~Server() {
    if (!data_) return;
    data_->open.clear();
    if (!data_->socket_path.empty()) ::unlink(data_->socket_path.c_str());
}

std::uint16_t Server::port() const noexcept { return data_->port; }

void Server::run() {
    if (data_->acceptor.is_open()) data_->accept_next(data_->acceptor);
    if (data_->local_acceptor.is_open()) data_->accept_next(data_->local_acceptor);
    data_->wait_for_tick();
    data_->io.run();
}

void Server::send_text(ConnectionNumber to, std::string text) {
    data_->with(to, [text = std::make_shared<const std::string>(std::move(text))](Connection& connection) {
        connection.send(text, true);
    });
}

void Server::send_bytes(ConnectionNumber to, std::string bytes) {
    data_->with(to, [bytes = std::make_shared<const std::string>(std::move(bytes))](Connection& connection) {
        connection.send(bytes, false);
    });
}

void Server::send_news(ConnectionNumber to, std::string text) {
    data_->with(to, [text = std::make_shared<const std::string>(std::move(text))](Connection& connection) {
        connection.send_news(text);
    });
}

void Server::close(ConnectionNumber which) {
    data_->with(which, [](Connection& connection) { connection.close_when_sent(); });
}

} // namespace isotet::view
