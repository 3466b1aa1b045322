// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The edge of the library: what is thrown inside (by allocations, mostly) leaves as an Error.
#pragma once

#include <exception>
#include <new>
#include <string>
#include <string_view>

#include <isotet/result.hpp>

namespace isotet::core {

/// Calls `work`, which returns a Result, and turns exceptions into errors.
template <class Work>
auto guarded(std::string_view what, Work&& work) -> decltype(work()) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::out_of_memory, std::string(what) + " ran out of memory"};
    } catch (const std::exception& e) {
        return Error{ErrorCode::internal, std::string(what) + " failed: " + e.what()};
    } catch (...) { // by a callback of the caller
        return Error{ErrorCode::internal, std::string(what) + " failed: something was thrown that is no std::exception"};
    }
}

} // namespace isotet::core
