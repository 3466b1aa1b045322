// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A page without manners: bytes to a port of this machine, and WebSocket frames made by hand.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace isotet::test {

class RawPage {
public:
    explicit RawPage(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)), port_(port) {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(port);
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof(to)) == 0;
    }
    RawPage(const RawPage&) = delete;
    RawPage& operator=(const RawPage&) = delete;
    ~RawPage() { ::close(socket_); }

    bool connected() const { return connected_; }

    /// Both directions end, also for another thread that sends.
    void shut() { ::shutdown(socket_, SHUT_RDWR); }

    bool send(std::string_view bytes) {
        while (!bytes.empty()) {
            const auto sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (sent <= 0) return false;
            bytes.remove_prefix(static_cast<std::size_t>(sent));
        }
        return true;
    }

    /// Everything until the other side closes.
    std::string read_to_end() {
        while (read_more()) {}
        return std::move(come_);
    }

    /// "Host: ...\r\nOrigin: ..." and so on stand in `headers`.
    bool send_request(const std::string& target, const std::string& headers) {
        return send("GET " + target + " HTTP/1.1\r\n" + headers + "\r\n");
    }
    std::string host() const { return "127.0.0.1:" + std::to_string(port_); }

    /// True when the server takes it for a WebSocket.
    bool open_socket(const std::string& origin, const std::string& named_host, const std::string& target = "/socket") {
        send_request(target, "Host: " + named_host + "\r\n" + (origin.empty() ? "" : "Origin: " + origin + "\r\n") +
                                 "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                                 "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n");
        while (come_.find("\r\n\r\n") == std::string::npos)
            if (!read_more()) return false;
        const bool opened = come_.starts_with("HTTP/1.1 101");
        come_.erase(0, come_.find("\r\n\r\n") + 4);
        return opened;
    }
    bool open_socket() { return open_socket("http://" + host(), host()); }

    /// A text message, masked with zeros.
    bool send_text(std::string_view text) { return send(frame_head(0x81, text.size()) + std::string(text)); }
    static std::string frame_head(unsigned char first, std::uint64_t size) {
        std::string head(1, static_cast<char>(first));
        if (size < 126) head += static_cast<char>(0x80 | size);
        else if (size < 65536) head += std::string{'\xfe', static_cast<char>(size >> 8), static_cast<char>(size)};
        else {
            head += '\xff';
            for (int shift = 56; shift >= 0; shift -= 8) head += static_cast<char>(size >> shift);
        }
        return head + std::string(4, '\0');
    }

    /// The next message; nothing when the connection ends. Pings are passed over.
    std::optional<std::string> read_message() {
        while (true) {
            if (!wait_for(2)) return std::nullopt;
            const auto first = static_cast<unsigned char>(come_[0]);
            std::size_t head = 2;
            std::uint64_t size = static_cast<unsigned char>(come_[1]) & 0x7f;
            const std::size_t more = size == 126 ? 2 : size == 127 ? 8 : 0;
            if (!wait_for(head + more)) return std::nullopt;
            if (more > 0) size = 0;
            for (std::size_t i = 0; i < more; ++i) size = size << 8 | static_cast<unsigned char>(come_[head + i]);
            head += more;
            if (!wait_for(head + size)) return std::nullopt;
            const std::string message = come_.substr(head, size);
            come_.erase(0, head + size);
            const unsigned kind = first & 0x0f;
            if (kind == 8) return std::nullopt;
            if (kind == 1 || kind == 2) return message;
        }
    }

private:
    bool wait_for(std::size_t bytes) {
        while (come_.size() < bytes)
            if (!read_more()) return false;
        return true;
    }
    /// False at the end, and when nothing comes for 20 seconds.
    bool read_more() {
        pollfd waits{socket_, POLLIN, 0};
        if (::poll(&waits, 1, 20'000) <= 0) return false;
        char buffer[65536];
        const auto got = ::recv(socket_, buffer, sizeof(buffer), 0);
        if (got <= 0) return false;
        come_.append(buffer, static_cast<std::size_t>(got));
        return true;
    }

    int socket_;
    std::uint16_t port_;
    bool connected_ = false;
    std::string come_;
};

} // namespace isotet::test
