// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The documents do not rot: their code is code that the tests build, their links lead somewhere, their tables are
// whole.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "support/places.hpp"

namespace isotet::test {
namespace {

namespace fs = std::filesystem;

const fs::path root = source_folder();

std::string content(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    EXPECT_TRUE(file) << path << " cannot be read";
    return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<fs::path> documents() {
    std::vector<fs::path> result = {root / "README.md", root / "CHANGELOG.md", root / "CONTRIBUTING.md",
                                    root / "data" / "README.md"};
    for (const auto& entry : fs::recursive_directory_iterator(root / "docs")) {
        if (entry.path().extension() == ".md") result.push_back(entry.path());
    }
    return result;
}

/// The anchor that a Markdown heading gets: lower case, spaces to hyphens, punctuation dropped.
std::string anchor_of(std::string_view heading) {
    std::string anchor;
    for (const char c : heading) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalnum(byte) || c == '_' || c == '-') anchor += static_cast<char>(std::tolower(byte));
        else if (c == ' ') anchor += '-';
    }
    return anchor;
}

std::vector<std::string> anchors(const std::string& document) {
    std::vector<std::string> result;
    for (std::size_t at = 0; at < document.size();) {
        const std::size_t end = std::min(document.find('\n', at), document.size());
        const std::string_view line = std::string_view(document).substr(at, end - at);
        const std::size_t text = line.find_first_not_of('#');
        if (text != 0 && text < line.size() && line[text] == ' ') result.push_back(anchor_of(line.substr(text + 1)));
        at = end + 1;
    }
    return result;
}

/// The targets of all links [text](target) that stay in the tree.
std::vector<std::string> links(const std::string& document) {
    std::vector<std::string> result;
    for (std::size_t at = document.find("]("); at != std::string::npos; at = document.find("](", at + 1)) {
        const std::string target = document.substr(at + 2, document.find(')', at) - at - 2);
        if (target.find("://") == std::string::npos && target.find_first_of(" \n") == std::string::npos)
            result.push_back(target);
    }
    return result;
}

/// The program in tests/install/consumer without its licence line.
std::string consumer() {
    const std::string source = content(root / "tests/install/consumer/main.cpp");
    return source.substr(source.find('\n') + 1);
}

TEST(Docs, ReadmeShowsTheConsumerThatTheInstallTestBuilds) {
    EXPECT_NE(content(root / "README.md").find("```cpp\n" + consumer() + "```"), std::string::npos);
}

TEST(Docs, ReadmeHasAtMost150Lines) {
    const std::string readme = content(root / "README.md");
    EXPECT_LE(std::count(readme.begin(), readme.end(), '\n'), 150);
}

TEST(Docs, EveryLinkLeadsSomewhere) {
    for (const fs::path& path : documents()) {
        const std::string document = content(path);
        for (const std::string& link : links(document)) {
            const std::size_t hash = link.find('#');
            const fs::path target = hash == 0 ? path : path.parent_path() / link.substr(0, hash);
            ASSERT_TRUE(fs::exists(target)) << path << " links to " << link << ", which is not there";
            if (hash == std::string::npos) continue;
            const std::vector<std::string> there = anchors(content(target));
            EXPECT_NE(std::find(there.begin(), there.end(), link.substr(hash + 1)), there.end())
                << path << " links to " << link << ", but no heading has that name";
        }
    }
}

TEST(Docs, FormatsPageHasARowForEveryFormat) {
    const std::string page = content(root / "docs/formats.md");
    for (const Format& format : formats()) {
        EXPECT_NE(page.find("`" + format.name + "`"), std::string::npos) << format.name << " is not in docs/formats.md";
        for (const std::string& extension : format.extensions) {
            EXPECT_NE(page.find("`" + extension + "`"), std::string::npos) << extension << " is not in docs/formats.md";
        }
    }
}

TEST(Docs, ArchitecturePageHasARowForEveryFolderOfSources) {
    const std::string page = content(root / "docs/inside/architecture.md");
    for (const auto& entry : fs::directory_iterator(root / "src")) {
        if (!entry.is_directory()) continue;
        const std::string row = "| `src/" + entry.path().filename().string() + "/";
        EXPECT_NE(page.find(row), std::string::npos) << "no row " << row;
    }
}

TEST(Docs, TestingPageHasARowForEveryKindOfTest) {
    const std::string page = content(root / "docs/inside/testing.md");
    for (const auto& entry : fs::directory_iterator(root / "tests")) {
        if (!entry.is_directory() || !fs::exists(entry.path() / "CMakeLists.txt")) continue;
        const std::string row = "| `" + entry.path().filename().string() + "` |";
        EXPECT_NE(page.find(row), std::string::npos) << "no row " << row;
    }
}

/// Words that say of code what only people do, or that users of the field do not know.
TEST(Docs, AndSourcesUseTheFieldsWords) {
    static const std::regex strange(R"(\b(nobody|somebody|foretell|foretold|forecast|mailbox|crooked)\b)",
                                    std::regex::icase);
    std::vector<fs::path> files = documents();
    for (const char* folder : {"src", "include", "apps", "bench", "scripts", "python/isotet", "python/bindings"})
        for (const auto& entry : fs::recursive_directory_iterator(root / folder))
            if (entry.is_regular_file() && entry.path().extension() != ".pyc" && entry.path().extension() != ".ttf")
                files.push_back(entry.path());
    for (const fs::path& file : files) {
        std::smatch found;
        const std::string text = content(file);
        EXPECT_FALSE(std::regex_search(text, found, strange)) << file << " has '" << found.str() << "'";
    }
}

TEST(Docs, DataPageNamesEveryFileAndItsSource) {
    const std::string page = content(root / "data/README.md");
    const std::string sources = page.substr(page.find("## Where they come from"));
    for (const auto& entry : fs::recursive_directory_iterator(root / "data")) {
        const std::string folder = entry.path().parent_path().filename().string();
        if (!entry.is_regular_file() || folder == "data" || folder == "licences" || folder == "cgns") continue;
        const std::string name = entry.path().lexically_relative(root / "data").generic_string();
        EXPECT_NE(sources.find("`" + name + "`"), std::string::npos) << name << " has no source in data/README.md";
    }
}

} // namespace
} // namespace isotet::test
