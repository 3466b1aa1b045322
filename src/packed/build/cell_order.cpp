// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "packed/build/cell_order.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/parallel.hpp"
#include "base/workers.hpp"
#include "base/prefetch.hpp"
#include "grid/cell/native_cells.hpp"
#include "packed/build/bucket_sorter.hpp"
#include "packed/build/point_order.hpp"

namespace isotet::core {

namespace {

/// The user's points by rank, and back.
struct Ranks {
    Buffer<std::uint64_t> point_of;
    Buffer<std::uint32_t> rank_of;
};

Result<Ranks> rank_points(const PointReader& points, const Buffer<std::uint8_t>& used) {
    const Buffer<Keyed> sorted = sort_points(points, used);
    constexpr std::size_t limit = std::numeric_limits<std::uint32_t>::max();
    if (sorted.size() >= limit)
        return Error{ErrorCode::invalid_data,
                     fmt::format("the cells use {} points, but there can be {}", sorted.size(), limit - 1)};
    Ranks ranks{Buffer<std::uint64_t>(sorted.size()), Buffer<std::uint32_t>(used.size())};
    worker_ranges(sorted.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t rank = begin; rank < end; ++rank) {
            ranks.point_of[rank] = sorted[rank].number;
            ranks.rank_of[sorted[rank].number] = static_cast<std::uint32_t>(rank);
        }
    });
    return ranks;
}

/// The coordinates of the used points by rank: those of a tet's corners are close together, wherever the user has them.
template <class Real>
Array coordinates_by_rank(std::span<const Real> user, const Buffer<std::uint64_t>& point_of) {
    constexpr std::size_t ahead = 16;
    Buffer<Real> out(3 * point_of.size());
    worker_ranges(point_of.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t rank = begin; rank < end; ++rank) {
            prefetch(user.data() + 3 * point_of[std::min(rank + ahead, end - 1)]);
            std::copy_n(user.data() + 3 * point_of[rank], 3, out.data() + 3 * rank);
        }
    });
    return std::move(out).to_array(3);
}

Array coordinates_by_rank(const Array& user, const Buffer<std::uint64_t>& point_of) {
    return user.type() == ScalarType::float32 ? coordinates_by_rank(user.as<float>(), point_of)
                                              : coordinates_by_rank(user.as<double>(), point_of);
}

/// How many writers share the cells: more than threads, since some of them may be slower than others.
std::size_t writers_for(std::size_t cells) {
    const auto threads = static_cast<std::size_t>(threads_here());
    return std::min(std::max(threads, std::min<std::size_t>(8 * threads, 128)), 1 + (cells >> 16));
}

/// Deals out what the cells [begin, end) give. Each waits for a while behind others, as the ranks of its points are on
/// their way from memory.
template <class Item>
class Dealer {
public:
    Dealer(const Buffer<std::uint32_t>& rank_of, typename RankedBuckets<Item>::Writer& writer)
        : rank_of_(rank_of), writer_(writer) {}
    ~Dealer() {
        for (std::size_t i = arrived_ - std::min(arrived_, most); i < arrived_; ++i) deal(queue_[i % most]);
    }
    Dealer(const Dealer&) = delete;
    Dealer& operator=(const Dealer&) = delete;

    /// `corners`   user's points
    void put(std::span<const std::uint64_t> corners, CellOrigin origin) {
        for (const std::uint64_t corner : corners) prefetch(&rank_of_[corner]);
        Waiting& place = queue_[arrived_ % most];
        if (arrived_++ >= most) deal(place);
        std::copy(corners.begin(), corners.end(), place.corners.begin());
        place.count = corners.size();
        place.origin = origin;
    }

private:
    static constexpr std::size_t most = 32;
    static constexpr std::size_t max_corners = sizeof(Item) / sizeof(std::uint32_t);

    struct Waiting {
        std::array<std::uint64_t, max_corners> corners;
        std::size_t count;
        CellOrigin origin;
    };

    void deal(const Waiting& waiting) {
        if constexpr (max_corners == 4) {
            RankedTet tet;
            for (std::size_t k = 0; k < 4; ++k) tet[k] = rank_of_[waiting.corners[k]];
            writer_.put(tet, lowest_rank(tet), waiting.origin);
        } else {
            RankedCell cell;
            cell.corners.fill(RankedCell::no_corner);
            for (std::size_t k = 0; k < waiting.count; ++k) cell.corners[k] = rank_of_[waiting.corners[k]];
            writer_.put(cell, lowest_rank(cell), waiting.origin);
        }
    }

    const Buffer<std::uint32_t>& rank_of_;
    typename RankedBuckets<Item>::Writer& writer_;
    std::array<Waiting, most> queue_;
    std::size_t arrived_ = 0;
};

CellOrigin origin_of(const PointReader& points, const CellReader& cells, std::size_t cell, const CellTets& tets) {
    const std::uint8_t type = cells.type(cell);
    if (is_ordered(type)) return CellOrigin::make_ordered(cell);
    return CellOrigin::make(cell, !Orienter::is_whole(type) && Orienter::six_volumes(points, tets) < 0);
}

