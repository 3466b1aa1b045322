// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the walk over the option tree prints.
#include "program.hpp"

namespace isotet::test {
namespace {

TEST_F(Program, MarkdownIsWhatDocsCommandLineHolds) {
    const RunResult run = isotet({"docs", "markdown"});
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(content_of((source_folder() / "docs/command-line.md").string()), run.out)
        << "renew it: isotet docs markdown > docs/command-line.md";
}

TEST_F(Program, ManPageNamesEveryOptionOfTheHelp) {
    const std::string man = isotet({"docs", "man"}).out;
    for (const char* command : {"info", "extract", "check", "make", "formats", "devices"}) {
        const std::string help = isotet({command, "--help"}).out;
        for (std::size_t at = 0; (at = help.find(" --", at)) != std::string::npos; ++at) {
            const std::string option = help.substr(at + 3, help.find_first_of(" \n.,;:)", at + 3) - at - 3);
            std::string in_roff = "\\-\\-";
            for (const char c : option) in_roff += c == '-' ? "\\-" : std::string(1, c);
            EXPECT_NE(man.find(in_roff), std::string::npos) << command << " --" << option;
        }
    }
}

TEST_F(Program, CompletionIsBashThatCompletesChoices) {
    put_content(path("completion"), isotet({"docs", "completion"}).out);
    const std::string script =
        "source '" + path("completion") +
        "'; COMP_WORDS=(isotet extract --normals g); COMP_CWORD=3; _isotet; echo \"${COMPREPLY[@]}\";"
        "COMP_WORDS=(isotet ext); COMP_CWORD=1; _isotet; echo \"${COMPREPLY[@]}\";"
        "COMP_WORDS=(isotet check --str); COMP_CWORD=2; _isotet; echo \"${COMPREPLY[@]}\"";
    const RunResult run = run_program({"/bin/bash", "--norc", "-c", script}, {.folder = folder.path().string()});
    EXPECT_EQ(run.out, "gradient\nextract\n--strict\n") << run.err;
    EXPECT_EQ(run.err, "");
}

} // namespace
} // namespace isotet::test
