// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet view` and the browser that it starts: a script in place of xdg-open, which ends isotet.
#include <cstdlib>
#include <filesystem>

#include "program.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

TEST(ViewCommand, StartsTheBrowserWithAFileOfTheUserAndTellsTheTokenToNobodyElse) {
    const TemporaryFolder folder;
    folder.write_script("bin/xdg-open", "printf %s \"$*\" > '" + folder.file("words") + "'\n"
                                        "page=$(printf %s \"$1\" | sed 's,^file://,,; s,%20, ,g')\n"
                                        "stat -c %a \"$page\" > '" + folder.file("mode") + "'\n"
                                        "stat -c %a \"$(dirname \"$page\")\" >> '" + folder.file("mode") + "'\n"
                                        "cp \"$page\" '" + folder.file("page") + "'\n"
                                        "kill -INT $PPID");
    for (const bool has_runtime_folder : {true, false}) {
        const std::string place = folder.file(has_runtime_folder ? "of the session" : "temporary");
        std::filesystem::create_directories(place);
        RunOptions options;
        options.environment = {{"DISPLAY", ":99"},
                               {"SSH_CONNECTION", ""},
                               {"PATH", folder.file("bin") + ":" + std::getenv("PATH")},
                               {"XDG_STATE_HOME", folder.file("state")},
                               {"XDG_RUNTIME_DIR", has_runtime_folder ? place : folder.file("nowhere")},
                               {"TMPDIR", place}};
        const RunResult run = isotet({"view", "make:kuhn:4"}, options);
        EXPECT_EQ(run.status, 0) << run.err;
        const std::string address = run.out.substr(0, run.out.find('\n'));
        const std::size_t hash = address.find('#');
        ASSERT_NE(hash, std::string::npos) << run.out;
        const std::string words = content_of(folder.file("words"));
        EXPECT_TRUE(words.starts_with("file://")) << words;
        EXPECT_EQ(words.find(address.substr(hash + 1)), std::string::npos) << "the token is seen by all users";
        EXPECT_EQ(content_of(folder.file("mode")), "600\n700\n");
        EXPECT_NE(content_of(folder.file("page")).find("url=" + address + "\""), std::string::npos);
        EXPECT_TRUE(std::filesystem::is_empty(place)) << "the file goes with isotet";
    }
}

class ViewRecordTest : public testing::Test {
protected:
    /// What is printed before the browser, a script, ends isotet.
    std::string address_of(const std::string& grid, std::vector<std::string> more = {}) {
        folder_.write_script("bin/xdg-open", "kill -INT $PPID");
        RunOptions options;
        options.environment = {{"DISPLAY", ":99"},
                               {"SSH_CONNECTION", ""},
                               {"PATH", folder_.file("bin") + ":" + std::getenv("PATH")},
                               {"XDG_STATE_HOME", folder_.file("state")},
                               {"TMPDIR", folder_.file("")}};
        more.insert(more.begin(), {"view", grid});
        const RunResult run = isotet(more, options);
        EXPECT_EQ(run.status, 0) << run.err;
        return run.out.substr(0, run.out.find('\n'));
    }
    static std::string token_of(const std::string& address) { return address.substr(address.find('#')); }
    std::string record() const { return folder_.file("state/isotet/view.json"); }
    TemporaryFolder folder_;
};

TEST_F(ViewRecordTest, AnAddressIsValidInTheNextRunWithTheSameFile) {
    const std::string first = address_of("make:kuhn:4");
    EXPECT_EQ(token_of(address_of("make:kuhn:4")), token_of(first));
    EXPECT_NE(token_of(address_of("make:kuhn:5")), token_of(first));
    EXPECT_EQ(token_of(address_of("make:kuhn:4")), token_of(first));
    using std::filesystem::perms;
    EXPECT_EQ(std::filesystem::status(record()).permissions(), perms::owner_read | perms::owner_write);
    EXPECT_EQ(std::filesystem::status(folder_.file("state/isotet")).permissions(), perms::owner_all);
}

TEST_F(ViewRecordTest, ATokenThatOthersMayHaveReadIsNotUsedAgain) {
    const std::string first = address_of("make:kuhn:4");
    std::filesystem::permissions(record(), std::filesystem::perms::group_read, std::filesystem::perm_options::add);
    EXPECT_NE(token_of(address_of("make:kuhn:4")), token_of(first));
    const std::string other = address_of("make:kuhn:4", {"--listen", "0.0.0.0"});
    EXPECT_NE(token_of(address_of("make:kuhn:4", {"--listen", "0.0.0.0"})), token_of(other));
}

TEST_F(ViewRecordTest, ABrokenRecordIsNone) {
    for (const char* text : {"", "{", "[3, {}]", R"([{"file": "make:kuhn:4", "token": "../x", "port": 1}])",
                             R"([{"file": "make:kuhn:4", "token": "00112233445566778899aabbccddeeff",
                                  "port": 99999}])"}) {
        folder_.write("state/isotet/view.json", text);
        using std::filesystem::perms;
        std::filesystem::permissions(record(), perms::owner_read | perms::owner_write);
        const std::string address = address_of("make:kuhn:4");
        EXPECT_EQ(token_of(address).size(), 33U) << text;
        EXPECT_EQ(address.find("00112233445566778899aabbccddeeff"), std::string::npos) << text;
    }
}

} // namespace
} // namespace isotet::test
