// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/parts.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/parallel.hpp"

namespace isotet::linear {

namespace {

constexpr std::uint32_t narrow_derived_bit = std::uint32_t{1} << 31;

/// Where a block's part of the arrays begins.
struct BlockPlace {
    std::uint64_t cell = 0, corner = 0, row = 0, term = 0;
};

void add(LinearizeReport& sum, const LinearizeReport& part) {
    sum.polyhedra += part.polyhedra;
    sum.known_shapes += part.known_shapes;
    sum.centred += part.centred;
    sum.moved_centres += part.moved_centres;
    sum.folded += part.folded;
    sum.open += part.open;
    sum.cells += part.cells;
    sum.unmet += part.unmet;
    sum.high_degree += part.high_degree;
    sum.high_degree_parts += part.high_degree_parts;
}

template <class T>
core::Buffer<T> take(std::vector<T>& from) {
    core::Buffer<T> out(from.size());
    std::ranges::copy(from, out.begin());
    from.clear();
    return out;
}

} // namespace

void Parts::add_cell(std::uint8_t type, std::span<const std::uint64_t> corners, std::uint64_t source) {
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    corner_counts_.push_back(static_cast<std::uint32_t>(corners.size()));
    types_.push_back(type);
    add_source(source);
}

void Parts::add_source(std::uint64_t source) {
    if (sources_.empty() || sources_.back() != source) {
        sources_.push_back(source);
        part_counts_.push_back(0);
    }
    ++part_counts_.back();
}

void Parts::keep_cell(const core::CellReader& cells, std::size_t cell) {
    const std::uint64_t first = cells.first(cell), count = cells.corners(cell);
    for (std::uint64_t i = 0; i < count; ++i) corners_.push_back(cells.corner(first + i));
    corner_counts_.push_back(static_cast<std::uint32_t>(count));
    types_.push_back(cells.type(cell));
    add_source(cell);
}

std::uint64_t Parts::add_point(std::span<const std::uint64_t> points, std::span<const double> weights) {
    term_points_.insert(term_points_.end(), points.begin(), points.end());
    const bool alike = std::ranges::all_of(weights, [&](double weight) { return weight == weights[0]; });
    alike_.push_back(alike);
    if (alike) weights = weights.first(std::min<std::size_t>(weights.size(), 1));
    term_weights_.insert(term_weights_.end(), weights.begin(), weights.end());
    term_counts_.push_back(static_cast<std::uint32_t>(points.size()));
    return derived_bit + term_counts_.size() - 1;
}

void Parts::clear() {
    corners_.clear();
    corner_counts_.clear();
    types_.clear();
    sources_.clear();
    part_counts_.clear();
    term_counts_.clear();
    term_points_.clear();
    alike_.clear();
    term_weights_.clear();
    report = {};
}

KeptParts::KeptParts(Parts& parts, bool narrow)
    : corner_counts_(take(parts.corner_counts_)),
      part_counts_(take(parts.part_counts_)),
      term_counts_(take(parts.term_counts_)),
      types_(take(parts.types_)),
      alike_(take(parts.alike_)),
      sources_(take(parts.sources_)),
      term_weights_(take(parts.term_weights_)),
      report_(std::exchange(parts.report, {})) {
    if (!narrow) {
        wide_corners_ = take(parts.corners_);
        wide_terms_ = take(parts.term_points_);
        return;
    }
    narrow_terms_ = core::Buffer<std::uint32_t>(parts.term_points_.size());
    std::ranges::transform(parts.term_points_, narrow_terms_.begin(),
                           [](std::uint64_t point) { return static_cast<std::uint32_t>(point); });
    parts.term_points_.clear();
    narrow_corners_ = core::Buffer<std::uint32_t>(parts.corners_.size());
    std::ranges::transform(parts.corners_, narrow_corners_.begin(), [](std::uint64_t corner) {
        const auto low = static_cast<std::uint32_t>(corner);
        return corner & Parts::derived_bit ? low | narrow_derived_bit : low;
    });
    parts.corners_.clear();
}

class PartsJoiner {
public:
    PartsJoiner(std::vector<KeptParts>& blocks, std::uint64_t user_points)
        : blocks_(blocks), user_points_(user_points), places_(blocks.size() + 1) {
        for (std::size_t b = 0; b < blocks.size(); ++b) {
            const KeptParts& block = blocks[b];
            const BlockPlace& at = places_[b];
            places_[b + 1] = {
                at.cell + block.types_.size(), at.corner + block.narrow_corners_.size() + block.wide_corners_.size(),
                at.row + block.term_counts_.size(), at.term + block.narrow_terms_.size() + block.wide_terms_.size()};
        }
    }

