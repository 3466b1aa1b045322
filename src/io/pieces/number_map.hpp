// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From the numbers that a file gives to its points or cells to their positions in the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

namespace isotet::io {

/// Numbers in the order of the file; the position of each.
///
/// Numbers that count up by one, as in most files, take no memory at all. Others take a table as long as their range,
/// or, where that would be mostly empty, a sorted list.
class NumberMap {
public:
    static constexpr std::uint64_t none = ~std::uint64_t{0};

    /// The number of the next position.
    void add(std::int64_t number) {
        if (consecutive_) {
            if (count_ == 0) first_ = number;
            if (static_cast<std::uint64_t>(number) == static_cast<std::uint64_t>(first_) + count_) {
                ++count_;
                return;
            }
            spread();
        }
        numbers_.push_back(number);
        ++count_;
    }

    std::uint64_t size() const noexcept { return count_; }

    /// Ends the adding; find() works from here on.
    ///
    /// `what`   "node", for the message
    /// Errors   invalid_data when a number was added twice
    /// Cost     O(n), or O(n log n) for sparse numbers
    ISOTET_API Result<void> close(std::string_view what);

    /// True where the same numbers have the same positions; both were closed.
    bool operator==(const NumberMap&) const = default;

    /// The position of a number, or `none`.
    std::uint64_t find(std::int64_t number) const noexcept {
        const std::uint64_t from_first = static_cast<std::uint64_t>(number) - static_cast<std::uint64_t>(first_);
        if (consecutive_) return from_first < count_ ? from_first : none;
        if (sorted_.empty())
            return from_first < table_.size() && table_[from_first] != empty ? table_[from_first] : none;
        return find_sorted(number);
    }

private:
    static constexpr std::uint32_t empty = ~std::uint32_t{0};

    ISOTET_API void spread();
    ISOTET_API std::uint64_t find_sorted(std::int64_t number) const noexcept;

    std::int64_t first_ = 0; ///< of consecutive numbers the first, of a table the lowest
    std::uint64_t count_ = 0;
    bool consecutive_ = true;
    std::vector<std::int64_t> numbers_; ///< until close()
    std::vector<std::uint32_t> table_;
    std::vector<std::pair<std::int64_t, std::uint64_t>> sorted_;
};

} // namespace isotet::io
