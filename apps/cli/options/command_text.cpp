// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "options/command_text.hpp"

#include <algorithm>

namespace isotet::cli {

std::vector<Paragraph> paragraphs(const std::string& details) {
    std::vector<Paragraph> result;
    bool open = false; // the last paragraph goes on with the next line
    for (std::size_t begin = 0; begin < details.size();) {
        const std::size_t end = std::min(details.find('\n', begin), details.size());
        const std::string line = details.substr(begin, end - begin);
        begin = end + 1;
        if (line.empty()) {
            open = false;
            continue;
        }
        const bool preformatted = line.starts_with("  ");
        if (!open || result.back().preformatted != preformatted) result.push_back({preformatted, {}});
        open = true;
        std::string& text = result.back().text;
        if (preformatted) text += line.substr(2) + "\n";
        else text += (text.empty() ? "" : " ") + line;
    }
    return result;
}

std::vector<OptionText> by_groups(const std::vector<OptionText>& options) {
    std::vector<OptionText> sorted = options;
    const auto place = [&](const OptionText& option) {
        if (option.positional) return options.begin();
        return std::ranges::find(options, option.group, &OptionText::group);
    };
    std::ranges::stable_sort(sorted, {}, place);
    return sorted;
}

} // namespace isotet::cli
