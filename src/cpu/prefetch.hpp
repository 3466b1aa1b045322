// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Asking for memory before it is needed: waiting for it is what extraction would do most of the time.
#pragma once

#include <array>
#include <cstddef>

#include "base/prefetch.hpp"
#include "cpu/steps.hpp"

namespace isotet::cpu {

using core::prefetch;
using core::prefetch_bytes;

/// The first place of each of the next three clusters after a place.
class PlacesAhead {
public:
    PlacesAhead(const Selection& selection, std::size_t place) {
        while (count_ < next_.size()) {
            const std::uint32_t cluster = selection.clusters[place];
            do ++place;
            while (place < selection.ahead_end && selection.clusters[place] == cluster);
            if (place >= selection.ahead_end) return;
            next_[count_++] = place;
        }
    }
    bool has(std::size_t i) const { return i < count_; }
    std::size_t operator[](std::size_t i) const { return next_[i]; }

private:
    std::array<std::size_t, 3> next_;
    std::size_t count_ = 0;
};

} // namespace isotet::cpu
