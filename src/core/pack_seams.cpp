// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Seam edges: which edges are held by several clusters, and who owns them. Edges whose two ends both lie in other clusters
// too are the candidates. Every cluster sends its candidates to the owner of their lower end, where the same edge sent by
// several clusters stands side by side after sorting; the lowest-numbered sender is the owner, and all senders are told.
#include <algorithm>
#include <atomic>
#include <bit>

#include "core/pack_draft.hpp"
#include "core/parallel.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t clusters_a_task = 64;
constexpr std::size_t words_a_row = max_cluster_points / 64;

/// Which pairs of local points are edges of a cluster: bit b of row a, a < b.
struct EdgeMatrix {
    std::uint64_t rows[max_cluster_points][words_a_row] = {};

    void add(std::uint8_t a, std::uint8_t b) {
        if (a > b) std::swap(a, b);
        rows[a][b / 64] |= std::uint64_t{1} << b % 64;
    }
};

/// One candidate edge of one cluster, on its way to the owner of its lower end.
struct Letter {
    std::uint64_t edge;    ///< lower end's index, higher end's PointRef
    std::uint32_t cluster; ///< the sender
    SeamEdge local;        ///< the edge in the sender
    std::uint16_t place;   ///< among the sender's candidates
};
static_assert(sizeof(Letter) == 16);

/// What the sender is told: the owner and the edge in the owner; nobody when no other cluster holds the edge.
struct Answer {
    std::uint32_t owner;
    SeamEdge local;
};
constexpr std::uint32_t nobody = 0xffffffffu;

class SeamFinder {
public:
    explicit SeamFinder(Draft& draft) : draft_(draft), packed_(draft.packed) {}

    void find() {
        mark_shared_points();
        list_candidates();
        exchange();
    }
    void write_links() {
        measure();
        parallel_each(draft_.clusters(), clusters_a_task, [&](std::size_t c) { write_own(c); });
        parallel_each(draft_.clusters(), clusters_a_task, [&](std::size_t c) { write_foreign_seams(c); });
    }

private:
    PointRef ref(std::size_t c, std::size_t local) const { return {draft_.locals[draft_.first_local[c] + local]}; }

    void mark_shared_points() {
        const std::size_t points = packed_.points();
        shared_ = Buffer<std::uint8_t>(points);
        parallel_ranges(points, 1 << 16,
                        [&](std::size_t begin, std::size_t end) { std::fill(shared_.begin() + begin, shared_.begin() + end, 0); });
        parallel_each(draft_.clusters(), clusters_a_task, [&](std::size_t c) {
            for (std::size_t k = 0; k < packed_.headers[c].foreign_points; ++k) {
                const PointRef point = ref(c, k);
                std::atomic_ref<std::uint8_t>(shared_[packed_.headers[point.owner()].first_point + point.index()])
                    .store(1, std::memory_order_relaxed);
            }
        });
    }

    /// Calls f(lower, higher) for every candidate of a cluster, ascending.
    template <class F>
    void for_candidates(std::size_t c, F&& f) const {
        const ClusterHeader& h = packed_.headers[c];
        std::uint64_t shared[words_a_row] = {};
        for (std::size_t k = 0; k < draft_.local_count(c); ++k)
            if (k < h.foreign_points || shared_[h.first_point + k - h.foreign_points]) shared[k / 64] |= std::uint64_t{1} << k % 64;
        EdgeMatrix matrix;
        for (const StoredTet& tet : packed_.cluster_tets(c)) {
            const auto& v = tet.corners;
            matrix.add(v[0], v[1]);
            matrix.add(v[0], v[2]);
            matrix.add(v[0], v[3]);
            matrix.add(v[1], v[2]);
            matrix.add(v[1], v[3]);
            matrix.add(v[2], v[3]);
        }
        for (std::size_t a = 0; a < draft_.local_count(c); ++a) {
            if (!(shared[a / 64] >> a % 64 & 1)) continue;
            for (std::size_t word = a / 64; word < words_a_row; ++word)
                for (std::uint64_t bits = matrix.rows[a][word] & shared[word]; bits; bits &= bits - 1)
                    f(static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(64 * word + static_cast<std::size_t>(std::countr_zero(bits))));
        }
    }

