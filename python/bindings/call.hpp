// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Calls of the library from Python: without the interpreter's lock, stopped by signals, errors as exceptions.
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet::python {

namespace nb = nanobind;

/// Adds isotet.Error, and finds out which thread signals are for.
void prepare_calls(nb::module_& module);

/// Throws the exception that stands for an error: ValueError, MemoryError, OSError or isotet.Error.
[[noreturn]] void raise(const Error& error);

/// What a user can say of a call: `threads`, and `progress`, None or a function of a step and a fraction.
struct CallOptions {
    int threads = 0;
    nb::object progress;
};

using Sessions = std::vector<const void*>;

/// Throws RuntimeError where this thread is in a progress function of a call of one of the sessions: their locks are held.
void refuse_inside(const Sessions& sessions);

/// One call of the library, while it runs.
class Call {
public:
    /// `sessions`   whose locks the work holds while it tells its progress
    explicit Call(const CallOptions& options, Sessions sessions = {});
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

    const Run& run() const { return run_; }

    /// Does the work without the interpreter's lock. In the main thread it is done by another one, while this one handles
    /// signals: an exception of a handler stops the work, and so does one of the progress function.
    void carry_out(const std::function<void()>& work);

private:
    void report(std::string_view step, double fraction);
    void tell(std::string_view step, double fraction);
    void stop(nb::python_error&& error);
    void wait_for_worker(const std::function<void()>& work);

    nb::object progress_;
    Sessions sessions_;
    Run run_;
    std::atomic<bool> cancel_ = false;
    bool waiting_ = false; ///< the calling thread waits for the worker, and calls the progress function
    std::mutex mutex_; ///< of stopped_
    std::optional<nb::python_error> stopped_;
};

/// Calls `function` with a Run, and returns the value of its Result.
template <class Function>
auto call(const CallOptions& options, Function&& function, Sessions sessions = {}) {
    Call call(options, std::move(sessions));
    std::optional<decltype(function(call.run()))> result;
    call.carry_out([&] { result.emplace(function(call.run())); });
    if (!*result) raise(result->error());
    if constexpr (requires { **result; }) return **std::move(result);
}

} // namespace isotet::python
