// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "paper/search/interval_tree.hpp"

#include <algorithm>
#include <numeric>

#include <tbb/parallel_invoke.h>

namespace isotet::search {

namespace {
constexpr std::size_t leaf_size = 16;
constexpr std::size_t worth_a_task = 1 << 14;
} // namespace

struct IntervalTree::Item {
    core::CutRange range;
    std::uint32_t tet;
};

/// A leaf has few ranges, in the same order in both lists.
struct IntervalTree::Node {
    float split = 0;
    bool is_leaf = false;
    std::uint32_t begin = 0, end = 0; ///< in both lists
    std::uint32_t below = 0;          ///< nodes below, for bytes()
    std::unique_ptr<Node> left, right;
};

IntervalTree::IntervalTree(const core::TetTable& table, const Progress& progress) {
    core::Buffer<std::uint32_t> all(table.tets.size());
    std::iota(all.begin(), all.end(), 0);
    build(table, {all.data(), all.size()}, progress);
}

IntervalTree::IntervalTree(const core::TetTable& table, std::span<const std::uint32_t> tets, const Progress& progress) {
    build(table, tets, progress);
}

IntervalTree::~IntervalTree() = default;

void IntervalTree::build(const core::TetTable& table, std::span<const std::uint32_t> tets, const Progress& progress) {
    core::Buffer<Item> items(tets.size());
    std::size_t count = 0;
    for (const std::uint32_t tet : tets)
        if (const core::CutRange range = table.range(tet); !range.is_empty()) items[count++] = {range, tet};
    for (List* list : {&by_lower_, &by_upper_}) {
        list->ends = core::Buffer<float>(count);
        list->tets = core::Buffer<std::uint32_t>(count);
    }
    root_ = make_node({items.data(), count}, 0, progress);
    nodes_ = root_ ? root_->below + 1 : 0;
}

/// The tree of `items`, whose places in the lists begin at `first`.
std::unique_ptr<IntervalTree::Node> IntervalTree::make_node(std::span<Item> items, std::size_t first,
                                                            const Progress& progress) {
    if (items.empty() || (items.size() >= worth_a_task && progress.cancelled())) return nullptr;
    auto node = std::make_unique<Node>();
    const auto put = [](List& list, std::size_t at, std::span<const Item> sorted, float core::CutRange::* end) {
        for (std::size_t i = 0; i < sorted.size(); ++i) {
            list.ends[at + i] = sorted[i].range.*end;
            list.tets[at + i] = sorted[i].tet;
        }
    };
    node->begin = static_cast<std::uint32_t>(first);
    node->end = static_cast<std::uint32_t>(first + items.size());
    if (items.size() <= leaf_size) {
        node->is_leaf = true;
        put(by_lower_, first, items, &core::CutRange::lower);
        put(by_upper_, first, items, &core::CutRange::upper);
        return node;
    }
    // The median of the upper ends: it belongs to a range, which stays here, and halves what is left on either side.
    const auto middle = items.begin() + static_cast<std::ptrdiff_t>(items.size() / 2);
    std::nth_element(items.begin(), middle, items.end(),
                     [](const Item& a, const Item& b) { return a.range.upper < b.range.upper; });
    const float split = node->split = middle->range.upper;
    const auto here =
        std::partition(items.begin(), items.end(), [&](const Item& item) { return item.range.upper < split; });
    const auto right = std::partition(here, items.end(), [&](const Item& item) { return item.range.lower < split; });
    const std::span<Item> own(here, right);
    const auto begin = first + static_cast<std::size_t>(here - items.begin());
    node->begin = static_cast<std::uint32_t>(begin);
    node->end = static_cast<std::uint32_t>(begin + own.size());
    const auto by = [](auto key) {
        return [key](const Item& a, const Item& b) { return key(a) != key(b) ? key(a) < key(b) : a.tet < b.tet; };
    };
    const auto own_part = [&] {
        std::sort(own.begin(), own.end(), by([](const Item& item) { return item.range.lower; }));
        put(by_lower_, begin, own, &core::CutRange::lower);
        std::sort(own.begin(), own.end(), by([](const Item& item) { return -item.range.upper; }));
        put(by_upper_, begin, own, &core::CutRange::upper);
    };
    const auto left_part = [&] { node->left = make_node({items.begin(), here}, first, progress); };
    const auto right_part = [&] { node->right = make_node({right, items.end()}, begin + own.size(), progress); };
    if (items.size() >= worth_a_task) {
        tbb::parallel_invoke(own_part, left_part, right_part);
    } else {
        own_part();
        left_part();
        right_part();
    }
    for (const Node* child : {node->left.get(), node->right.get()})
        if (child) node->below += child->below + 1;
    return node;
}

std::uint64_t IntervalTree::bytes() const {
    return by_lower_.ends.bytes() + by_lower_.tets.bytes() + by_upper_.ends.bytes() + by_upper_.tets.bytes() +
           nodes_ * sizeof(Node);
}

void IntervalTree::find(float isovalue, TetNumbers& found) const {
    found.clear();
    /// Takes of a node's part of a list what stands before the first end that does not fit.
    const auto take = [&](const List& list, const Node& node, const auto& fits) {
        const auto first = list.ends.begin() + node.begin, last = list.ends.begin() + node.end;
        const auto count = static_cast<std::uint32_t>(std::partition_point(first, last, fits) - first);
        found.insert(found.end(), list.tets.begin() + node.begin, list.tets.begin() + node.begin + count);
    };
    for (const Node* node = root_.get(); node;) {
        if (node->is_leaf) {
            for (std::uint32_t i = node->begin; i < node->end; ++i)
                if (core::CutRange{by_lower_.ends[i], by_upper_.ends[i]}.holds(isovalue))
                    found.push_back(by_lower_.tets[i]);
            return;
        }
        if (isovalue <= node->split) {
            take(by_lower_, *node, [&](float lower) { return lower < isovalue; });
            node = isovalue < node->split ? node->left.get() : nullptr;
        } else {
            take(by_upper_, *node, [&](float upper) { return upper >= isovalue; });
            node = node->right.get();
        }
    }
}

} // namespace isotet::search
