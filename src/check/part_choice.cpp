// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which parts of a surface are kept, as text and as numbers.
#include <isotet/surface.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.hpp"

namespace isotet {

namespace checking {
namespace {

using PartKind = PartChoice::Kind;

/// All of a text as a number.
template <class Number>
bool read_part_number(std::string_view text, Number& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc{} && end == text.data() + text.size();
}

/// "0,2,5", ascending and each once.
std::optional<std::vector<std::uint64_t>> read_part_list(std::string_view text) {
    std::vector<std::uint64_t> out;
    for (bool more = true; more;) {
        const std::size_t comma = text.find(',');
        more = comma != std::string_view::npos;
        if (!read_part_number(text.substr(0, comma), out.emplace_back())) return std::nullopt;
        if (more) text.remove_prefix(comma + 1);
    }
    std::ranges::sort(out);
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

constexpr std::pair<std::string_view, PartKind> part_words[] = {{"area>", PartKind::area},
                                                               {"volume>", PartKind::volume},
                                                               {"touching:", PartKind::touching},
                                                               {"parts:", PartKind::numbers},
                                                               {"not:", PartKind::others}};

/// `numbers`   those of the choice, ascending
bool is_chosen(const SurfacePart& part, std::uint64_t number, const PartChoice& choice,
               const std::vector<std::uint64_t>& numbers) {
    switch (choice.kind) {
    case PartKind::largest: return static_cast<double>(number) < choice.limit;
    case PartKind::area: return part.area > choice.limit;
    case PartKind::volume: return part.closed && part.volume > choice.limit;
    case PartKind::touching: return !part.closed;
    case PartKind::numbers: return std::ranges::binary_search(numbers, number);
    case PartKind::others: break;
    }
    return !std::ranges::binary_search(numbers, number);
}

} // namespace
} // namespace checking

std::optional<PartChoice> parse_part_choice(std::string_view text) {
    using checking::PartKind;
    PartChoice out;
    if (text == "largest") return out;
    const auto* const found =
        std::ranges::find_if(checking::part_words, [&](const auto& prefix) { return text.starts_with(prefix.first); });
    if (found == std::end(checking::part_words)) {
        std::uint64_t count = 0;
        if (!checking::read_part_number(text, count) || count == 0) return std::nullopt;
        out.limit = static_cast<double>(count);
        return out;
    }
    const std::string_view rest = text.substr(found->first.size());
    out.kind = found->second;
    if (out.kind == PartKind::touching) {
        out.region = rest;
        return rest.empty() ? std::nullopt : std::optional(out);
    }
    if (out.kind == PartKind::area || out.kind == PartKind::volume)
        return checking::read_part_number(rest, out.limit) && std::isfinite(out.limit) && out.limit >= 0
                   ? std::optional(out)
                   : std::nullopt;
    auto numbers = checking::read_part_list(rest);
    if (!numbers) return std::nullopt;
    out.numbers = *std::move(numbers);
    return out;
}

std::string to_text(const PartChoice& choice) {
    using checking::PartKind;
    if (choice.kind == PartKind::largest)
        return choice.limit == 1 ? "largest" : fmt::format("{}", static_cast<std::uint64_t>(choice.limit));
    const auto* const prefix = std::ranges::find(checking::part_words, choice.kind, [](const auto& p) { return p.second; });
    std::string text(prefix->first);
    if (choice.kind == PartKind::touching) return text + choice.region;
    if (choice.kind == PartKind::numbers || choice.kind == PartKind::others)
        return text + fmt::format("{}", fmt::join(choice.numbers, ","));
    return text + fmt::format("{}", choice.limit);
}

Result<std::vector<std::uint64_t>> chosen_parts(const Surface& surface, const SurfaceParts& parts,
                                                const PartChoice& choice, PartsOf of) {
    if (choice.kind == PartChoice::Kind::touching && choice.region != "boundary")
        return invalid_argument(
            fmt::format("parts that touch '{}' are asked for, but only 'boundary' is known here", choice.region));
    if (choice.kind == PartChoice::Kind::touching && of == PartsOf::solid)
        return parts_touching(surface, parts, {"boundary", 1, 1});
    std::vector<std::uint64_t> numbers = choice.numbers, out;
    std::ranges::sort(numbers);
    for (std::uint64_t i = 0; i < parts.parts.size(); ++i)
        if (checking::is_chosen(parts.parts[i], i, choice, numbers)) out.push_back(i);
    return out;
}

Result<Surface> keep_parts(const Surface& surface, const PartChoice& choice, PartsOf of, const Run& run) {
    const Result<SurfaceParts> parts = find_parts(surface, run);
    if (!parts) return parts.error();
    const Result<std::vector<std::uint64_t>> kept = chosen_parts(surface, *parts, choice, of);
    if (!kept) return kept.error();
    if (kept->size() == parts->parts.size()) return surface;
    Result<Surface> some = keep_parts(surface, *parts, *kept, run);
    if (some) std::erase_if(some->cell_fields, [](const Field& field) { return field.name == "part"; });
    return some;
}

} // namespace isotet
