// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include <isotet/export.hpp>

namespace isotet {

/// Who has to act on an error.
enum class ErrorCode {
    invalid_argument, ///< the caller: an option or a call is wrong
    invalid_data,     ///< the data: a grid, a field or the content of a file breaks a rule
    file,             ///< the data: a file cannot be found, opened or recognized
    out_of_memory,    ///< the machine: would need more memory than is free (found out before it is taken)
    cannot_write,     ///< the machine: disk full, no permission, output closed
    no_device,        ///< the machine: no Vulkan, no driver, or no device that can do what is asked
    device_failed,    ///< the machine: a device was lost, or its driver failed; open the device again
    system,           ///< the machine: the system refuses: a child process, a memory file, too many open files
    cancelled,        ///< the user: the operation was cancelled through Progress::cancel
    internal,         ///< isotet itself: please report it
};

/// Whether the CPU could stand in: the device is at fault.
constexpr bool is_of_device(ErrorCode code) noexcept {
    return code == ErrorCode::no_device || code == ErrorCode::device_failed;
}

/// An error as a value: a code and one sentence, *what, value seen, rule*, such as
/// "tets[81204] has point 90112, but the grid has 90000 points".
struct Error {
    ErrorCode code = ErrorCode::internal;
    std::string message;
};

/// Thrown by Result::value() and by nothing else in isotet.
class ISOTET_API Exception : public std::runtime_error {
public:
    explicit Exception(Error error) : std::runtime_error(error.message), error_(std::move(error)) {}
    const Error& error() const noexcept { return error_; }

private:
    Error error_;
};

/// A value or an Error. It cannot be ignored: test it, or call value(), which throws.
template <class T>
class [[nodiscard]] Result {
public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    explicit operator bool() const noexcept { return state_.index() == 0; }

    /// The value. Behaviour is undefined if there is none: test first.
    T& operator*() & noexcept { return *std::get_if<0>(&state_); }
    const T& operator*() const& noexcept { return *std::get_if<0>(&state_); }
    T&& operator*() && noexcept { return std::move(*std::get_if<0>(&state_)); }
    T* operator->() noexcept { return std::get_if<0>(&state_); }
    const T* operator->() const noexcept { return std::get_if<0>(&state_); }

    /// The error. Behaviour is undefined if there is none: test first.
    const Error& error() const& noexcept { return *std::get_if<1>(&state_); }
    Error&& error() && noexcept { return std::move(*std::get_if<1>(&state_)); }

    /// The value; throws Exception if there is none.
    T& value() & { return check(), **this; }
    const T& value() const& { return check(), **this; }
    T value() && { return check(), *std::move(*this); }

private:
    void check() const {
        if (!*this) throw Exception(error());
    }
    std::variant<T, Error> state_;
};

/// Success or an Error.
template <>
class [[nodiscard]] Result<void> {
public:
    Result() = default;
    Result(Error error) : error_(std::move(error)), ok_(false) {}

    explicit operator bool() const noexcept { return ok_; }
    const Error& error() const& noexcept { return error_; }
    Error&& error() && noexcept { return std::move(error_); }
    void value() const {
        if (!ok_) throw Exception(error_);
    }

private:
    Error error_;
    bool ok_ = true;
};

} // namespace isotet
