// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Files that pages save, by scripts in place of isotet.
#include <gtest/gtest.h>

#include <filesystem>
#include <future>
#include <string>
#include <thread>

#include "support/temporary_folder.hpp"
#include "view/export/save.hpp"

namespace isotet::test {
namespace {

using namespace view;

class SaverTest : public testing::Test {
protected:
    /// What becomes of a file that `commands` write; "$1" is its path.
    Result<std::string> save(const std::string& name, const std::string& commands) {
        Saver saver(scripts_.write_script("isotet", commands), out_.file(""));
        std::promise<Result<std::string>> promise;
        const Result<void> started = saver.start({"isotet", out_.file(name)}, name,
                                                 [&](Result<std::string> done) { promise.set_value(std::move(done)); });
        if (!started) return started.error();
        return promise.get_future().get();
    }
    std::size_t entries() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(out_.file("")), {}));
    }
    static std::string content(const std::string& path) {
        std::ifstream file(path);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    TemporaryFolder out_, scripts_;
};

TEST_F(SaverTest, WritesANewFileAndLeavesNothingElse) {
    const auto saved = save("a.png", "printf picture > \"$1\"");
    ASSERT_TRUE(saved) << saved.error().message;
    EXPECT_EQ(content(*saved), "picture");
    EXPECT_EQ(entries(), 1U);
    EXPECT_FALSE(save("a.png", "printf other > \"$1\""));
    EXPECT_EQ(content(out_.file("a.png")), "picture");
}

TEST_F(SaverTest, ReplacesNothingThatComesMeanwhile) {
    const auto saved = save("a.png", "printf mine > '" + out_.file("a.png") + "'; printf picture > \"$1\"");
    ASSERT_FALSE(saved);
    EXPECT_NE(saved.error().message.find("'a.png' is there already"), std::string::npos) << saved.error().message;
    EXPECT_EQ(content(out_.file("a.png")), "mine");
    EXPECT_EQ(entries(), 1U);
}

TEST_F(SaverTest, FollowsNoLinkThatComesMeanwhile) {
    const std::string elsewhere = scripts_.write("private", "mine");
    EXPECT_FALSE(save("a.png", "ln -s '" + elsewhere + "' '" + out_.file("a.png") + "'; printf picture > \"$1\""));
    EXPECT_EQ(content(elsewhere), "mine");
    EXPECT_FALSE(
        save("b.png", "ln -s '" + scripts_.file("new") + "' '" + out_.file("b.png") + "'; printf picture > \"$1\""));
    EXPECT_FALSE(std::filesystem::exists(scripts_.file("new")));
}

TEST_F(SaverTest, TellsWhatTheProgramSaidAboutTheNamedFile) {
    const auto saved = save("a.png", "echo \"isotet: $1: the disk is full\" >&2; exit 5");
    ASSERT_FALSE(saved);
    EXPECT_EQ(saved.error().message,
              "isotet: " + std::filesystem::path(out_.file("")).string() + "/a.png: the disk is full");
    EXPECT_EQ(entries(), 0U);
}

TEST_F(SaverTest, EndsWhenItIsToldTo) {
    Saver saver(scripts_.write_script("isotet",
                                      "echo > '" + scripts_.file("begun") + "'; printf half > \"$1\"; exec sleep 1000"),
                out_.file(""));
    std::promise<Result<std::string>> promise;
    ASSERT_TRUE(saver.start({"isotet", out_.file("a.png")}, "a.png",
                            [&](Result<std::string> done) { promise.set_value(std::move(done)); }));
    while (!std::filesystem::exists(scripts_.file("begun"))) std::this_thread::yield();
    saver.stop();
    EXPECT_FALSE(promise.get_future().get());
    EXPECT_EQ(entries(), 0U);
}

} // namespace
} // namespace isotet::test
