// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// HTTP and WebSocket for pages on this machine. The only place with sockets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/result.hpp>

namespace isotet::view {

using ConnectionNumber = std::uint64_t;

/// A file that the server gives to everybody who asks for its name.
struct ServedFile {
    std::string_view name; ///< "index.html" is the page itself
    std::string_view type; ///< its MIME type
    std::string_view content;
};

struct ServerOptions {
    std::uint16_t port = 0;         ///< 0: a free one
    std::vector<std::string> hosts; ///< names besides localhost and 127.0.0.1 that a browser may have reached it by
    std::string
        listen; ///< an IP address of the machine; "unix:PATH": a socket there, for its owner alone; empty: 127.0.0.1
    bool any_address = false; ///< a browser may have reached it by any IP address; so it is where it listens at all
    std::vector<std::string> sockets{"socket"}; ///< names of WebSockets
    std::vector<ServedFile> files;              ///< must outlive the server
    std::size_t max_connections = 32;           ///< at once; more are closed
    std::size_t max_message = 65'536;           ///< bytes from a page; a larger one ends its connection
    std::size_t max_waiting = 8; ///< messages to a page that wait: until they are sent, none of it is read
    double request_seconds = 10; ///< within which a request must be there
    double idle_seconds = 40;    ///< a page that answers no ping for so long is gone; pings after half of it
};

/// How a page went.
enum class Parting : std::uint8_t {
    closed, ///< it said so
    lost    ///< its connection ended, or nothing came for ServerOptions::idle_seconds
};

/// What the server tells. Called by the thread of run().
struct ServerEvents {
    std::function<void(ConnectionNumber, std::size_t socket)> opened = {}; ///< which of ServerOptions::sockets
    std::function<void(ConnectionNumber, std::string_view)> message = {};
    std::function<void(ConnectionNumber, Parting)> closed = {};
    std::function<bool()> tick = {}; ///< ten times a second; false ends run()
};

/// Answers GET and HEAD for its files, and opens a WebSocket for a browser whose page came from here: Host
/// must be this machine's or one of `hosts`, and Origin the same as Host or one of `hosts`. Of a path the last part
/// counts, so that it works below a proxy's path. Nothing else of the machine can be reached.
class Server {
public:
    /// Errors   system, when the port cannot be had
    static Result<Server> open(ServerOptions options, ServerEvents events);
    Server(Server&&) noexcept;
    Server& operator=(Server&&) noexcept;
    ~Server();

    std::uint16_t port() const noexcept;

    /// Serves until tick() says false.
    void run();

    /// Sends a message, in the order of calls; to a connection that is gone: nothing. From any thread.
    void send_text(ConnectionNumber to, std::string text);
    void send_bytes(ConnectionNumber to, std::string bytes);
    /// Sends it once nothing else waits to be sent, unless newer news has come by then.
    void send_news(ConnectionNumber to, std::string text);
    /// Ends a connection, after what was sent to it.
    void close(ConnectionNumber which);

private:
    struct Data;
    explicit Server(std::shared_ptr<Data> data);
    std::shared_ptr<Data> data_;
};

} // namespace isotet::view
