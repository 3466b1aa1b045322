// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Numbers as text and back, the same in every locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/text.hpp>

namespace isotet::jobs {

/// The shortest decimal that reads back as the same double: "0.7", "1e-05".
std::string shortest(double value);

/// Six significant digits: "3.14159".
std::string rounded(double value);

/// Six significant digits, or as many as tell the value from one that is `difference` away: "101325.42" of 0.01.
/// Without a difference above 0 six.
std::string rounded(double value, double difference);

/// The same of each value, so that different values have different texts.
std::vector<std::string> told_apart(const std::vector<double>& values);

/// "0.3 to 4": as many digits as tell values apart that lie a thousandth of the range from each other.
std::string rounded_range(double lower, double upper);

/// "1 triangle", "12,345 triangles".
std::string counted(std::uint64_t count, std::string_view one);

/// "12,345,678".
std::string grouped(std::uint64_t count);

/// "0.034 s".
std::string seconds_text(double seconds);

/// "2GB", "1.5 GB", "512mb", "1000": decimal units, as of format_bytes(); nothing if it is none or does not fit.
std::optional<std::uint64_t> parse_bytes(std::string_view text) noexcept;

/// The whole of `text` as a number, the point as its decimal sign; nothing if it is not one or does not fit.
std::optional<double> parse_number(std::string_view text) noexcept;
std::optional<std::uint64_t> parse_count(std::string_view text) noexcept;

} // namespace isotet::jobs
