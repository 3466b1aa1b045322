// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/faces.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <limits>
#include <mutex>
#include <optional>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_sort.h>

#include "base/dealt.hpp"
#include "base/parallel.hpp"
#include "grid/cell_sums.hpp"
#include "grid/face_counter.hpp"

namespace isotet::core {

namespace {

// Outward faces of an upright tet.
constexpr std::size_t face_corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

struct DirectedFace {
    std::array<std::uint64_t, 3> points; ///< ascending
    bool mirrored;                       ///< the tet's own order is an odd permutation of that
};

DirectedFace face_of(const Tet& tet, std::size_t f) {
    std::array<std::uint64_t, 3> p{tet[face_corners[f][0]], tet[face_corners[f][1]], tet[face_corners[f][2]]};
    const bool odd = (p[0] > p[1]) ^ (p[0] > p[2]) ^ (p[1] > p[2]);
    std::sort(p.begin(), p.end());
    return {p, odd};
}

constexpr std::uint64_t max_tets_of_cell = 6;
constexpr std::uint64_t tets_per_bucket = 1 << 13; ///< faces and tets of a bucket stay in the second cache
constexpr std::uint64_t max_buckets = 4096;        ///< so many lines that are written at once do, too
constexpr std::size_t min_chunk = 1 << 14, max_chunks = 256;

PointBuckets buckets_for(std::uint64_t points, std::uint64_t tets) {
    const std::uint64_t buckets = std::clamp<std::uint64_t>(tets / tets_per_bucket, 1, max_buckets);
    return {static_cast<unsigned>(std::bit_width((points - 1) / buckets))};
}

/// Finds the points where faces may be unbalanced, deals the tets there, and counts bucket by bucket.
template <class Point>
class FaceSurveyor {
public:
    FaceSurveyor(const Grid& grid, const CellReader& cells, const TetSurvey& survey, const Progress& progress)
        : grid_points_(grid.points),
          points_(grid.points),
          cells_(cells),
          survey_(survey),
          progress_(progress),
          chunks_(std::clamp<std::size_t>(cells.count() / min_chunk, 1, max_chunks)) {}

    /// Faces are kept, too, unless there are more.
    void keep_faces(std::uint64_t most) { most_kept_ = most; }

    std::vector<BoundaryFace> faces() {
        std::size_t count = 0;
        for (const auto& some : faces_) count += some.size();
        std::vector<BoundaryFace> all;
        all.reserve(count);
        for (auto& some : faces_) {
            all.insert(all.end(), some.begin(), some.end());
            some = {};
        }
        return all;
    }

    /// The cells are those with such points.
    void count_at(Buffer<std::uint8_t> doubted) {
        doubted_ = std::move(doubted);
        to_count_ = max_tets_of_cell * cells_.count();
    }

    Result<FaceSurvey> run(std::uint64_t memory) {
        if (doubted_.empty() && cells_.points() * FaceSums::bytes_per_point <= memory) find_doubted();
        buckets_ = buckets_for(cells_.points(), to_count_);
        bucket_count_ = buckets_.of(cells_.points() - 1) + 1;
        if (most_kept_ > 0) faces_.resize(bucket_count_);
        const std::uint64_t bytes = 2 * to_count_ * sizeof(AscendingTet<Point>); // a tet is in at most two buckets
        const std::uint64_t rounds =
            std::min<std::uint64_t>(1 + bytes / std::max<std::uint64_t>(memory, 1), bucket_count_);
        const std::size_t buckets_per_round = (bucket_count_ + rounds - 1) / rounds;
        for (std::size_t first = 0; first < bucket_count_ && !progress_.cancelled(); first += buckets_per_round)
            count(first, std::min(first + buckets_per_round, bucket_count_));
        if (progress_.cancelled()) return Error{ErrorCode::cancelled, "checking the grid was cancelled"};
        FaceSurvey found{total_.repeated, total_.unbalanced, {}};
        if (total_.unbalanced <= most_kept_) found.faces = faces();
        return found;
    }

private:
    /// Finds the points of which faces must be counted one by one, and how many tets about have them.
    void find_doubted() {
        CellSums sums(grid_points_, survey_.all_alike());
        parallel_pieces(cells_.count(), min_chunk, progress_,
                        [&](std::size_t begin, std::size_t end) { sums.add(cells_, begin, end); });
        sums.finish();
        doubted_ = sums.take_doubted();
        const double points = static_cast<double>(cells_.points() - survey_.unused);
        const double tets_of_a_point = 2 * static_cast<double>(survey_.tets) / points;
        const double tets = tets_of_a_point * static_cast<double>(sums.doubted());
        to_count_ = static_cast<std::uint64_t>(std::min(tets, static_cast<double>(survey_.tets)));
        report(0);
    }