    void list_candidates() {
        const std::size_t n = draft_.clusters();
        first_candidate_ = Buffer<std::uint64_t>(n + 1);
        const std::size_t tasks = (n + clusters_a_task - 1) / clusters_a_task;
        std::vector<std::vector<SeamEdge>> lists(tasks);
        parallel_each(tasks, 1, [&](std::size_t task) {
            for (std::size_t c = task * clusters_a_task; c < std::min(n, (task + 1) * clusters_a_task); ++c) {
                const std::size_t before = lists[task].size();
                for_candidates(c, [&](std::uint8_t a, std::uint8_t b) { lists[task].push_back({a, b}); });
                first_candidate_[c + 1] = lists[task].size() - before;
            }
        });
        first_candidate_[0] = 0;
        for (std::size_t c = 0; c < n; ++c) first_candidate_[c + 1] += first_candidate_[c];
        candidates_ = Buffer<SeamEdge>(first_candidate_[n]);
        parallel_each(tasks, 1, [&](std::size_t task) {
            std::copy(lists[task].begin(), lists[task].end(), candidates_.begin() + first_candidate_[task * clusters_a_task]);
            lists[task] = {};
        });
    }

    std::span<const SeamEdge> candidates(std::size_t c) const {
        return {candidates_.data() + first_candidate_[c], first_candidate_[c + 1] - first_candidate_[c]};
    }

    void exchange() {
        const std::size_t n = draft_.clusters();
        std::vector<std::uint64_t> next(n + 1, 0); // letters to each cluster; then where its next letter goes
        parallel_each(n, clusters_a_task, [&](std::size_t c) {
            for (const SeamEdge edge : candidates(c))
                std::atomic_ref<std::uint64_t>(next[ref(c, edge.lower).owner() + 1]).fetch_add(1, std::memory_order_relaxed);
        });
        for (std::size_t c = 0; c < n; ++c) next[c + 1] += next[c];
        const std::vector<std::uint64_t> first = next;
        Buffer<Letter> letters(candidates_.size());
        parallel_each(n, clusters_a_task, [&](std::size_t c) {
            std::uint16_t place = 0;
            for (const SeamEdge edge : candidates(c)) {
                const PointRef lower = ref(c, edge.lower), higher = ref(c, edge.higher);
                const std::uint64_t slot =
                    std::atomic_ref<std::uint64_t>(next[lower.owner()]).fetch_add(1, std::memory_order_relaxed);
                letters[slot] = {std::uint64_t{lower.index()} << 40 | higher.value, static_cast<std::uint32_t>(c), edge, place++};
            }
        });
        // Letters arrive in any order; sorting makes it one.
        answers_ = Buffer<Answer>(candidates_.size());
        parallel_each(n, clusters_a_task, [&](std::size_t c) {
            Letter* const begin = letters.data() + first[c];
            Letter* const end = letters.data() + first[c + 1];
            std::sort(begin, end, [](const Letter& a, const Letter& b) {
                return a.edge != b.edge ? a.edge < b.edge : a.cluster < b.cluster;
            });
            for (Letter* run = begin; run != end;) {
                Letter* const after = std::find_if(run, end, [&](const Letter& l) { return l.edge != run->edge; });
                const Answer answer = after - run > 1 ? Answer{run->cluster, run->local} : Answer{nobody, {}};
                for (const Letter* letter = run; letter != after; ++letter)
                    answers_[first_candidate_[letter->cluster] + letter->place] = answer;
                run = after;
            }
        });
    }

    /// A foreign seam of a cluster: its owner, the edge there and here.
    struct Foreign {
        std::uint32_t owner;
        SeamEdge there, here;
    };

    /// Calls own(edge) for own seams in stored order and foreign(Foreign) for the others.
    template <class Own, class Other>
    void for_seams(std::size_t c, Own&& own, Other&& foreign) const {
        const auto edges = candidates(c);
        for (std::size_t k = 0; k < edges.size(); ++k) {
            const Answer& answer = answers_[first_candidate_[c] + k];
            if (answer.owner == c) own(edges[k]);
            else if (answer.owner != nobody) foreign(Foreign{answer.owner, answer.local, edges[k]});
        }
    }

