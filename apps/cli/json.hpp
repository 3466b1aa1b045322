// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The value that reports build for --json: {{"name", "cube"}, {"tets", 6}} is an object, Json::array({1, 2}) an array.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace isotet::cli {

class Json {
public:
    struct Member;
    using Array = std::vector<Json>;
    using Object = std::vector<Member>; ///< in the order in which keys were set
    using Value = std::variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string, Array, Object>;

    // What copies, moves and destroys the variant is in json.cpp: inline it costs most of a second in each report.
    Json(std::nullptr_t = nullptr) noexcept;
    Json(const Json& other);
    Json(Json&& other) noexcept;
    Json& operator=(const Json& other);
    Json& operator=(Json&& other) noexcept;
    ~Json();

    Json(bool value);
    Json(double value);
    Json(std::int64_t value);
    Json(std::uint64_t value);
    Json(std::signed_integral auto value) : Json(std::int64_t{value}) {}
    Json(std::unsigned_integral auto value) : Json(std::uint64_t{value}) {}
    Json(const char* value);
    Json(std::string value);
    Json(std::string_view value);
    Json(std::initializer_list<Member> members);

    template <class Item>
    Json(const std::vector<Item>& items) : Json(Array(items.begin(), items.end())) {}
    template <class Item, std::size_t count>
    Json(const std::array<Item, count>& items) : Json(Array(items.begin(), items.end())) {}

    static Json array(std::initializer_list<Json> items = {});
    static Json object();

    /// The value of a key; a new key is added with null. Only for an object, and for null, which becomes an object.
    Json& operator[](std::string_view key);

    /// Only for an array.
    void push_back(Json item);
    Json& back();

    const Value& value() const noexcept { return value_; }

private:
    explicit Json(Array items);

    Value value_;
};

struct Json::Member {
    std::string key;
    Json value;
};

} // namespace isotet::cli
