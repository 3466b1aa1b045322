// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The place where the newest wish of a page waits: what is not begun when a newer one comes is never done.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

namespace isotet::view {

struct SlotRules {
    std::uint32_t max_on_the_way = 2; ///< frames that the page has not acknowledged: beyond, nothing is begun
    double patience = 0.066;          ///< seconds; work that took longer is cancelled for a newer wish
    std::uint32_t max_cancelled = 2;  ///< in a row: the next one may end, so that a long drag still shows something
};

/// The wishes of one page. Time is what the caller says it is, in seconds, never falling.
///
/// Threads   one call at a time
template <class Wish>
class Slot {
public:
    explicit Slot(SlotRules rules = {}) : rules_(rules) {}

    /// Replaces the wish that waits.
    void put(Wish wish) { waiting_ = std::move(wish); }

    /// Whether take() gives a wish.
    bool ready() const noexcept { return waiting_ && !began_ && on_the_way_ < rules_.max_on_the_way; }

    /// The wish to work on now: the newest, unless work is going on or the page is behind.
    std::optional<Wish> take(double now) {
        if (!ready()) return std::nullopt;
        began_ = now;
        return std::exchange(waiting_, std::nullopt);
    }

    /// Whether the work that is going on is to be cancelled.
    bool is_stale(double now) const noexcept {
        return began_ && waiting_ && now - *began_ > rules_.patience && cancelled_ < rules_.max_cancelled;
    }

    /// How work ended.
    enum class End : std::uint8_t {
        frame,     ///< a frame was sent
        nothing,   ///< nothing that the page acknowledges: an error, say
        cancelled, ///< by is_stale()
    };
    void finish(End end) {
        began_.reset();
        cancelled_ = end == End::cancelled ? cancelled_ + 1 : 0;
        if (end == End::frame) ++on_the_way_;
    }

    /// The page has shown a frame. More acknowledgements than frames count for nothing.
    void acknowledge() noexcept {
        if (on_the_way_ > 0) --on_the_way_;
    }

    bool is_working() const noexcept { return began_.has_value(); }
    std::uint32_t on_the_way() const noexcept { return on_the_way_; }

private:
    SlotRules rules_;
    std::optional<Wish> waiting_;
    std::optional<double> began_;
    std::uint32_t on_the_way_ = 0, cancelled_ = 0;
};

} // namespace isotet::view
