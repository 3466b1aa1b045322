// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Progress and cancel inside the loops of readers, cheap enough to ask at every record.
#pragma once

#include <cstddef>
#include <cstdint>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet::io {

/// Every 65,536th call reports how far the reader is in the file, and looks whether to stop.
class Pace {
public:
    Pace(const Progress& progress, std::size_t total_bytes) : progress_(progress), total_(total_bytes) {}

    /// False when the user has cancelled.
    bool goes_on(std::size_t position) {
        if ((++calls_ & 0xFFFFU) != 0) return true;
        return look(position);
    }

    static Error cancelled() { return {ErrorCode::cancelled, "reading was cancelled"}; }

private:
    bool look(std::size_t position) {
        if (progress_.cancelled()) return false;
        if (total_ > 0) progress_("read", static_cast<double>(position) / static_cast<double>(total_));
        return true;
    }

    const Progress& progress_;
    std::size_t total_;
    std::uint32_t calls_ = 0;
};

} // namespace isotet::io
