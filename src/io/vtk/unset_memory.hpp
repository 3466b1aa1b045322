// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Values that a reader never wrote: it took memory, and found less in the file than it had thought.
#pragma once

#include <isotet/result.hpp>

#include "io/own/loaded.hpp"

namespace isotet::io::vtk {

/// As long as it lives, malloc() fills what it gives with a byte that no sensible value consists of. Costs a pass over
/// the memory.
class MarkedMemory {
public:
    MarkedMemory();
    ~MarkedMemory();
    MarkedMemory(const MarkedMemory&) = delete;
    MarkedMemory& operator=(const MarkedMemory&) = delete;

    /// Errors   invalid_data, with the array and the tuple, when coordinates or fields hold a value of that byte alone
    static Result<void> check(const std::string& path, const Loaded& loaded);
};

} // namespace isotet::io::vtk