    /// Whether some tet of a cell may be counted.
    bool has_counted_corner(std::size_t cell) const {
        if (doubted_.empty()) return true;
        const std::uint64_t first = cells_.first(cell), count = cells_.corners(cell);
        return cells_.connectivity().visit([&](const auto* corners) {
            return std::any_of(corners + first, corners + first + count,
                               [&](auto point) { return doubted_[static_cast<std::size_t>(point)] != 0; });
        });
    }

    bool is_counted(std::uint64_t point) const { return doubted_.empty() || doubted_[point]; }

    /// Counts the buckets [first, last).
    void count(std::size_t first, std::size_t last) {
        auto dealt = Dealt<AscendingTet<Point>>::deal(
            chunks_, last - first,
            [&](std::size_t chunk, auto& dealer) {
                deal(cells_.count() / chunks_ * chunk + std::min(chunk, cells_.count() % chunks_),
                     cells_.count() / chunks_ * (chunk + 1) + std::min(chunk + 1, cells_.count() % chunks_), first,
                     last, dealer);
            },
            progress_);
        report(first + 0.4 * static_cast<double>(last - first));
        tbb::enumerable_thread_specific<FaceCounter<Point>> counters;
        tbb::enumerable_thread_specific<FaceCounts> counts;
        std::atomic<std::size_t> done{0};
        parallel_each(last - first, 1, [&](std::size_t b) {
            if (progress_.cancelled()) return;
            FaceCounter<Point>& counter = counters.local();
            const auto is_here = [&](Point point) { return buckets_.of(point) == first + b && is_counted(point); };
            counter.add(dealt.bucket(b), is_here, progress_, counts.local());
            if (kept_ < most_kept_) keep_unbalanced(counter, faces_[first + b]);
            report(first + 0.4 * static_cast<double>(last - first) + 0.6 * static_cast<double>(++done));
        });
        for (const FaceCounts& part : counts) {
            total_.repeated += part.repeated;
            total_.unbalanced += part.unbalanced;
        }
    }

    /// Where all tets are mirrored alike, is_mirrored() says that none is.
    void keep_unbalanced(const FaceCounter<Point>& counter, std::vector<BoundaryFace>& out) {
        const bool other_way = survey_.all_alike() && survey_.mirrored > 0;
        counter.each_unbalanced([&](const std::array<Point, 3>& points, bool mirrored) {
            out.push_back({{points[0], points[1], points[2]}, mirrored != other_way});
        });
        std::sort(out.begin(), out.end(),
                  [](const BoundaryFace& a, const BoundaryFace& b) { return a.points < b.points; });
        kept_ += out.size();
    }

    void report(double buckets) const {
        if (!progress_.cancelled()) progress_("check", 0.75 + 0.25 * buckets / static_cast<double>(bucket_count_));
    }

    /// Deals the tets of the cells [begin, end) that belong into the buckets [first, last).
    template <class Dealer>
    void deal(std::size_t begin, std::size_t end, std::size_t first, std::size_t last, Dealer& dealer) const {
        if (cells_.only_tets()) return deal_tets(begin, end, first, last, dealer);
        for (std::size_t cell = begin; cell < end; ++cell)
            if (has_counted_corner(cell)) deal_tets(cell, cell + 1, first, last, dealer);
    }

    template <class Dealer>
    void deal_tets(std::size_t begin, std::size_t end, std::size_t first, std::size_t last, Dealer& dealer) const {
        for_tets(begin, end, [&](const Tet& tet, const auto& make) {
            const auto [lowest, second] = two_lowest(tet);
            const std::size_t a = buckets_.of(lowest), b = buckets_.of(second);
            const bool in_a = first <= a && a < last && is_counted(lowest);
            const bool in_b = first <= b && b < last && is_counted(second);
            if (in_a && in_b) dealer.put(a - first, b - first, make);
            else if (in_a) dealer.put(a - first, make);
            else if (in_b) dealer.put(b - first, make);
        });
    }

    /// Calls use(tet, make) for the tets of the cells [begin, end); make() gives the tet as it is counted.
    template <class Use>
    void for_tets(std::size_t begin, std::size_t end, const Use& use) const {
        cells_.for_cells(begin, end, [&](std::size_t cell, const CellTets& pieces) {
            std::optional<bool> cell_mirrored;
            if (is_ordered(cells_.type(cell))) cell_mirrored = false;
            const auto is_cell_mirrored = [&] {
                if (!cell_mirrored) cell_mirrored = Orienter::six_volumes(points_, pieces) < 0;
                return *cell_mirrored;
            };
            const bool whole = Orienter::is_whole(cells_.type(cell));
            for (const Tet& tet : pieces)
                use(tet, [&] {
                    const auto made = AscendingTet<Point>::make(tet, is_mirrored(tet, whole, is_cell_mirrored));
                    return is_ordered(cells_.type(cell)) ? made.of_ordered_cell() : made;
                });
        });
    }