void deal_out(const PointReader& points, const CellReader& cells, std::size_t begin, std::size_t end,
              const Buffer<std::uint32_t>& rank_of, RankedBuckets<RankedTet>::Writer& writer) {
    Dealer<RankedTet> dealer(rank_of, writer);
    cells.for_cells(begin, end, [&](std::size_t cell, const CellTets& pieces) {
        CellOrigin origin = CellOrigin::make(cell, false);
        if (!cells.only_tets()) origin = origin_of(points, cells, cell, pieces);
        for (const Tet& corners : pieces) dealer.put(corners, origin);
    });
}

void deal_out(const PointReader& points, const CellReader& cells, std::size_t begin, std::size_t end,
              const Buffer<std::uint32_t>& rank_of, RankedBuckets<RankedCell>::Writer& writer) {
    Dealer<RankedCell> dealer(rank_of, writer);
    for (std::size_t cell = begin; cell < end; ++cell) {
        if (!is_contoured(cells.type(cell))) continue;
        const NativeParts parts = native_parts(cells.whole(cell));
        CellOrigin origin = is_ordered(cells.type(cell)) ? CellOrigin::make_ordered(cell) : CellOrigin::make(cell, false);
        if (parts.count && parts.cells[0].kind == CellKind::tetrahedron)
            origin = origin_of(points, cells, cell, cells.tets(cell));
        for (const WholeCell& part : parts) dealer.put({part.corners.data(), corner_count(part.kind)}, origin);
    }
}

RankedTet& corners_of_item(RankedTet& tet) { return tet; }
std::array<std::uint32_t, 8>& corners_of_item(RankedCell& cell) { return cell.corners; }

Error cancelled() { return Error{ErrorCode::cancelled, "packing was cancelled"}; }

} // namespace

template <class Item>
Result<CellOrder<Item>> sort_cells(const Grid& grid, const CellReader& cells, CellCounts counts,
                                   const CellOrderOptions& options, const Progress& progress) {
    const bool keep_origins = options.keep_origins;
    const PointReader points(grid.points);
    auto ranks = rank_points(points, counts.used);
    if (!ranks) return ranks.error();
    counts.used.release();
    CellOrder<Item> order;
    order.point_of = std::move(ranks->point_of);
    if (progress.cancelled()) return cancelled();
    progress("pack", 0.05);

    const std::size_t writers = writers_for(cells.count());
    order.cells =
        RankedBuckets<Item>(order.point_of.size(), counts.stored, writers, keep_origins || !cells.only_tets());
    worker_each(writers, 1, [&](std::size_t w) {
        typename RankedBuckets<Item>::Writer writer(order.cells, w);
        constexpr std::size_t cells_at_once = 1 << 14;
        const std::size_t last = cells.count() / writers * (w + 1) + std::min(w + 1, cells.count() % writers);
        for (std::size_t begin = cells.count() / writers * w + std::min(w, cells.count() % writers); begin < last;
             begin += cells_at_once) {
            if (progress.cancelled()) return;
            deal_out(points, cells, begin, std::min(begin + cells_at_once, last), ranks->rank_of, writer);
        }
    });
    if (progress.cancelled()) return cancelled();
    ranks->rank_of.release();
    progress("pack", 0.15);

    std::vector<SortedBucket> sorted(order.cells.buckets());
    {
        const Array coordinates = coordinates_by_rank(grid.points, order.point_of);
        const RankedPoints ranked{order.point_of.data(), PointReader(coordinates)};
        worker_each(sorted.size(), 1, [&](std::size_t bucket) {
            if (!progress.cancelled()) sorted[bucket] = sort_bucket(ranked, cells, bucket, order.cells);
        });
    }
    if (progress.cancelled()) return cancelled();
    std::int64_t balance = 0;
    for (const SortedBucket& bucket : sorted) {
        order.orientation.combine(bucket.orientation);
        order.repeated += bucket.repeated;
        balance += bucket.balance;
        for (std::size_t k = 0; k < cell_kind_count; ++k) order.kinds[k] += bucket.kinds[k];
    }
    const bool mostly_negative = options.mostly_negative.value_or(balance < 0);
    if (mostly_negative) // in the canonical order, mirroring is an exchange of the last two corners
        for (std::size_t bucket = 0; bucket < sorted.size(); ++bucket)
            for (const std::size_t i : sorted[bucket].flat) {
                auto& corners = corners_of_item(order.cells.sorted(bucket, i));
                std::swap(corners[2], corners[3]);
            }
    order.inverted = order.orientation.inverted(mostly_negative);
    if (!keep_origins) order.cells.drop_origins();
    order.cells.number();
    progress("pack", 0.3);
    return order;
}

template Result<CellOrder<RankedTet>> sort_cells<RankedTet>(const Grid&, const CellReader&, CellCounts,
                                                            const CellOrderOptions&, const Progress&);
template Result<CellOrder<RankedCell>> sort_cells<RankedCell>(const Grid&, const CellReader&, CellCounts,
                                                              const CellOrderOptions&, const Progress&);

} // namespace isotet::core
