// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/number_text.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace isotet::jobs {

std::string shortest(double value) { return fmt::format("{}", value); }

std::string rounded(double value) { return fmt::format("{:.6g}", value); }

std::string rounded(double value, double difference) {
    if (value == 0 || !(difference > 0) || !std::isfinite(value) || !std::isfinite(difference)) return rounded(value);
    const auto place = [](double number) { return static_cast<int>(std::floor(std::log10(std::abs(number)))); };
    return fmt::format("{:.{}g}", value, std::clamp(place(value) - place(difference) + 1, 6, 17));
}

std::vector<std::string> told_apart(const std::vector<double>& values) {
    std::vector<double> sorted = values;
    std::ranges::sort(sorted);
    double smallest = INFINITY; // difference
    for (std::size_t i = 1; i < sorted.size(); ++i)
        if (sorted[i - 1] < sorted[i]) smallest = std::min(smallest, sorted[i] - sorted[i - 1]);
    std::vector<std::string> texts;
    for (const double value : values) texts.push_back(rounded(value, smallest));
    return texts;
}

std::string rounded_range(double lower, double upper) {
    const double apart = (upper - lower) / 1000;
    return fmt::format("{} to {}", rounded(lower, apart), rounded(upper, apart));
}

std::string counted(std::uint64_t count, std::string_view one) {
    return fmt::format("{} {}{}", grouped(count), one, count == 1 ? "" : "s");
}

std::string grouped(std::uint64_t count) {
    std::string digits = fmt::format("{}", count);
    for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, 1, ',');
    return digits;
}

std::string seconds_text(double seconds) { return fmt::format("{:.3f} s", seconds); }

namespace {

template <class Number>
std::optional<Number> parse(std::string_view text) noexcept {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

} // namespace

std::optional<double> parse_number(std::string_view text) noexcept { return parse<double>(text); }

std::optional<std::uint64_t> parse_count(std::string_view text) noexcept { return parse<std::uint64_t>(text); }

std::optional<std::uint64_t> parse_bytes(std::string_view text) noexcept {
    const auto lower_end = [&] { return text.empty() ? '\0' : static_cast<char>(text.back() | 0x20); };
    double unit = 1;
    if (lower_end() == 'b') {
        text.remove_suffix(1);
        for (const auto& [letter, bytes] : {std::pair{'k', 1e3}, {'m', 1e6}, {'g', 1e9}, {'t', 1e12}}) {
            if (lower_end() != letter) continue;
            unit = bytes;
            text.remove_suffix(1);
            break;
        }
        while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    }
    if (unit == 1) return parse_count(text);
    const std::optional<double> number = parse_number(text);
    if (!number || !(*number >= 0) || !(*number * unit < 0x1p63)) return std::nullopt;
    return static_cast<std::uint64_t>(*number * unit + 0.5);
}

} // namespace isotet::jobs
