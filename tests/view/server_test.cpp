// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The server by itself: news, descriptors, sockets of Unix, addresses.
#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <unistd.h>

#include "support/temporary_folder.hpp"
#include "view/raw_page.hpp"
#include "view/server/server.hpp"

namespace {
std::atomic<int> refused_accepts{0};
}

/// In place of the C library's: counts what is refused.
extern "C" int accept(int socket, sockaddr* address, socklen_t* length) {
    const auto accepted = static_cast<int>(::syscall(SYS_accept4, socket, address, length, 0));
    if (accepted < 0 && errno == EMFILE) ++refused_accepts;
    return accepted;
}

namespace isotet::test {
namespace {

using namespace view;

/// Runs until it is destroyed; `tick` is called by its thread.
class RunningServer {
public:
    explicit RunningServer(ServerOptions options, ServerEvents events = {}) {
        const auto tick = std::move(events.tick);
        events.tick = [this, tick] {
            ++ticks_;
            return !stop_ && (!tick || tick());
        };
        if (!events.closed) events.closed = [](ConnectionNumber, Parting) {};
        for (auto* missing : {&events.opened})
            if (!*missing) *missing = [](ConnectionNumber, std::size_t) {};
        if (!events.message) events.message = [](ConnectionNumber, std::string_view) {};
        server_.emplace(Server::open(std::move(options), std::move(events)).value());
        thread_ = std::thread([this] { server_->run(); });
    }
    ~RunningServer() {
        stop_ = true;
        thread_.join();
    }
    Server& server() { return *server_; }
    std::uint16_t port() const { return server_->port(); }
    void wait_for_ticks(int count) const {
        const int end = ticks_ + count;
        while (ticks_ < end) std::this_thread::yield();
    }

private:
    std::atomic<bool> stop_{false};
    std::atomic<int> ticks_{0};
    std::optional<Server> server_;
    std::thread thread_;
};

TEST(ServerNews, TheLastNewsIsSentOnceNothingElseWaits) {
    std::atomic<ConnectionNumber> connection{0};
    ServerEvents events;
    events.opened = [&](ConnectionNumber which, std::size_t) { connection = which; };
    RunningServer running({}, std::move(events));
    RawPage page(running.port());
    ASSERT_TRUE(page.open_socket());
    while (connection == 0) std::this_thread::yield();
    running.server().send_bytes(connection, std::string(16 << 20, 'x')); // more than a socket holds
    for (const char* news : {"pack", "boundary", "ready"}) running.server().send_news(connection, news);
    ASSERT_EQ(page.read_message().value_or("").size(), 16U << 20);
    EXPECT_EQ(page.read_message().value_or("nothing"), "ready");
    running.server().send_news(connection, "later");
    EXPECT_EQ(page.read_message().value_or("nothing"), "later");
}

TEST(ServerDescriptors, AcceptingIsNotTriedWithoutAPauseWhereNoneIsFree) {
    RunningServer running({});
    running.wait_for_ticks(1);
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
    const int lowest = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    ASSERT_GE(lowest, 0);
    ::close(lowest);
    const rlimit few{static_cast<rlim_t>(lowest) + 1, before.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
    refused_accepts = 0;
    RawPage page(running.port()); // the last descriptor
    while (refused_accepts == 0) std::this_thread::yield();
    running.wait_for_ticks(3);
    const int refused = refused_accepts;
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
    EXPECT_LE(refused, 10);
    page.send_request("/", "Host: localhost\r\n");
    EXPECT_TRUE(page.read_to_end().starts_with("HTTP/1.1 404")) << "it is served when one is free again";
}

/// A name of a socket that no program listens at.
void leave_a_socket(const std::string& path) {
    const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof(address.sun_path) - 1);
    ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    ::close(socket);
}

TEST(ServerOfAUnixSocket, TakesOverOneThatWasLeftBehindAndNoOther) {
    const TemporaryFolder folder;
    const std::string path = folder.file("view.sock");
    leave_a_socket(path);
    ServerOptions options;
    options.listen = "unix:" + path;
    {
        const RunningServer running(options);
        struct stat status{};
        ASSERT_EQ(::stat(path.c_str(), &status), 0);
        EXPECT_EQ(status.st_mode & 0777U, 0600U);
        const auto second = Server::open(options, {});
        ASSERT_FALSE(second) << "a server that lives";
        EXPECT_NE(second.error().message.find("in use"), std::string::npos) << second.error().message;
    }
    EXPECT_NE(::access(path.c_str(), F_OK), 0) << "it is removed at the end";
    folder.write("view.sock", "a file");
    EXPECT_FALSE(Server::open(options, {}));
    EXPECT_EQ(::access(path.c_str(), F_OK), 0);
}

TEST(ServerOfAUnixSocket, LeavesTheMaskOfOtherThreadsAlone) {
    const TemporaryFolder folder;
    std::atomic<bool> stop{false}, strange{false};
    std::thread looks([&] {
        for (int i = 0; !stop; ++i) {
            const std::string name = folder.write("file" + std::to_string(i % 8), "x");
            struct stat status{};
            strange = strange || (::stat(name.c_str(), &status) == 0 && (status.st_mode & 0077U) == 0);
            ::unlink(name.c_str());
        }
    });
    ServerOptions options;
    options.listen = "unix:" + folder.file("view.sock");
    for (int i = 0; i < 200; ++i) EXPECT_TRUE(Server::open(options, {}));
    stop = true;
    looks.join();
    EXPECT_FALSE(strange);
}

TEST(ServerOfAllAddresses, AnswersToEachOfThemAndToNoOtherName) {
    for (const char* listen : {"0.0.0.0", "::"}) {
        ServerOptions options;
        options.listen = listen;
        RunningServer running(options);
        const auto status_for = [&](const std::string& host) {
            RawPage page(running.port());
            page.send_request("/", "Host: " + host + "\r\n");
            return page.read_to_end().substr(9, 3);
        };
        for (const char* host :
             {"192.168.1.7:8123", "10.0.0.1", "[fe80::1]:80", "[2001:db8::7]", "localhost", "127.0.0.1"})
            EXPECT_EQ(status_for(host), "404") << host << ": admitted, but there is no such file";
        for (const char* host : {"example.org", "192.168.1.7.example.org", "1.2.3.4:80@evil.org", "[evil]", "fe80::1",
                                 "[1.2.3.4]", "", "[]", "256.1.1.1", "1.2.3"})
            EXPECT_EQ(status_for(host), "403") << host;
        const std::string own = "192.168.1.7:" + std::to_string(running.port());
        EXPECT_TRUE(RawPage(running.port()).open_socket("http://" + own, own));
        EXPECT_FALSE(RawPage(running.port()).open_socket("http://192.168.1.8:1", own)) << "a page of another server";
    }
    RunningServer one({});
    RawPage page(one.port());
    page.send_request("/", "Host: 192.168.1.7\r\n");
    EXPECT_EQ(page.read_to_end().substr(9, 3), "403") << "which listens at 127.0.0.1 alone";
}

} // namespace
} // namespace isotet::test
