// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/until_cancelled.hpp"

#include <functional>

#include <tbb/parallel_sort.h>

namespace isotet::core {

void sort_until_cancelled(const Progress& progress, std::vector<std::uint64_t>& numbers) {
    sort_until_cancelled(progress, std::less<>(), [&](const auto& before) {
        tbb::parallel_sort(numbers.begin(), numbers.end(), before);
    });
}

} // namespace isotet::core
