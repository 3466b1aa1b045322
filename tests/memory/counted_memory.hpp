// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Every piece of memory that this program takes: operator new in all its forms, and mmap, are replaced by ones that
// count.
#pragma once

#include <cstddef>
#include <functional>

namespace isotet::test {

/// The highest number of bytes held at once while `work` runs, beyond those held before.
std::size_t peak_bytes(const std::function<void()>& work);

} // namespace isotet::test
