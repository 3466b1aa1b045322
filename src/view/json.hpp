// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Messages between page and server are JSON; values are taken out of it without exceptions.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace isotet::view {

/// An object keeps the order of its keys.
using Json = nlohmann::ordered_json;

/// The text as a value; nothing where it is not JSON.
std::optional<Json> parse_json(std::string_view text);

/// One line. Bytes that are not UTF-8 are replaced.
std::string text_of(const Json& json);

/// The value of a key; null where there is none, or `object` is no object.
const Json* find(const Json& object, std::string_view key);

/// Values of the type that is asked for; nothing else.
std::optional<double> finite_number(const Json& value);
std::optional<std::uint64_t> whole_number(const Json& value);
const std::string* text(const Json& value);

} // namespace isotet::view
