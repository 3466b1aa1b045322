// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/ensight/ensight_6.hpp"

#include <algorithm>

#include <fmt/core.h>

namespace isotet::io::confined {

NodeNumbers::NodeNumbers(std::string_view line) {
    const auto words = words_of(line);
    if (words.size() < 3) return;
    if (words[2] == "given") kind_ = Kind::given;
    else if (words[2] == "ignore") kind_ = Kind::ignored;
}

void NodeNumbers::set(const EnsightFile& file, const std::vector<std::int64_t>& given, std::uint64_t count) {
    constexpr std::int64_t most = 1 << 24, most_for_each = 64; // VTK's reader has a table of them, too
    count_ = count;
    if (given.empty()) return;
    const auto [least, largest] = std::minmax_element(given.begin(), given.end());
    if (*least < 1) file.wrong(fmt::format("a node has the number {}", *least));
    if (*largest > most && static_cast<std::uint64_t>(*largest) > static_cast<std::uint64_t>(most_for_each) * count)
        file.wrong(fmt::format("one of {} nodes has the number {}, which is too large", count, *largest));
    places_.resize(static_cast<std::size_t>(*largest));
    for (std::size_t i = 0; i < given.size(); ++i) {
        std::uint32_t& place = places_[static_cast<std::size_t>(given[i]) - 1];
        if (place != 0) file.wrong(fmt::format("node {} is there twice", given[i]));
        place = static_cast<std::uint32_t>(i) + 1;
    }
}

void NodeNumbers::expect(const EnsightFile& file, std::int64_t number) const {
    const std::uint64_t most = are_given() ? places_.size() : count_;
    if (number < 1 || static_cast<std::uint64_t>(number) > most || (are_given() && place(number) == 0))
        file.wrong(fmt::format("an element has node {}, which is not there", number));
}

std::int64_t NodeNumbers::place(std::int64_t number) const {
    return are_given() ? places_[static_cast<std::size_t>(number) - 1] : number;
}

} // namespace isotet::io::confined
