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

} // namespace
} // namespace isotet::test
