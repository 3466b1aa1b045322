// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/cells_in_order.hpp"

#include <cstddef>
#include <map>
#include <mutex>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "grid/cell_block.hpp"
#include "grid/fixed_corners.hpp"

namespace isotet::io {
namespace {

class InOrder {
public:
    InOrder(const CellPlaces& places, VisitInOrder visit) : places_(places), visit_(std::move(visit)) {}

    void add(std::uint64_t first, const Array& corners) {
        const std::lock_guard lock(mutex_);
        if (first != next_) {
            std::vector<std::uint64_t>& waits = waiting_[first];
            append(corners, waits);
            return;
        }
        append(corners, corners_);
        next_ += corners.size();
        for (auto waits = waiting_.find(next_); waits != waiting_.end(); waits = waiting_.find(next_)) {
            corners_.insert(corners_.end(), waits->second.begin(), waits->second.end());
            next_ += waits->second.size();
            waiting_.erase(waits);
        }
        if (corners_.size() >= corners_at_once) hand_over();
    }

    void finish() { hand_over(); }

private:
    static constexpr std::size_t corners_at_once = std::size_t{1} << 20;

    static void append(const Array& corners, std::vector<std::uint64_t>& to) {
        const std::size_t before = to.size();
        to.resize(before + corners.size());
        corners.visit([&]<class Index>(std::span<const Index> values) {
            if constexpr (std::is_integral_v<Index>)
                for (std::size_t i = 0; i < values.size(); ++i) to[before + i] = core::widened(values[i]);
        });
    }

    void hand_over() {
        if (corners_.empty()) return;
        const std::uint64_t last = places_.cell_at(next_ - 1);
        const std::uint64_t end = places_.begin(last + 1) == next_ ? last + 1 : last;
        const std::uint64_t count = places_.begin(end) - places_.begin(cell_);
        if (end == cell_) return;
        visit_(cell_, end - cell_, Array::borrow(std::span<const std::uint64_t>(corners_).first(count)));
        corners_.erase(corners_.begin(), corners_.begin() + static_cast<std::ptrdiff_t>(count));
        cell_ = end;
    }

    const CellPlaces& places_;
    VisitInOrder visit_;
    std::mutex mutex_;
    std::map<std::uint64_t, std::vector<std::uint64_t>> waiting_; ///< by the first; one thread needs it hardly ever
    std::vector<std::uint64_t> corners_;                          ///< of cells from `cell_` on
    std::uint64_t next_ = 0, cell_ = 0;
};

} // namespace

Result<void> each_in_order(const CellSource& cells, const VisitInOrder& visit) {
    const int threads = core::threads_here();
    InOrder in_order(cells.places(), [&](std::uint64_t first, std::uint64_t count, const Array& corners) {
        core::with_threads(threads, [&] { visit(first, count, corners); });
    });
    Result<void> done;
    core::with_threads(1, [&] {
        done = cells.each_block([&](std::uint64_t first, const Array& corners) { in_order.add(first, corners); });
    });
    if (done) in_order.finish();
    return done;
}

CellsInTurn cells_in_turn(const CellSource& cells, const Array& points) {
    const auto each = [&cells, bare = Grid{points, {}, {}, {}}](const auto& take) {
        const CellPlaces& places = cells.places();
        return each_in_order(cells, [&](std::uint64_t first, std::uint64_t count, const Array& corners) {
            take(first, places.are_uniform() ? core::block_of(bare, static_cast<CellType>(places.type(0)), corners)
                                             : core::block_of(bare, places.types(first, count), corners));
        });
    };
    return {cells.places().cells(), each};
}

} // namespace isotet::io