    /// The neighbour table and the foreign seams, both by neighbour.
    void collect(std::size_t c, std::vector<Neighbour>& neighbours, std::vector<Foreign>& foreign) const {
        neighbours.clear();
        foreign.clear();
        for_seams(c, [](SeamEdge) {}, [&](const Foreign& seam) { foreign.push_back(seam); });
        std::stable_sort(foreign.begin(), foreign.end(), [](const Foreign& a, const Foreign& b) { return a.owner < b.owner; });
        std::size_t point = 0, seam = 0;
        const std::size_t points = packed_.headers[c].foreign_points;
        while (point < points || seam < foreign.size()) {
            const std::uint32_t next_point = point < points ? ref(c, point).owner() : nobody;
            const std::uint32_t next_seam = seam < foreign.size() ? foreign[seam].owner : nobody;
            Neighbour neighbour{std::min(next_point, next_seam), 0, 0};
            for (; point < points && ref(c, point).owner() == neighbour.cluster; ++point) ++neighbour.foreign_points;
            for (; seam < foreign.size() && foreign[seam].owner == neighbour.cluster; ++seam) ++neighbour.foreign_seams;
            neighbours.push_back(neighbour);
        }
    }

    void measure() {
        parallel_ranges(draft_.clusters(), clusters_a_task, [&](std::size_t begin, std::size_t end) {
            std::vector<Neighbour> neighbours;
            std::vector<Foreign> foreign;
            for (std::size_t c = begin; c < end; ++c) {
                collect(c, neighbours, foreign);
                std::uint16_t own = 0;
                for_seams(c, [&](SeamEdge) { ++own; }, [](const Foreign&) {});
                ClusterHeader& header = packed_.headers[c];
                header.neighbours = static_cast<std::uint16_t>(neighbours.size());
                header.own_seams = own;
                header.foreign_seams = static_cast<std::uint16_t>(foreign.size());
            }
        });
        std::uint64_t words = 0;
        for (ClusterHeader& header : packed_.headers) {
            header.first_link = words;
            words += ClusterLinks::words(header);
        }
        packed_.links = Buffer<std::uint32_t>(words);
    }

    void write_own(std::size_t c) {
        const ClusterHeader& header = packed_.headers[c];
        std::vector<Neighbour> neighbours;
        std::vector<Foreign> foreign;
        collect(c, neighbours, foreign);
        std::uint32_t* words = packed_.links.data() + header.first_link;
        for (const Neighbour& neighbour : neighbours) {
            std::memcpy(words, &neighbour, sizeof neighbour);
            words += 2;
        }

        std::uint8_t points[max_cluster_points + 3] = {};
        for (std::size_t k = 0; k < header.foreign_points; ++k) points[k] = ref(c, k).index();
        std::memcpy(words, points, 4 * words_for(header.foreign_points));
        words += words_for(header.foreign_points);

        std::vector<SeamEdge> own;
        own.reserve(header.own_seams + 1u);
        for_seams(c, [&](SeamEdge edge) { own.push_back(edge); }, [](const Foreign&) {});
        if (own.size() % 2) own.push_back({});
        std::memcpy(words, own.data(), own.size() * sizeof(SeamEdge)); // never null: room for one was reserved
    }

    /// After every cluster's own seams are there: their places in their owners.
    void write_foreign_seams(std::size_t c) {
        const ClusterHeader& header = packed_.headers[c];
        std::vector<Neighbour> neighbours;
        std::vector<Foreign> foreign;
        collect(c, neighbours, foreign);
        std::uint32_t* words = packed_.links.data() + header.first_link + ClusterLinks::words(header) - header.foreign_seams;
        for (std::size_t k = 0; k < foreign.size(); ++k) {
            const auto own = packed_.cluster_links(foreign[k].owner).own_seams;
            const auto at = std::lower_bound(own.begin(), own.end(), foreign[k].there) - own.begin();
            const ForeignSeam seam{foreign[k].here, static_cast<std::uint16_t>(at)};
            std::memcpy(words + k, &seam, sizeof seam);
        }
    }

    Draft& draft_;
    Packed& packed_;
    Buffer<std::uint8_t> shared_; ///< by packed point: held by more than one cluster
    Buffer<std::uint64_t> first_candidate_;
    Buffer<SeamEdge> candidates_;
    Buffer<Answer> answers_;
};

} // namespace

Result<void> link_clusters(Draft& draft, const Progress& progress) {
    SeamFinder finder(draft);
    finder.find();
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "packing was cancelled"};
    progress("pack", 0.85);
    finder.write_links();
    progress("pack", 0.9);
    return {};
}

} // namespace isotet::core
