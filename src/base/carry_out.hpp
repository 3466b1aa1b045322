// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The edge of the library for work that takes a Run.
#pragma once

#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/guard.hpp"
#include "base/parallel.hpp"
#include "base/rising_progress.hpp"

namespace isotet::core {

/// Calls work(progress), which returns a Result, on the threads of `run`. Exceptions become errors; progress is passed
/// on as rising() does.
template <class Work>
auto carry_out(std::string_view what, const Run& run, const Work& work) {
    using Value = std::invoke_result_t<const Work&, const Progress&>;
    return guarded(what, [&]() -> Value {
        const Progress rises = rising(run.progress);
        std::optional<Value> result;
        with_threads(run.threads, [&] { result.emplace(work(rises)); });
        return *std::move(result);
    });
}

} // namespace isotet::core
