// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <isotet/export.hpp>

namespace isotet {

enum class ScalarType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// Bytes of one scalar.
ISOTET_API std::size_t size_of(ScalarType type) noexcept;

/// "float32", "int64" and so on.
ISOTET_API std::string_view name_of(ScalarType type) noexcept;

inline bool is_floating(ScalarType type) noexcept { return type == ScalarType::float32 || type == ScalarType::float64; }

/// The ScalarType of a C++ type; `long` and `long long` are both int64 where they have 8 bytes.
template <class T>
constexpr ScalarType scalar_type_of() {
    static_assert(std::is_arithmetic_v<T> && !std::is_same_v<T, bool> && !std::is_same_v<T, long double>);
    if constexpr (std::is_same_v<T, float>) return ScalarType::float32;
    else if constexpr (std::is_same_v<T, double>) return ScalarType::float64;
    else if constexpr (sizeof(T) == 1) return std::is_signed_v<T> ? ScalarType::int8 : ScalarType::uint8;
    else if constexpr (sizeof(T) == 2) return std::is_signed_v<T> ? ScalarType::int16 : ScalarType::uint16;
    else if constexpr (sizeof(T) == 4) return std::is_signed_v<T> ? ScalarType::int32 : ScalarType::uint32;
    else return std::is_signed_v<T> ? ScalarType::int64 : ScalarType::uint64;
}

/// A view of `tuples` x `components` scalars of one type, interleaved (x0 y0 z0 x1 y1 z1 ...), read only, and the owner
/// that keeps them alive. Copying an Array copies the view and shares the owner: never the scalars.
///
/// Guarantees   the scalars never move or change while any copy of the Array lives (if borrowed: the caller's promise)
/// Threads      safe to read from many threads
class ISOTET_API Array {
public:
    Array() = default;

    /// Shares memory kept alive by `owner` (a reader's array, a memory mapping, a NumPy array).
    Array(ScalarType type, const void* data, std::size_t tuples, std::size_t components,
          std::shared_ptr<const void> owner)
        : data_(data), tuples_(tuples), components_(components), owner_(std::move(owner)), type_(type) {}

    /// Takes a vector over, without a copy. Where its size is no multiple of `components`, the array has one component:
    /// no value is lost, and whoever expects another shape refuses it.
    template <class T>
    static Array own(std::vector<T> values, std::size_t components = 1) {
        auto owner = std::make_shared<const std::vector<T>>(std::move(values));
        const std::size_t width = fitting(owner->size(), components);
        return Array(scalar_type_of<T>(), owner->data(), owner->size() / width, width, owner);
    }

    /// Borrows the caller's memory, which must outlive every copy of the Array; a temporary vector is refused when
    /// compiling. Sizes as own().
    template <class T>
    static Array borrow(std::span<const T> values, std::size_t components = 1) {
        const std::size_t width = fitting(values.size(), components);
        return Array(scalar_type_of<T>(), values.data(), values.size() / width, width, nullptr);
    }
    template <class T>
    static Array borrow(const std::vector<T>& values, std::size_t components = 1) {
        return borrow(std::span<const T>(values), components);
    }
    template <class T>
    static Array borrow(const std::vector<T>&&, std::size_t components = 1) = delete;

    ScalarType type() const noexcept { return type_; }
    const void* data() const noexcept { return data_; }
    std::size_t tuples() const noexcept { return tuples_; }         ///< rows
    std::size_t components() const noexcept { return components_; } ///< scalars a row
    std::size_t size() const noexcept { return tuples_ * components_; }
    std::size_t bytes() const noexcept { return size() * size_of(type_); }
    bool empty() const noexcept { return size() == 0; }

    /// Who keeps the scalars alive; expired for a borrowed array. Two arrays with the same data() and a living owner in
    /// common hold the same scalars.
    std::weak_ptr<const void> owner() const noexcept { return owner_; }

    /// All scalars. T must be the array's type: behaviour is undefined otherwise (test type(), or use visit).
    template <class T>
    std::span<const T> as() const noexcept {
        return {static_cast<const T*>(data_), size()};
    }

    /// One scalar as a double (64-bit integers beyond 2^53 are rounded to nearest). Slow: for few values.
    double at(std::size_t tuple, std::size_t component = 0) const noexcept;

    /// Calls `f` with the scalars as a span of their own type, and returns what it returns.
    template <class F>
    decltype(auto) visit(F&& f) const {
        switch (type_) {
        case ScalarType::int8: return f(as<std::int8_t>());
        case ScalarType::uint8: return f(as<std::uint8_t>());
        case ScalarType::int16: return f(as<std::int16_t>());
        case ScalarType::uint16: return f(as<std::uint16_t>());
        case ScalarType::int32: return f(as<std::int32_t>());
        case ScalarType::uint32: return f(as<std::uint32_t>());
        case ScalarType::int64: return f(as<std::int64_t>());
        case ScalarType::uint64: return f(as<std::uint64_t>());
        case ScalarType::float32: return f(as<float>());
        case ScalarType::float64: break;
        }
        return f(as<double>());
    }

private:
    static std::size_t fitting(std::size_t size, std::size_t components) noexcept {
        return components > 0 && size % components == 0 ? components : 1;
    }

    const void* data_ = nullptr;
    std::size_t tuples_ = 0;
    std::size_t components_ = 1;
    std::shared_ptr<const void> owner_;
    ScalarType type_ = ScalarType::float32;
};

/// An array with a name, as in the file or as the caller says.
struct Field {
    std::string name;
    Array values;
};

} // namespace isotet
