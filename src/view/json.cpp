// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/json.hpp"

#include <cmath>

namespace isotet::view {

std::optional<Json> parse_json(std::string_view text) {
    Json json = Json::parse(text, nullptr, false);
    if (json.is_discarded()) return std::nullopt;
    return json;
}

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

const Json* find(const Json& object, std::string_view key) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(std::string(key));
    return found == object.end() ? nullptr : &*found;
}

std::optional<double> finite_number(const Json& value) {
    if (!value.is_number()) return std::nullopt;
    const auto number = value.get<double>();
    if (!std::isfinite(number)) return std::nullopt;
    return number;
}

std::optional<std::uint64_t> whole_number(const Json& value) {
    if (!value.is_number_unsigned()) return std::nullopt;
    return value.get<std::uint64_t>();
}

const std::string* text(const Json& value) {
    return value.is_string() ? &value.get_ref<const std::string&>() : nullptr;
}

} // namespace isotet::view