    /// Whether a tet is mirrored as it is stored, and a piece as its cell is: a twisted cell has no faces inside. Where all
    /// are alike, the answer for all of them is as good.
    template <class IsCellMirrored>
    bool is_mirrored(const Tet& tet, bool whole, const IsCellMirrored& is_cell_mirrored) const {
        if (survey_.all_alike()) return false;
        if (!whole) return is_cell_mirrored();
        Orienter::Counts ignored;
        return ignored.add(points_.orientation(tet), whole, survey_.mostly_negative());
    }

    static std::pair<std::uint64_t, std::uint64_t> two_lowest(const Tet& t) {
        const std::uint64_t a = std::min(t[0], t[1]), b = std::max(t[0], t[1]);
        const std::uint64_t c = std::min(t[2], t[3]), d = std::max(t[2], t[3]);
        return {std::min(a, c), std::min(std::max(a, c), std::min(b, d))};
    }

    const Array& grid_points_;
    PointReader points_;
    const CellReader& cells_;
    const TetSurvey& survey_;
    const Progress& progress_;
    std::size_t chunks_;
    std::uint64_t to_count_ = survey_.tets; ///< tets, about
    Buffer<std::uint8_t> doubted_;          ///< by point: 1 where its faces are counted; empty: everywhere
    PointBuckets buckets_;
    std::size_t bucket_count_ = 1;
    FaceCounts total_;
    std::uint64_t most_kept_ = 0;
    std::atomic<std::uint64_t> kept_{0};
    std::vector<std::vector<BoundaryFace>> faces_; ///< by bucket
};

} // namespace

std::vector<StoredFace> faces_of(const std::vector<Tet>& tets) {
    std::vector<StoredFace> faces(4 * tets.size());
    parallel_each(tets.size(), 1 << 14, [&](std::size_t t) {
        for (std::size_t f = 0; f < 4; ++f) {
            const DirectedFace face = face_of(tets[t], f);
            faces[4 * t + f] = {face.points, face.mirrored ? 0u : 1u, face.mirrored ? 1u : 0u};
        }
    });
    tbb::parallel_sort(faces.begin(), faces.end(),
                       [](const StoredFace& a, const StoredFace& b) { return a.points < b.points; });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        if (kept && faces[kept - 1].points == faces[i].points) {
            faces[kept - 1].forward += faces[i].forward;
            faces[kept - 1].backward += faces[i].backward;
        } else {
            faces[kept++] = faces[i];
        }
    }
    faces.resize(kept);
    return faces;
}

namespace {

/// Calls use(surveyor) with the surveyor for the width of point numbers that the grid needs.
template <class Use>
auto with_surveyor(const Grid& grid, const CellReader& cells, const TetSurvey& survey, bool wide,
                   const Progress& progress, const Use& use) {
    using Narrow = std::uint32_t;
    using Wide = std::uint64_t;
    if (wide || cells.points() > AscendingTet<Narrow>::max_points)
        return use(FaceSurveyor<Wide>(grid, cells, survey, progress));
    return use(FaceSurveyor<Narrow>(grid, cells, survey, progress));
}

} // namespace

Result<FaceSurvey> survey_faces(const Grid& grid, const CellReader& cells, const TetSurvey& survey,
                                const FaceSurveyOptions& options, const Progress& progress) {
    return with_surveyor(grid, cells, survey, options.wide, progress,
                         [&](auto&& surveyor) {
                             surveyor.keep_faces(options.most_faces);
                             return surveyor.run(options.memory);
                         });
}

Result<std::vector<BoundaryFace>> find_boundary_faces(const Grid& grid, const CellReader& cells,
                                                      const TetSurvey& survey, const FaceSurveyOptions& options,
                                                      const Progress& progress) {
    FaceSurveyOptions keeping = options;
    keeping.most_faces = std::numeric_limits<std::uint64_t>::max();
    auto found = survey_faces(grid, cells, survey, keeping, progress);
    if (!found) return found.error();
    return std::move(found->faces);
}

Result<std::vector<BoundaryFace>> find_boundary_faces_at(Buffer<std::uint8_t> doubted, const Grid& grid,
                                                         const CellReader& cells, const TetSurvey& survey,
                                                         const FaceSurveyOptions& options, const Progress& progress) {
    auto found = with_surveyor(grid, cells, survey, options.wide, progress, [&](auto&& surveyor) {
        surveyor.keep_faces(std::numeric_limits<std::uint64_t>::max());
        surveyor.count_at(std::move(doubted));
        return surveyor.run(options.memory);
    });
    if (!found) return found.error();
    return std::move(found->faces);
}

} // namespace isotet::core
