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
    const std::string overview = isotet({"docs", "man"}).out;
    for (const char* command : {"info", "extract", "check"}) {
        EXPECT_NE(overview.find(std::string("isotet\\-") + command + " (1)"), std::string::npos);
        const std::string man = isotet({"docs", "man", command}).out;
        const std::string help = isotet({command, "--help-all"}).out;
        for (std::size_t at = 0; (at = help.find(" --", at)) != std::string::npos; ++at) {
            const std::string option = help.substr(at + 3, help.find_first_of(" \n.,;:)", at + 3) - at - 3);
            std::string in_roff = "\\-\\-";
            for (const char c : option) in_roff += c == '-' ? "\\-" : std::string(1, c);
            EXPECT_NE(man.find(in_roff), std::string::npos) << command << " --" << option;
        }
    }
}

TEST_F(Program, CompletionIsBashThatCompletesChoices) {
    put_content(path("completion"), isotet({"docs", "bash"}).out);
    const std::string script =
        "source '" + path("completion") +
        "'; COMP_WORDS=(isotet extract --normals g); COMP_CWORD=3; _isotet; echo \"${COMPREPLY[@]}\";"
        "COMP_WORDS=(isotet ext); COMP_CWORD=1; _isotet; echo \"${COMPREPLY[@]}\";"
        "COMP_WORDS=(isotet check --str); COMP_CWORD=2; _isotet; echo \"${COMPREPLY[@]}\"";
    const RunResult run = run_program({"/bin/bash", "--norc", "-c", script}, {.folder = folder.path().string()});
    EXPECT_EQ(run.out, "gradient\nextract\n--strict\n") << run.err;
    EXPECT_EQ(run.err, "");
}

TEST_F(Program, FishCompletesCommandsOptionsAndChoices) {
    put_content(path("isotet.fish"), isotet({"docs", "fish"}).out);
    const std::string script = "source '" + path("isotet.fish") +
                               "'; complete -C 'isotet ext'; complete -C 'isotet check --str';"
                               "complete -C 'isotet extract --normals g'";
    const RunResult run =
        run_program({"/usr/bin/fish", "--no-config", "-c", script}, {.folder = folder.path().string()});
    EXPECT_NE(run.out.find("extract\tExtract isosurfaces"), std::string::npos) << run.out << run.err;
    EXPECT_NE(run.out.find("--strict\t"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("gradient"), std::string::npos) << run.out;
    EXPECT_EQ(run.err, "");
}

TEST_F(Program, ZshIsToldOfOptionsAndChoices) {
    put_content(path("_isotet"), isotet({"docs", "zsh"}).out);
    const std::string script =
        "_arguments() { print -rl -- \"$@\" }; words=(isotet extract x); CURRENT=3; source '" + path("_isotet") + "'";
    const RunResult run = run_program({"/usr/bin/zsh", "-f", "-c", script}, {.folder = folder.path().string()});
    EXPECT_NE(run.out.find("\n(-f --field)--field[The field to contour"), std::string::npos) << run.out << run.err;
    EXPECT_NE(run.out.find("]:none|gradient|face|vertex:(none gradient face vertex)\n"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("\n*:file:_files\n"), std::string::npos) << run.out;
    EXPECT_EQ(run.err, "");
}

} // namespace
} // namespace isotet::test
