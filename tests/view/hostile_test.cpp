// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The real server on loopback: pages that are right, pages that are wrong, and what is no page.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <string_view>
#include <thread>
#include <vector>

#include <isotet/make.hpp>

#include "support/temporary_folder.hpp"
#include "view/frame_reader.hpp"
#include "view/server/page.hpp"
#include "view/raw_page.hpp"
#include "view/viewer.hpp"

namespace isotet::test {
namespace {

using namespace view;

constexpr const char* right_token = "00112233445566778899aabbccddeeff";

class RunningViewer {
public:
    explicit RunningViewer(double linger_seconds = 60, ViewerOptions options = {}) {
        options.file.name = "grid.vtu";
        options.token = right_token;
        options.hosts = {"hub.example.org"};
        options.linger_seconds = linger_seconds;
        options.file.read = [](const Run& run) -> Result<ViewerInput> {
            MakeOptions made;
            made.shape = "kuhn";
            made.side = 6;
            made.fields = {"sphere"};
            Result<Grid> grid = make_grid(made, run);
            if (!grid) return grid.error();
            ViewerInput input;
            input.grid = *std::move(grid);
            input.state.field = "sphere";
            return input;
        };
        viewer_ = Viewer::open(std::move(options)).value();
        thread_ = std::thread([this] { (void)viewer_->run(stop_); });
    }
    ~RunningViewer() {
        stop_ = true;
        join();
    }
    void join() {
        if (thread_.joinable()) thread_.join();
    }
    std::uint16_t port() const { return viewer_->port(); }
    const Viewer& viewer() const { return *viewer_; }

private:
    std::atomic<bool> stop_{false};
    std::unique_ptr<Viewer> viewer_;
    std::thread thread_;
};

std::string answer_to(const RunningViewer& viewer, const std::string& bytes) {
    RawPage page(viewer.port());
    page.send(bytes);
    return page.read_to_end();
}

bool say_hello(RawPage& page, const std::string& token = right_token) {
    return page.open_socket() && page.send_text(R"({"do":"hello","token":")" + token + R"("})");
}

/// The first message that holds a text.
std::optional<std::string> message_with(RawPage& page, std::string_view text) {
    while (auto message = page.read_message())
        if (message->find(text) != std::string::npos) return message;
    return std::nullopt;
}

bool is_served(const RunningViewer& viewer) {
    RawPage page(viewer.port());
    return say_hello(page) && message_with(page, "welcome").has_value();
}

TEST(Server, GivesThePageAndItsFilesAndNothingElse) {
    const RunningViewer viewer;
    const std::string host = "Host: localhost:" + std::to_string(viewer.port()) + "\r\n\r\n";
    const std::string page = answer_to(viewer, "GET / HTTP/1.1\r\n" + host);
    EXPECT_TRUE(page.starts_with("HTTP/1.1 200")) << page.substr(0, 200);
    EXPECT_NE(page.find("Content-Security-Policy: default-src 'none'"), std::string::npos);
    EXPECT_NE(page.find("<!doctype html>"), std::string::npos);
    for (const char* target : {"/", "/?beside", "/beside.html", "/nothing"})
        EXPECT_NE(
            answer_to(viewer, "GET " + std::string(target) + " HTTP/1.1\r\n" + host).find("; frame-ancestors 'self';"),
            std::string::npos)
            << target << " can be framed by other origins";
    for (const ServedFile& file : page_files())
        EXPECT_TRUE(answer_to(viewer, "GET /node/host/8123/" + std::string(file.name) + "?x HTTP/1.1\r\n" + host)
                        .ends_with(file.content))
            << file.name << " below the path of a proxy";
    for (const char* target : {"/etc/passwd", "/../../etc/passwd", "/%2e%2e/etc/passwd", "//", "/x", "/main.js/",
                               "/socket", "/main.js%00", "http://127.0.0.1/passwd"}) {
        const std::string answer = answer_to(viewer, "GET " + std::string(target) + " HTTP/1.1\r\n" + host);
        EXPECT_EQ(answer.find("root:"), std::string::npos) << target;
        EXPECT_TRUE(answer.starts_with("HTTP/1.1 404") || answer.find("<!doctype html>") != std::string::npos)
            << target;
    }
    EXPECT_TRUE(answer_to(viewer, "POST / HTTP/1.1\r\nContent-Length: 0\r\n" + host).starts_with("HTTP/1.1 405"));
    EXPECT_EQ(answer_to(viewer, "HEAD /main.js HTTP/1.1\r\n" + host).find("import"), std::string::npos);
}

// What a browser loads that opens the page: page, style, and all modules that main.js imports, itself or by another.
std::map<std::string_view, std::string_view> loaded_files() {
    std::map<std::string_view, std::string_view> files;
    for (const ServedFile& file : page_files()) files[file.name] = file.content;
    std::map<std::string_view, std::string_view> loaded;
    for (const char* name : {"index.html", "style.css"}) loaded[name] = files.at(name);
    std::vector<std::string_view> waiting{"main.js"};
    while (!waiting.empty()) {
        const std::string_view name = waiting.back();
        waiting.pop_back();
        const std::string_view text = files.at(name);
        if (!loaded.emplace(name, text).second) continue;
        for (std::size_t at = text.find(".js'"); at != text.npos; at = text.find(".js'", at + 1)) {
            const std::size_t from = text.rfind('/', at) + 1;
            waiting.push_back(text.substr(from, at + 3 - from));
        }
    }
    return loaded;
}

TEST(Server, ThePageIsSmallAndNeedsNothingFromElsewhere) {
    for (const ServedFile& file : page_files())
        for (const char* place : {"http://", "https://", "//cdn", "@import", "url("})
            EXPECT_EQ(file.content.find(place), std::string::npos) << file.name << " has " << place;
    std::size_t bytes = 0;
    for (const auto& [name, content] : loaded_files()) bytes += content.size();
    EXPECT_GT(bytes, 100'000U) << "imports that are not found?";
    EXPECT_LT(bytes, 240'000U);
}

TEST(Server, AnswersOnlyToNamesOfThisMachine) {
    const RunningViewer viewer;
    for (const char* host : {"localhost", "127.0.0.1:1", "[::1]:8123", "hub.example.org"})
        EXPECT_TRUE(
            answer_to(viewer, "GET / HTTP/1.1\r\nHost: " + std::string(host) + "\r\n\r\n").starts_with("HTTP/1.1 200"))
            << host;
    for (const char* host : {"evil.example.org", "localhost.evil.org", "127.0.0.1.evil.org", "", "[::1",
                             "evil:127.0.0.1", "localhost:80@evil.org"})
        EXPECT_TRUE(
            answer_to(viewer, "GET / HTTP/1.1\r\nHost: " + std::string(host) + "\r\n\r\n").starts_with("HTTP/1.1 403"))
            << host;
    EXPECT_FALSE(answer_to(viewer, "GET / HTTP/1.0\r\n\r\n").starts_with("HTTP/1.1 200")) << "without Host";
}

TEST(Server, OpensItsSocketToItsOwnPagesOnly) {
    const RunningViewer viewer;
    const std::string own = "127.0.0.1:" + std::to_string(viewer.port());
    for (const std::string& origin : std::vector<std::string>{"http://" + own, "https://hub.example.org"})
        EXPECT_TRUE(RawPage(viewer.port()).open_socket(origin, own)) << origin;
    for (const std::string& origin :
         std::vector<std::string>{std::string(), std::string("null"), std::string("http://evil.example.org"),
                                  std::string("http://localhost:1"), "http://" + own + ".evil.org", "file://" + own,
                                  "http://127.0.0.1", own})
        EXPECT_FALSE(RawPage(viewer.port()).open_socket(origin, own)) << origin;
    EXPECT_FALSE(RawPage(viewer.port()).open_socket("http://evil.org", "evil.org"));
    EXPECT_FALSE(RawPage(viewer.port()).open_socket("http://" + own, own, "/elsewhere"));
}

TEST(Server, AWrongTokenIsToldSoAndGetsNothingElse) {
    const RunningViewer viewer;
    // Empty, too short, too long, and another last digit.
    for (const char* token : {"", "x", "00112233445566778899aabbccddeeff0", "0112233445566778899aabbccddeeff",
                              "00112233445566778899aabbccddeefe"}) {
        RawPage page(viewer.port());
        ASSERT_TRUE(say_hello(page, token));
        const auto message = page.read_message();
        ASSERT_TRUE(message);
        EXPECT_NE(message->find(R"("about":"token")"), std::string::npos);
        EXPECT_FALSE(page.read_message()) << "the connection goes on";
    }
    EXPECT_TRUE(is_served(viewer));
}

TEST(Server, WhoDoesNotSayHelloIsNotAnswered) {
    const RunningViewer viewer;
    RawPage page(viewer.port());
    ASSERT_TRUE(page.open_socket());
    page.send_text(R"({"do":"chart","field":"sphere"})");
    EXPECT_FALSE(page.read_message());
    EXPECT_TRUE(is_served(viewer));
}

TEST(Server, ARightPageGetsGridChartFrameAndCommand) {
    const RunningViewer viewer;
    RawPage page(viewer.port());
    ASSERT_TRUE(say_hello(page));
    ASSERT_TRUE(message_with(page, R"("say":"grid")"));
    page.send_text(R"({"do":"chart","field":"sphere"})");
    EXPECT_TRUE(message_with(page, R"("say":"chart")"));
    page.send_text(R"({"do":"show","number":5,"state":{"field":"sphere","isovalues":[0.7]}})");
    const auto frame = message_with(page, "isof");
    ASSERT_TRUE(frame);
    EXPECT_EQ(head_of(*frame)["number"], 5);
    EXPECT_GT(head_of(*frame)["surfaces"][0]["triangles"], 0);
    page.send_text(R"({"do":"command","state":{"field":"sphere","isovalues":[0.7]}})");
    const auto command = message_with(page, R"("say":"command")");
    ASSERT_TRUE(command);
    EXPECT_NE(command->find("isotet extract grid.vtu --field sphere --isovalue 0.7 -o surface.vtp"), std::string::npos);
    page.send_text(R"({"do":"paste","text":"-i 0.5 --range 3,1"})");
    EXPECT_TRUE(message_with(page, "--range got '3,1'"));
    page.send_text(R"({"do":"show","number":6,"state":{"field":"nothing","isovalues":[0.7]}})");
    EXPECT_TRUE(message_with(page, R"("say":"refused","number":6)"));
}

TEST(Server, SurvivesBrokenRequests) {
    const RunningViewer viewer;
    const std::string own = "127.0.0.1:" + std::to_string(viewer.port());
    for (const std::string& bytes : std::vector<std::string>{
             std::string("\0\0\0\0", 4), std::string("GET"), std::string("\r\n\r\n\r\n"), std::string(1000, 'A'),
             "GET / HTTP/9.9\r\nHost: " + own + "\r\n\r\n", "GET  HTTP/1.1\r\n\r\n",
             "GET / HTTP/1.1\r\nHost: " + own + "\r\nX: " + std::string(20'000, 'x') + "\r\n\r\n",
             "GET / HTTP/1.1\r\nHost: " + own + "\r\nContent-Length: 99999999999\r\n\r\n",
             "GET / HTTP/1.1\r\nHost: " + own + "\r\nTransfer-Encoding: chunked\r\n\r\nfffffff\r\n"}) {
        RawPage page(viewer.port());
        page.send(bytes); // and gone, half-way
    }
    EXPECT_TRUE(is_served(viewer));
}

TEST(Server, SurvivesBrokenMessages) {
    const RunningViewer viewer;
    const std::vector<std::string> frames = {RawPage::frame_head(0x81, 1 << 20),        // larger than allowed
                                             RawPage::frame_head(0x81, UINT64_MAX / 2), // than anything
                                             std::string("\x81\x05hello", 7),           // not masked
                                             std::string("\xff\xff\xff\xff", 4),        // no frame
                                             RawPage::frame_head(0x80, 3) + "abc",      // a continuation of nothing
                                             RawPage::frame_head(0x89, 126) +
                                                 std::string(126, 'x'),                     // a ping that is too long
                                             RawPage::frame_head(0x81, 2) + "\xff\xfe",     // not UTF-8
                                             RawPage::frame_head(0x88, 1) + "x",            // a broken goodbye
                                             RawPage::frame_head(0x01, 10) + "half a mes"}; // and gone
    for (const std::string& frame : frames) {
        RawPage page(viewer.port());
        ASSERT_TRUE(say_hello(page));
        page.send(frame);
    }
    RawPage page(viewer.port());
    ASSERT_TRUE(say_hello(page));
    page.send_text("this is no JSON");
    EXPECT_TRUE(message_with(page, "it is not JSON")) << "a page that errs is told so, and stays";
    page.send_text(R"({"do":"shown","number":3})");
    page.send_text(R"({"do":"command","state":{}})");
    EXPECT_TRUE(message_with(page, R"("say":"command")"));
    EXPECT_TRUE(is_served(viewer));
}

TEST(Server, ManyConnectionsAreShutOutAndTheNextIsServed) {
    const RunningViewer viewer;
    {
        std::vector<std::unique_ptr<RawPage>> silent;
        for (int i = 0; i < 100; ++i) {
            silent.push_back(std::make_unique<RawPage>(viewer.port()));
            silent.back()->send("GET /");
        }
        EXPECT_EQ(silent.back()->read_to_end(), "") << "one too many is closed at once";
    }
    bool served = false;
    for (int attempt = 0; attempt < 100 && !served; ++attempt) served = is_served(viewer);
    EXPECT_TRUE(served);
}

TEST(Server, AFifthPageIsToldThatThereAreFour) {
    const RunningViewer viewer;
    std::vector<std::unique_ptr<RawPage>> pages;
    for (int i = 0; i < 4; ++i) {
        pages.push_back(std::make_unique<RawPage>(viewer.port()));
        ASSERT_TRUE(say_hello(*pages.back()));
        ASSERT_TRUE(message_with(*pages.back(), "welcome"));
    }
    RawPage fifth(viewer.port());
    ASSERT_TRUE(say_hello(fifth));
    EXPECT_TRUE(message_with(fifth, "4 pages are open already"));
    EXPECT_FALSE(fifth.read_message());
}

TEST(Server, APageThatReadsNothingIsNotReadEither) {
    const RunningViewer viewer;
    RawPage greedy(viewer.port());
    ASSERT_TRUE(say_hello(greedy));
    // Each answer is as long as the question: without a limit the server would hold all of them.
    const std::string question = R"({"do":"paste","text":"--camera )" + std::string(30'000, 'x') + R"("})";
    std::thread asks([&] {
        for (int i = 0; i < 2000; ++i)
            if (!greedy.send_text(question)) return;
    });
    EXPECT_TRUE(is_served(viewer)) << "others wait for it";
    for (int i = 0; i < 20; ++i) EXPECT_TRUE(message_with(greedy, "--camera got"));
    greedy.shut();
    asks.join();
    EXPECT_TRUE(is_served(viewer));
}

TEST(Viewer, EndsSomeTimeAfterTheLastPageWasClosed) {
    RunningViewer viewer(0.2);
    {
        RawPage page(viewer.port());
        ASSERT_TRUE(say_hello(page));
        ASSERT_TRUE(message_with(page, "welcome"));
        EXPECT_TRUE(page.send(RawPage::frame_head(0x88, 0))); // says goodbye
        while (page.read_message()) {}
    }
    viewer.join(); // hangs, and is killed, where it does not
    EXPECT_EQ(viewer.viewer().reason(), "the last page was closed 0.2 s ago; with --keep isotet view goes on");
}

TEST(Viewer, EndsSomeTimeAfterTheStartWithoutAPage) {
    ViewerOptions options;
    options.unopened_seconds = 0.2;
    RunningViewer viewer(3600, std::move(options));
    (void)answer_to(viewer, "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"); // is no page
    viewer.join();
    EXPECT_EQ(viewer.viewer().reason(), "no page was opened within 0.2 s; with --keep isotet view waits on");
}

TEST(Viewer, StaysWhereAPageIsOpenOrItIsTold) {
    ViewerOptions options;
    options.unopened_seconds = 1;
    const RunningViewer opened(3600, options);
    options.keep = true;
    options.unopened_seconds = 0.1;
    const RunningViewer kept(3600, options);
    RawPage page(opened.port());
    ASSERT_TRUE(say_hello(page));
    ASSERT_TRUE(message_with(page, "welcome"));
    std::this_thread::sleep_for(std::chrono::milliseconds(1300));
    EXPECT_TRUE(is_served(opened));
    EXPECT_TRUE(is_served(kept));
}

TEST(Viewer, WaitsInAnotherWayForAPageThatLostItsConnection) {
    ViewerOptions options;
    options.lost_seconds = 0.2;
    RunningViewer viewer(3600, std::move(options));
    {
        RawPage page(viewer.port());
        ASSERT_TRUE(say_hello(page));
        ASSERT_TRUE(message_with(page, "welcome"));
    }
    viewer.join();
    EXPECT_EQ(viewer.viewer().reason(), "no page came back in the 0.2 s after its connection was lost");
}

TEST(Viewer, EndsWithWhatStartedIt) {
    std::atomic<bool> left{false};
    ViewerOptions options;
    options.is_left = [&] { return left.load(); };
    RunningViewer viewer(60, std::move(options));
    EXPECT_TRUE(is_served(viewer));
    left = true;
    viewer.join();
    EXPECT_EQ(viewer.viewer().reason(), "");
}

TEST(Viewer, TellsAPageThatTheLineIsThere) {
    const RunningViewer viewer;
    RawPage page(viewer.port());
    ASSERT_TRUE(say_hello(page));
    EXPECT_TRUE(message_with(page, R"("say":"alive")"));
}

TEST(Viewer, WhatAPageSavesEndsWithThePage) {
    const TemporaryFolder scripts, out;
    ViewerOptions options;
    options.out = out.file("");
    options.program = scripts.write_script("isotet", "echo > '" + scripts.file("begun") + "'; exec sleep 1000");
    const RunningViewer viewer(60, std::move(options));
    const auto save = [](RawPage& page) {
        return say_hello(page) && message_with(page, R"("say":"grid")") &&
               page.send_text(R"({"do":"save","kind":"picture","name":"a.png","state":{"isovalues":[0.5]}})");
    };
    {
        RawPage page(viewer.port());
        ASSERT_TRUE(save(page));
        while (!std::filesystem::exists(scripts.file("begun"))) std::this_thread::yield();
    }
    std::filesystem::remove(scripts.file("begun"));
    while (!std::filesystem::exists(scripts.file("begun"))) { // until the next one may begin
        RawPage page(viewer.port());
        ASSERT_TRUE(save(page));
        for (int i = 0; i < 50 && !std::filesystem::exists(scripts.file("begun")); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

TEST(Viewer, TheAddressHoldsATokenOfItsOwnEachTime) {
    const std::string a = random_token().value(), b = random_token().value();
    EXPECT_EQ(a.size(), 32U);
    EXPECT_NE(a, b);
    const RunningViewer viewer;
    EXPECT_EQ(viewer.viewer().address(), "http://127.0.0.1:" + std::to_string(viewer.port()) + "/#" + right_token);
}

TEST(Viewer, AFileThatCannotBeReadIsToldToThePageAndToTheCaller) {
    ViewerOptions options;
    options.token = right_token;
    options.file.read = [](const isotet::Run&) -> Result<ViewerInput> {
        return Error{ErrorCode::file, "it is not there"};
    };
    const auto viewer = Viewer::open(std::move(options)).value();
    std::atomic<bool> stop{false};
    Result<void> result;
    std::thread runs([&] { result = viewer->run(stop); });
    RawPage page(viewer->port());
    EXPECT_TRUE(say_hello(page));
    EXPECT_TRUE(message_with(page, "it is not there"));
    runs.join();
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().message, "it is not there");
}

TEST(Viewer, OfTwoFilesOneIsShownWhereTheOtherCannotBeRead) {
    ViewerOptions options;
    options.second.emplace();
    options.second->name = "other.vtu";
    options.second->read = [](const isotet::Run&) -> Result<ViewerInput> {
        return Error{ErrorCode::file, "it is not there"};
    };
    const RunningViewer viewer(60, std::move(options));
    EXPECT_EQ(viewer.viewer().address(),
              "http://127.0.0.1:" + std::to_string(viewer.port()) + "/beside.html?second#" + right_token);
    const auto say_hello_to = [](RawPage& page, const char* socket, const std::string& token) {
        return page.open_socket("http://" + page.host(), page.host(), socket) &&
               page.send_text(R"({"do":"hello","token":")" + token + R"("})");
    };
    RawPage first(viewer.port()), second(viewer.port()), wrong(viewer.port());
    ASSERT_TRUE(say_hello_to(second, "/proxy/second", right_token));
    EXPECT_TRUE(message_with(second, R"("other":"grid.vtu")"));
    EXPECT_TRUE(message_with(second, "it is not there"));
    ASSERT_TRUE(say_hello_to(first, "/proxy/socket", right_token));
    EXPECT_TRUE(message_with(first, R"("other":"other.vtu")"));
    EXPECT_TRUE(message_with(first, R"("say":"grid")"));
    ASSERT_TRUE(say_hello_to(wrong, "/second", "00000000000000000000000000000000"));
    EXPECT_TRUE(message_with(wrong, R"("about":"token")"));
    EXPECT_TRUE(message_with(second, R"("say":"alive")")) << "the server goes on";
}

TEST(Viewer, OfOneFileThereIsNoSecondOne) {
    const RunningViewer viewer;
    RawPage page(viewer.port());
    EXPECT_FALSE(page.open_socket("http://" + page.host(), page.host(), "/second"));
}

TEST(Viewer, AFileThatCannotBeReadIsToldAtOnceAndWaitsForAPage) {
    std::promise<std::string> told;
    ViewerOptions options;
    options.token = right_token;
    options.file.read = [](const isotet::Run&) -> Result<ViewerInput> {
        return Error{ErrorCode::file, "it is not there"};
    };
    options.failed = [&](const Error& error) { told.set_value(error.message); };
    const auto viewer = Viewer::open(std::move(options)).value();
    std::atomic<bool> stop{false};
    Result<void> result;
    std::thread runs([&] { result = viewer->run(stop); });
    EXPECT_EQ(told.get_future().get(), "it is not there");
    RawPage page(viewer->port());
    EXPECT_TRUE(say_hello(page));
    EXPECT_TRUE(message_with(page, "it is not there"));
    runs.join();
    EXPECT_FALSE(result);
}

TEST(Viewer, DoesNotWaitForeverToTellThatAFileCannotBeRead) {
    ViewerOptions options;
    options.file.read = [](const isotet::Run&) -> Result<ViewerInput> {
        return Error{ErrorCode::file, "it is not there"};
    };
    options.failure_seconds = 0.1;
    const auto viewer = Viewer::open(std::move(options)).value();
    const std::atomic<bool> stop{false};
    EXPECT_FALSE(viewer->run(stop));
}

} // namespace
} // namespace isotet::test
