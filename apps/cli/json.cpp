// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "json.hpp"

#include <algorithm>
#include <utility>

namespace isotet::cli {

Json::Json(std::nullptr_t) noexcept {}
Json::Json(const Json& other) = default;
Json::Json(Json&& other) noexcept = default;
Json& Json::operator=(const Json& other) = default;
Json& Json::operator=(Json&& other) noexcept = default;
Json::~Json() = default;

Json::Json(bool value) : value_(value) {}
Json::Json(double value) : value_(value) {}
Json::Json(std::int64_t value) : value_(value) {}
Json::Json(std::uint64_t value) : value_(value) {}
Json::Json(const char* value) : value_(std::string(value)) {}
Json::Json(std::string value) : value_(std::move(value)) {}
Json::Json(std::string_view value) : value_(std::string(value)) {}
Json::Json(std::initializer_list<Member> members) : value_(Object(members)) {}
Json::Json(Array items) : value_(std::move(items)) {}

Json Json::array(std::initializer_list<Json> items) { return Json(Array(items)); }

Json Json::object() { return Json(std::initializer_list<Member>{}); }

Json& Json::operator[](std::string_view key) {
    if (std::holds_alternative<std::nullptr_t>(value_)) value_ = Object();
    Object& members = std::get<Object>(value_);
    const auto found = std::ranges::find(members, key, &Member::key);
    return found == members.end() ? members.emplace_back(std::string(key)).value : found->value;
}

void Json::push_back(Json item) { std::get<Array>(value_).push_back(std::move(item)); }

Json& Json::back() { return std::get<Array>(value_).back(); }

} // namespace isotet::cli
