// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The pictures in docs/gallery are what the commands under them draw, give or take what another version of FreeType
// paints otherwise.
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "cli/program.hpp"

namespace isotet::test {
namespace {

namespace fs = std::filesystem;

const fs::path root = source_folder();

/// The words of each line of the page that is a command, without the program.
std::vector<std::vector<std::string>> commands() {
    std::ifstream page(root / "docs/pictures.md");
    std::vector<std::vector<std::string>> all;
    for (std::string line; std::getline(page, line);) {
        if (!line.starts_with("isotet render ")) continue;
        std::istringstream words(line);
        std::vector<std::string>& command = all.emplace_back();
        for (std::string word; words >> word;)
            if (word != "isotet") command.push_back(word);
    }
    return all;
}

class Gallery : public Program {};

TEST_F(Gallery, ShowsWhatItsCommandsDraw) {
    const auto all = commands();
    EXPECT_GE(all.size(), 10u);
    for (std::vector<std::string> words : all) {
        const std::string shown = (root / words.back()).string();
        ASSERT_EQ(fs::path(shown).parent_path(), root / "docs/gallery") << "a command ends with its picture";
        EXPECT_LT(fs::file_size(shown), 200'000u) << shown;
        words.back() = path("again.png");
        words.insert(words.end(), {"--reference", shown});
        words.insert(words.begin(), program_path());
        RunOptions here;
        here.folder = root.string();
        const RunResult run = run_program(words, here);
        EXPECT_EQ(run.status, 0) << shown << "\n" << run.err << "renew it: scripts/gallery.sh";
    }
}

TEST_F(Gallery, HasNoPictureWithoutACommand) {
    std::size_t pictures = 0;
    for (const auto& entry : fs::directory_iterator(root / "docs/gallery"))
        pictures += entry.path().extension() == ".png";
    EXPECT_EQ(pictures, commands().size());
}

} // namespace
} // namespace isotet::test