    LinearGrid join() {
        LinearGrid out;
        for (const KeptParts& block : blocks_) add(out.report, block.report_);
        constexpr std::uint64_t narrow = std::numeric_limits<std::int32_t>::max();
        if (user_points_ + end().row <= narrow && end().corner <= narrow) join_cells<std::int32_t>(out.grid.cells);
        else join_cells<std::int64_t>(out.grid.cells);
        join_sources_and_rows(out);
        out.user_points = user_points_;
        return out;
    }

private:
    const BlockPlace& end() const { return places_.back(); }

    /// A block's corners by their numbers in the whole.
    template <class Index>
    void write_corners(const KeptParts& block, const BlockPlace& at, Index* to) const {
        const std::uint64_t first_row = user_points_ + at.row;
        for (const std::uint32_t corner : block.narrow_corners_)
            *to++ =
                static_cast<Index>(corner & narrow_derived_bit ? first_row + (corner - narrow_derived_bit) : corner);
        for (const std::uint64_t corner : block.wide_corners_)
            *to++ =
                static_cast<Index>(corner & Parts::derived_bit ? first_row + (corner - Parts::derived_bit) : corner);
    }

    template <class Index>
    void join_cells(Cells& cells) {
        core::Buffer<Index> connectivity(end().corner), offsets(end().cell + 1);
        core::Buffer<std::uint8_t> types(end().cell);
        offsets[0] = 0;
        core::parallel_each(blocks_.size(), 1, [&](std::size_t b) {
            KeptParts& block = blocks_[b];
            const BlockPlace& at = places_[b];
            write_corners(block, at, connectivity.data() + at.corner);
            std::uint64_t sum = at.corner;
            for (std::size_t i = 0; i < block.corner_counts_.size(); ++i)
                offsets[at.cell + i + 1] = static_cast<Index>(sum += block.corner_counts_[i]);
            std::ranges::copy(block.types_, types.begin() + at.cell);
            block.narrow_corners_.release();
            block.wide_corners_.release();
            block.corner_counts_.release();
            block.types_.release();
        });
        cells.connectivity = std::move(connectivity).to_array();
        cells.offsets = std::move(offsets).to_array();
        cells.types = std::move(types).to_array();
    }

    /// Whether all weights are those of the mean of their row.
    bool are_means() const {
        return std::ranges::all_of(blocks_, [](const KeptParts& block) {
            for (std::size_t i = 0; i < block.term_counts_.size(); ++i) // one weight stands for a row of equal ones
                if (!block.alike_[i] || block.term_weights_[i] != 1 / static_cast<double>(block.term_counts_[i]))
                    return false;
            return true;
        });
    }

    void join_sources_and_rows(LinearGrid& out) {
        const bool means = out.report.high_degree == 0 && are_means(); // of nearly every grid
        core::Buffer<std::uint64_t> sources(end().cell), first(end().row + 1), points(end().term);
        core::Buffer<double> weights(means ? 0 : end().term);
        first[0] = 0;
        core::parallel_each(blocks_.size(), 1, [&](std::size_t b) {
            const KeptParts& block = blocks_[b];
            const BlockPlace& at = places_[b];
            std::uint64_t* source = sources.data() + at.cell;
            for (std::size_t i = 0; i < block.sources_.size(); ++i)
                source = std::fill_n(source, block.part_counts_[i], block.sources_[i]);
            std::uint64_t sum = at.term;
            const double* weight = block.term_weights_.data();
            for (std::size_t i = 0; i < block.term_counts_.size(); ++i) {
                const std::uint32_t count = block.term_counts_[i];
                if (block.alike_[i] && !means) std::fill_n(weights.data() + sum, count, *weight);
                else if (!means) std::copy_n(weight, count, weights.data() + sum);
                weight += block.alike_[i] ? std::min(count, 1U) : count;
                first[at.row + i + 1] = sum += count;
            }
            std::ranges::copy(block.narrow_terms_, points.begin() + at.term);
            std::ranges::copy(block.wide_terms_, points.begin() + at.term);
            blocks_[b] = {};
        });
        out.source_cells = std::move(sources).to_array();
        out.derived = {std::move(first).to_array(), std::move(points).to_array(), {}};
        if (!means) out.derived.weights = std::move(weights).to_array();
    }

    std::vector<KeptParts>& blocks_;
    std::uint64_t user_points_;
    std::vector<BlockPlace> places_;
};

LinearGrid joined(std::vector<KeptParts>& blocks, std::uint64_t user_points) {
    return PartsJoiner(blocks, user_points).join();
}

} // namespace isotet::linear
