// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The numbers of nodes in EnSight 6, by which its elements name them.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "io/confined/ensight/ensight_file.hpp"

namespace isotet::io::confined {

/// Listed where the file says "node id given" or "ignore"; used where it says "given", else nodes are numbered from 1.
class NodeNumbers {
public:
    explicit NodeNumbers(std::string_view line);

    bool are_listed() const noexcept { return kind_ != Kind::none; }
    bool are_given() const noexcept { return kind_ == Kind::given; }

    /// `given`   a number of each node; throws where one is there twice, or none
    void set(const EnsightFile& file, const std::vector<std::int64_t>& given, std::uint64_t count);

    void expect(const EnsightFile& file, std::int64_t number) const;

    /// The place of a node with a number that is there, from 1.
    std::int64_t place(std::int64_t number) const;

private:
    enum class Kind : std::uint8_t { none, given, ignored };

    Kind kind_ = Kind::none;
    std::uint64_t count_ = 0;
    std::vector<std::uint32_t> places_; ///< of each number, from 1; 0: none
};

} // namespace isotet::io::confined
