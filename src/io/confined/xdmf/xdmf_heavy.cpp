// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/xdmf/xdmf_heavy.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "io/files/escape.hpp"
#include "io/files/text_scanner.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::size_t max_parts = 10000;

/// A data set, or a part of it.
struct HeavyPart {
    std::string file, data_set;
    Box box;
};

std::vector<std::string_view> split_at(std::string_view text, char mark) {
    std::vector<std::string_view> words;
    for (;;) {
        const auto end = text.find(mark);
        words.push_back(text.substr(0, end));
        if (end == std::string_view::npos) return words;
        text.remove_prefix(end + 1);
    }
}

/// "0 0:1 1:1 20:5 20": start, stride, count and, which says nothing more, the size of the whole.
std::optional<Box> box_of(std::string_view text) {
    const auto words = split_at(text, ':');
    if (words.size() != 3 && words.size() != 4) return std::nullopt;
    std::vector<std::vector<std::uint64_t>> numbers;
    for (const std::string_view word : words) {
        auto& row = numbers.emplace_back();
        TextScanner scanner(word);
        for (std::uint64_t number = 0; !scanner.at_end() && row.size() <= 32; row.push_back(number))
            if (!scanner.number(number)) return std::nullopt;
        if (row.empty() || row.size() != numbers.front().size()) return std::nullopt;
    }
    return Box{std::move(numbers[0]), std::move(numbers[1]), std::move(numbers[2])};
}

std::optional<HeavyPart> part_of(std::string_view text) {
    text = without_blanks(text);
    const auto colon = text.rfind(":/") != std::string_view::npos ? text.rfind(":/") : text.rfind(':');
    if (colon == std::string_view::npos || colon + 1 == text.size()) return std::nullopt;
    return HeavyPart{std::string(text.substr(0, colon)), std::string(text.substr(colon + 1)), {}};
}

/// A bar belongs to a name unless a box stands behind it.
std::optional<std::vector<HeavyPart>> parts_of(std::string_view text) {
    std::vector<HeavyPart> parts;
    std::string name;
    for (const std::string_view word : split_at(text, '|')) {
        if (parts.size() > max_parts) return std::nullopt;
        if (auto box = box_of(word); box && !name.empty()) {
            auto part = part_of(name);
            if (!part) return std::nullopt;
            part->box = *std::move(box);
            parts.push_back(*std::move(part));
            name.clear();
        } else {
            name += (name.empty() ? "" : "|") + std::string(word);
        }
    }
    if (std::ranges::all_of(name, is_space)) return parts.empty() ? std::nullopt : std::optional(std::move(parts));
    auto part = part_of(name);
    if (!part) return std::nullopt;
    parts.push_back(*std::move(part));
    return parts;
}

/// One after another, along the first dimension where the others agree.
ShapedValues one_after_another(const std::vector<ShapedValues>& parts) {
    ShapedValues whole = parts.front();
    bool same_type = true, same_rows = !whole.dimensions.empty();
    std::uint64_t count = 0, rows = 0;
    for (const ShapedValues& part : parts) {
        same_type = same_type && part.values.type() == whole.values.type();
        same_rows = same_rows && part.dimensions.size() == whole.dimensions.size() &&
                    std::equal(part.dimensions.begin() + 1, part.dimensions.end(), whole.dimensions.begin() + 1);
        count += part.count();
        rows += same_rows ? part.dimensions.front() : 0;
    }
    if (same_rows) whole.dimensions.front() = rows;
    else whole.dimensions = {count};
    const ScalarType type = same_type ? whole.values.type() : ScalarType::float64;
    const bool filled = std::ranges::any_of(parts, [](const ShapedValues& part) { return !part.values.empty(); });
    whole.values = Array(type, nullptr, 0, 1, nullptr).visit([&]<class T>(std::span<const T> none) {
        if (!filled) return Array(type, none.data(), 0, 1, nullptr);
        std::vector<T> values;
        values.reserve(count);
        for (const ShapedValues& part : parts)
            part.values.visit([&](auto numbers) {
                for (const auto number : numbers) values.push_back(static_cast<T>(number));
            });
        return Array::own(std::move(values));
    });
    return whole;
}

} // namespace

Result<ShapedValues> read_heavy(const std::string& index, std::string_view text, const FindHeavyFile& find,
                                const Box& box, Depth depth, HdfNumbers numbers) {
    auto parts = parts_of(text);
    if (!parts)
        return broken(index, fmt::format("\"{}\" does not name a file and a data set", escaped(text.substr(0, 80))));
    if (parts->size() > 1 && !box.count.empty())
        return broken(index, "a part of several data sets, one after another, is not read");
    std::vector<ShapedValues> values;
    for (HeavyPart& part : *parts) {
        const auto file = find(part.file);
        if (!file) return file.error();
        const bool whole = part.box.count.empty();
        if (!whole && !box.count.empty()) return broken(index, "a HyperSlab of a part of a data set is not read");
        auto read = read_hdf5_array(*file, part.data_set, whole ? box : part.box, depth, numbers);
        if (!read) return read;
        values.push_back(*std::move(read));
    }
    if (values.size() == 1) return std::move(values.front());
    return one_after_another(values);
}

} // namespace isotet::io::confined
