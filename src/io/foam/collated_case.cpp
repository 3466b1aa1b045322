// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/foam/collated_case.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include <fmt/core.h>

#include "io/files/escape.hpp"
#include "io/foam/scanner.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::foam {

namespace {

constexpr std::string_view plain = "processor", together = "processors", collated_class = "decomposedBlockData";

/// More than a mesh has files.
constexpr std::size_t kept_files = 12;

/// Takes digits from the front.
std::optional<std::size_t> take_number(std::string_view& text) {
    std::size_t number = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{}) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(rest - text.data()));
    return number;
}

struct FolderName {
    std::size_t total = 0, first = 0, last = 0;
};

/// "processors4", or "processors4_0-1".
std::optional<FolderName> parse_folder(std::string_view name) {
    if (!name.starts_with(together)) return std::nullopt;
    name.remove_prefix(together.size());
    const auto total = take_number(name);
    constexpr std::size_t most = 1U << 20U;
    if (!total || *total == 0 || *total > most) return std::nullopt;
    if (name.empty()) return FolderName{*total, 0, *total - 1};
    if (!name.starts_with('_')) return std::nullopt;
    name.remove_prefix(1);
    const auto first = take_number(name);
    if (!first || !name.starts_with('-')) return std::nullopt;
    name.remove_prefix(1);
    const auto last = take_number(name);
    if (!last || !name.empty() || *last < *first || *last >= *total) return std::nullopt;
    return FolderName{*total, *first, *last};
}

/// "processor3": 3.
std::optional<std::size_t> parse_processor(std::string_view name) {
    if (!name.starts_with(plain)) return std::nullopt;
    name.remove_prefix(plain.size());
    const auto number = take_number(name);
    return name.empty() ? number : std::nullopt;
}

} // namespace

Result<std::unique_ptr<const CollatedCase>> CollatedCase::over(const CaseFiles& files) {
    std::unique_ptr<CollatedCase> made(new CollatedCase(files));
    std::vector<Group>& groups = made->groups_;
    std::size_t total = 0;
    for (const std::string& name : files.list("").folders) {
        if (parse_processor(name)) return std::unique_ptr<const CollatedCase>();
        const auto folder = parse_folder(name);
        if (!folder) continue;
        if (total != 0 && folder->total != total)
            return broken(files.path_of(name), fmt::format("is there, but {}, of another number of processors, too",
                                                           escaped(groups.front().folder)));
        total = folder->total;
        groups.push_back({name, folder->first, folder->last - folder->first + 1});
    }
    if (groups.empty()) return std::unique_ptr<const CollatedCase>();
    std::ranges::sort(groups, {}, &Group::first);
    std::size_t next = 0;
    for (const Group& group : groups) {
        if (group.first != next)
            return broken(files.path_of(group.folder),
                          fmt::format("begins with processor {}, but the next one is {}", group.first, next));
        next += group.count;
    }
    if (next != total)
        return broken(files.path_of(groups.back().folder),
                      fmt::format("ends with processor {}, but there are {}", next - 1, total));
    return std::unique_ptr<const CollatedCase>(std::move(made));
}

CollatedCase::Place CollatedCase::collated(const std::string& name) const {
    const std::size_t slash = std::min(name.find('/'), name.size());
    const auto processor = parse_processor(std::string_view(name).substr(0, slash));
    if (!processor) return {name, nullptr, 0};
    for (const Group& group : groups_)
        if (*processor >= group.first && *processor - group.first < group.count)
            return {group.folder + name.substr(slash), &group, *processor - group.first};
    return {name, nullptr, 0};
}

FolderContent CollatedCase::list(const std::string& folder) const {
    FolderContent content = files_.list(collated(folder).name);
    if (folder.empty())
        std::erase_if(content.folders, [](const std::string& name) { return parse_folder(name).has_value(); });
    return content;
}

Result<CollatedCase::Blocks> CollatedCase::blocks_of(CaseText file, std::size_t count) {
    Blocks found;
    found.file = file;
    Scanner scanner(std::move(file));
    if (!scanner.is_foam()) return found;
    const auto header = scanner.any_header();
    if (!header) return header.error();
    if (header->type != collated_class) return found;
    while (!scanner.at_end() && found.blocks.size() <= count) {
        const auto block = scanner.bytes(fmt::format("the block of a processor, number {},", found.blocks.size()));
        if (!block) return block.error();
        found.blocks.push_back(*block);
    }
    if (found.blocks.size() != count)
        return scanner.fail(fmt::format("has {} blocks than the {} processors of its folder",
                                        found.blocks.size() < count ? "fewer" : "more", count));
    Scanner first({found.file.path, found.file.name, found.file.owner, found.blocks.front()});
    if (const auto read = first.header(); !read) return read.error();
    found.header = first.text_so_far();
    return found;
}

Result<const CollatedCase::Blocks*> CollatedCase::blocks_at(const Place& place) const {
    const auto known = std::ranges::find(recent_, place.name, &std::pair<std::string, Blocks>::first);
    if (known != recent_.end()) {
        recent_.splice(recent_.begin(), recent_, known);
        return &recent_.front().second;
    }
    auto file = files_.open(place.name);
    if (!file) return file.error();
    auto blocks = blocks_of(std::move(*file), place.group->count);
    if (!blocks) return blocks.error();
    recent_.emplace_front(place.name, std::move(*blocks));
    if (recent_.size() > kept_files) recent_.pop_back();
    return &recent_.front().second;
}

Result<CaseText> CollatedCase::open(const std::string& name, std::size_t most) const {
    const Place place = collated(name);
    if (!place.group) return files_.open(place.name, most);
    if (most != all) { // the header of the first block is that of all
        auto head = files_.open(place.name, most);
        if (!head) return head;
        Scanner scanner(*head);
        if (!scanner.is_foam()) return head;
        const auto header = scanner.any_header();
        if (!header || header->type != collated_class) return head; // who reads it tells what is wrong with it
        const std::string_view begun = scanner.bytes_begun();
        return CaseText{head->path, name, head->owner, begun.empty() ? std::string_view("FoamFile") : begun};
    }
    const auto found = blocks_at(place);
    if (!found) return found.error();
    const Blocks& file = **found;
    if (file.blocks.empty()) return CaseText{file.file.path, name, file.file.owner, file.file.text};
    const std::string_view block = file.blocks[place.block];
    const std::string path = fmt::format("{} (processor {})", file.file.path, place.group->first + place.block);
    CaseText own{path, name, file.file.owner, block};
    if (place.block == 0 || Scanner(own).is_foam()) return own;
    auto whole = std::make_shared<std::string>();
    whole->reserve(file.header.size() + 1 + block.size());
    whole->append(file.header).append("\n").append(block);
    const std::string_view text = *whole;
    return CaseText{path, name, std::move(whole), text};
}

} // namespace isotet::io::foam
