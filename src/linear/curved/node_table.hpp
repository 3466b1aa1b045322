// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The nodes that cells have on their edges and faces, for neighbours that have none there.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "linear/curved/quadratic.hpp"

namespace isotet::linear {

/// The node of a set of corners, of two or four.
template <std::size_t corners>
class NodeTable {
public:
    using Key = std::array<Node, corners>;

    void add(Key key, Node node) {
        std::ranges::sort(key);
        entries_.push_back({key, node});
    }
    void add(const NodeTable& other) { entries_.insert(entries_.end(), other.entries_.begin(), other.entries_.end()); }
    /// Call before find(). Of several nodes of one key the lowest counts.
    void sort() { std::ranges::sort(entries_); }

    std::optional<Node> find(Key key) const {
        std::ranges::sort(key);
        const auto found = std::ranges::lower_bound(entries_, key, {}, &Entry::key);
        if (found == entries_.end() || found->key != key) return std::nullopt;
        return found->node;
    }

private:
    struct Entry {
        Key key;
        Node node;
        auto operator<=>(const Entry&) const = default;
    };
    std::vector<Entry> entries_;
};

} // namespace isotet::linear
