// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Seam edges: which edges are held by several clusters, and who owns them. Edges whose two ends both lie in other
// clusters too are the candidates. Every cluster sends its candidates to the owner of their lower end, where the same
// edge sent by several clusters stands side by side after sorting; the lowest-numbered sender is the owner, and all
// senders are told.
#include <algorithm>
#include <atomic>
#include <bit>

#include "base/workers.hpp"
#include "packed/build/pack_draft.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t words_per_row = max_cluster_points / 64;

/// A set of local points.
struct PointSet {
    std::uint64_t words[words_per_row] = {};

    constexpr void add(std::size_t point) { words[point / 64] |= std::uint64_t{1} << point % 64; }
    bool holds(std::size_t point) const { return words[point / 64] >> point % 64 & 1; }
    void add(const PointSet& other) {
        for (std::size_t w = 0; w < words_per_row; ++w) words[w] |= other.words[w];
    }
};

/// Which pairs of local points are edges of a cluster: the neighbours of each, and itself.
struct EdgeMatrix {
    PointSet rows[max_cluster_points];

    void add(const StoredTet& tet) {
        static constexpr auto alone = [] {
            std::array<PointSet, max_cluster_points> sets{};
            for (std::size_t k = 0; k < sets.size(); ++k) sets[k].add(k);
            return sets;
        }();
        const auto& v = tet.corners;
        PointSet corners = alone[v[0]];
        for (std::size_t k = 1; k < 4; ++k) corners.add(alone[v[k]]);
        for (const std::uint8_t corner : v) rows[corner].add(corners);
    }
    void add(const StoredCell& cell) {
        // Which end is lower does not matter: of rows the higher part counts.
        for (const auto& [k, l] : edges_of(cell.kind)) {
            rows[cell.corners[k]].add(cell.corners[l]);
            rows[cell.corners[l]].add(cell.corners[k]);
        }
    }
};

/// One candidate edge of one cluster, on its way to the owner of its lower end.
struct SeamRequest {
    std::uint64_t edge;    ///< lower end's index, higher end's PointRef
    std::uint32_t cluster; ///< the sender
    std::uint16_t place;   ///< among the sender's candidates

    static SeamRequest make(PointRef lower, PointRef higher, std::uint32_t cluster, std::uint16_t place) {
        return {std::uint64_t{lower.index()} << 40 | higher.value, cluster, place};
    }
    std::size_t lower_index() const { return edge >> 40; }
};
static_assert(sizeof(SeamRequest) == 16);

/// What the sender is told: the owner and the edge's place among the owner's candidates; no_owner when no other cluster
/// holds the edge.
struct Answer {
    std::uint32_t owner;
    std::uint16_t place;
};
/// Answers to all candidates: six bytes each, where structs would take eight.
class Answers {
public:
    Answers() = default;
    explicit Answers(std::size_t size) : owners_(size), places_(size) {}

    Answer operator[](std::size_t i) const { return {owners_[i], places_[i]}; }
    void set(std::size_t i, Answer answer) {
        owners_[i] = answer.owner;
        places_[i] = answer.place;
    }

private:
    Buffer<std::uint32_t> owners_;
    Buffer<std::uint16_t> places_;
};
constexpr std::uint32_t no_owner = 0xffffffffu;

/// Sorts the requests to one cluster by edge, then sender. By the lower end first, of which there are few; what is left
/// to do for each of these is short.
void sort_requests(std::span<SeamRequest> requests, std::vector<SeamRequest>& scratch) {
    std::uint32_t next[max_cluster_points + 1] = {};
    for (const SeamRequest& request : requests) ++next[request.lower_index() + 1];
    for (std::size_t k = 0; k < max_cluster_points; ++k) next[k + 1] += next[k];
    scratch.resize(std::max(scratch.size(), requests.size()));
    for (const SeamRequest& request : requests) scratch[next[request.lower_index()]++] = request;
    std::size_t begin = 0;
    for (std::size_t k = 0; k < max_cluster_points; ++k) { // next[k] is now where the requests of k end
        std::sort(scratch.begin() + begin, scratch.begin() + next[k], [](const SeamRequest& a, const SeamRequest& b) {
            return a.edge != b.edge ? a.edge < b.edge : a.cluster < b.cluster;
        });
        begin = next[k];
    }
    std::copy_n(scratch.begin(), requests.size(), requests.begin());
}

/// The neighbour table and the ghost seams of one cluster in the making.
class Neighbourhood {
public:
    /// Seams arrive in the order of the cluster's candidates and keep it among those of one owner.
    void add_seam(std::uint32_t owner, SeamEdge seam, std::uint16_t index) {
        ++entry(owner).ghost_seams;
        arrived_.push_back({owner, seam, index});
    }
    /// Points arrive by ascending owner.
    void add_point(std::uint32_t owner) { ++entry(owner).ghost_points; }

    /// Puts seams and neighbours into order.
    void finish() {
        std::sort(table_.begin(), table_.end(),
                  [](const Neighbour& a, const Neighbour& b) { return a.cluster < b.cluster; });
        seams_.resize(arrived_.size());
        indices_.resize(arrived_.size());
        std::size_t begin = 0;
        for (const Neighbour& neighbour : table_) {
            first_.push_back(begin);
            begin += neighbour.ghost_seams;
        }
        for (const Seam& seam : arrived_) {
            const std::size_t at = first_[position(seam.owner)]++;
            seams_[at] = seam.edge;
            indices_[at] = seam.index;
        }
    }
    void clear() {
        table_.clear();
        arrived_.clear();
        first_.clear();
    }
    std::span<const Neighbour> table() const { return table_; }
    /// Once finished: the ghost seams by owner, and their indices among its own seams.
    std::span<const SeamEdge> seams() const { return seams_; }
    std::span<const std::uint16_t> indices() const { return indices_; }

private:
    struct Seam {
        std::uint32_t owner;
        SeamEdge edge;
        std::uint16_t index;
    };

    /// Where the owner stands in the table, or its end. Tables are short, and the same owner comes several times in a
    /// row.
    std::size_t position(std::uint32_t owner) {
        if (last_ < table_.size() && table_[last_].cluster == owner) return last_;
        last_ = 0;
        while (last_ < table_.size() && table_[last_].cluster != owner) ++last_;
        return last_;
    }
    Neighbour& entry(std::uint32_t owner) {
        if (position(owner) == table_.size()) table_.push_back({owner, 0, 0});
        return table_[last_];
    }

    std::vector<Neighbour> table_;
    std::vector<Seam> arrived_;
    std::vector<SeamEdge> seams_;
    std::vector<std::uint16_t> indices_;
    std::vector<std::size_t> first_;
    std::size_t last_ = 0;
};

class SeamFinder {
public:
    explicit SeamFinder(Draft& draft) : draft_(draft), packed_(draft.packed) {}

    void find() {
        mark_shared_points();
        list_candidates();
        exchange();
    }
    void write_links() {
        number_own_seams();
        const std::size_t n = draft_.clusters(), tasks = (n + clusters_per_task - 1) / clusters_per_task;
        std::vector<std::vector<std::uint32_t>> lists(tasks);
        worker_ranges(tasks, 1, [&](std::size_t from, std::size_t to) {
            Neighbourhood neighbourhood;
            std::vector<std::uint32_t> list;
            for (std::size_t task = from; task < to; ++task) {
                list.clear();
                for (std::size_t c = task * clusters_per_task; c < std::min(n, (task + 1) * clusters_per_task); ++c)
                    add_links(c, neighbourhood, list);
                lists[task].assign(list.begin(), list.end()); // no longer than it need be
            }
        });
        std::uint64_t words = 0;
        for (ClusterHeader& header : packed_.headers) {
            header.first_link = words;
            words += ClusterLinks::words(header);
        }
        packed_.links = SharedBuffer<std::uint32_t>(words + slack_words);
        std::fill(packed_.links.begin() + words, packed_.links.end(), 0);
        worker_each(tasks, 1, [&](std::size_t task) {
            std::copy(lists[task].begin(), lists[task].end(),
                      packed_.links.begin() + packed_.headers[task * clusters_per_task].first_link);
            lists[task] = {};
        });
    }

private:
    PointRef ref(std::size_t c, std::size_t local) const { return {draft_.locals[draft_.first_local[c] + local]}; }

    void mark_shared_points() {
        const std::size_t points = packed_.points();
        shared_ = Buffer<std::uint8_t>(points);
        worker_ranges(points, 1 << 16, [&](std::size_t begin, std::size_t end) {
            std::fill(shared_.begin() + begin, shared_.begin() + end, 0);
        });
        worker_each(draft_.clusters(), clusters_per_task, [&](std::size_t c) {
            for (std::size_t k = 0; k < packed_.headers[c].ghost_points; ++k) {
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
        PointSet shared;
        for (std::size_t k = 0; k < draft_.local_count(c); ++k)
            if (k < h.ghost_points || shared_[h.first_point + k - h.ghost_points]) shared.add(k);
        EdgeMatrix matrix;
        for (const StoredTet& tet : packed_.cluster_tets(c)) matrix.add(tet);
        packed_.for_other_cells(c, [&](const StoredCell& cell) { matrix.add(cell); });
        for (std::size_t a = 0; a < draft_.local_count(c); ++a) {
            if (!shared.holds(a)) continue;
            for (std::size_t word = a / 64; word < words_per_row; ++word) {
                std::uint64_t bits = matrix.rows[a].words[word] & shared.words[word];
                if (word == a / 64) bits &= ~std::uint64_t{1} << a % 64; // the higher ones
                for (; bits; bits &= bits - 1)
                    f(static_cast<std::uint8_t>(a),
                      static_cast<std::uint8_t>(64 * word + static_cast<std::size_t>(std::countr_zero(bits))));
            }
        }
    }

    void list_candidates() {
        const std::size_t n = draft_.clusters();
        first_candidate_ = Buffer<std::uint64_t>(n + 1);
        const std::size_t tasks = (n + clusters_per_task - 1) / clusters_per_task;
        std::vector<std::vector<SeamEdge>> lists(tasks);
        worker_ranges(tasks, 1, [&](std::size_t from, std::size_t to) {
            std::vector<SeamEdge> list;
            for (std::size_t task = from; task < to; ++task) {
                list.clear();
                for (std::size_t c = task * clusters_per_task; c < std::min(n, (task + 1) * clusters_per_task); ++c) {
                    const std::size_t before = list.size();
                    for_candidates(c, [&](std::uint8_t a, std::uint8_t b) { list.push_back({a, b}); });
                    first_candidate_[c + 1] = list.size() - before;
                }
                lists[task].assign(list.begin(), list.end()); // no longer than it need be
            }
        });
        first_candidate_[0] = 0;
        for (std::size_t c = 0; c < n; ++c) first_candidate_[c + 1] += first_candidate_[c];
        candidates_ = Buffer<SeamEdge>(first_candidate_[n]);
        worker_each(tasks, 1, [&](std::size_t task) {
            std::copy(lists[task].begin(), lists[task].end(),
                      candidates_.begin() + first_candidate_[task * clusters_per_task]);
            lists[task] = {};
        });
    }

    std::span<const SeamEdge> candidates(std::size_t c) const {
        return {candidates_.data() + first_candidate_[c], first_candidate_[c + 1] - first_candidate_[c]};
    }

    /// Calls f(owner, begin, end) for each run of a cluster's candidates whose lower ends have one owner of [first,
    /// last): all that this owner has here, since local points stand by owner.
    template <class F>
    void for_runs(std::size_t c, std::size_t first, std::size_t last, const F& f) const {
        if (c < first || ref(c, 0).owner() >= last) return; // no cluster has points of a later one
        const std::span<const SeamEdge> all = candidates(c);
        const auto owner_of = [&](const SeamEdge edge) { return ref(c, edge.lower).owner(); };
        auto begin =
            std::partition_point(all.begin(), all.end(), [&](const SeamEdge edge) { return owner_of(edge) < first; });
        while (begin != all.end()) {
            const std::uint32_t owner = owner_of(*begin);
            if (owner >= last) return;
            auto end = begin + 1;
            while (end != all.end() && (end->lower == end[-1].lower || owner_of(*end) == owner)) ++end;
            f(owner, static_cast<std::size_t>(begin - all.begin()), static_cast<std::size_t>(end - all.begin()));
            begin = end;
        }
    }

    void exchange() {
        const std::size_t n = draft_.clusters();
        std::vector<std::uint64_t> next(n + 1, 0); // requests to each cluster; then where its next request goes
        worker_each(n, clusters_per_task, [&](std::size_t c) {
            for_runs(c, 0, n, [&](std::uint32_t owner, std::size_t begin, std::size_t end) {
                std::atomic_ref<std::uint64_t>(next[owner + 1]).fetch_add(end - begin, std::memory_order_relaxed);
            });
        });
        for (std::size_t c = 0; c < n; ++c) next[c + 1] += next[c];
        const std::vector<std::uint64_t> first = next;
        // In rounds, since all requests together would take more memory than anything else in packing.
        const std::size_t rounds = std::clamp<std::size_t>(n / 1024, 1, 8);
        const auto begin_of = [&](std::size_t round) { return n / rounds * round + std::min(round, n % rounds); };
        std::uint64_t most = 0;
        for (std::size_t round = 0; round < rounds; ++round)
            most = std::max(most, first[begin_of(round + 1)] - first[begin_of(round)]);
        Buffer<SeamRequest> requests(most);
        answers_ = Answers(candidates_.size());
        for (std::size_t round = 0; round < rounds; ++round)
            deliver(begin_of(round), begin_of(round + 1), first, next, requests);
    }

    /// Sends the requests to the clusters [from, to), and answers them. `next` is where each cluster's next request goes,
    /// at first as `first`; requests lie in the buffer from first[from] on.
    void deliver(std::size_t from, std::size_t to, const std::vector<std::uint64_t>& first,
                 std::vector<std::uint64_t>& next, Buffer<SeamRequest>& requests) {
        SeamRequest* const to_first = requests.data();
        worker_each(draft_.clusters() - from, clusters_per_task, [&](std::size_t behind) {
            const std::size_t c = from + behind;
            const SeamEdge* const all = candidates(c).data();
            for_runs(c, from, to, [&](std::uint32_t owner, std::size_t begin, std::size_t end) {
                const std::uint64_t slot =
                    std::atomic_ref<std::uint64_t>(next[owner]).fetch_add(end - begin, std::memory_order_relaxed);
                SeamRequest* out = to_first + (slot - first[from]);
                for (std::size_t place = begin; place < end; ++place)
                    *out++ = SeamRequest::make(ref(c, all[place].lower), ref(c, all[place].higher),
                                               static_cast<std::uint32_t>(c), static_cast<std::uint16_t>(place));
            });
        });
        // Requests arrive in any order; sorting makes it one.
        worker_ranges(to - from, clusters_per_task, [&](std::size_t begin, std::size_t end) {
            std::vector<SeamRequest> scratch;
            for (std::size_t c = from + begin; c < from + end; ++c) {
                const std::span<SeamRequest> received(to_first + (first[c] - first[from]), first[c + 1] - first[c]);
                sort_requests(received, scratch);
                answer(received);
            }
        });
    }

    /// Answers sorted requests: of those on one edge the first is the owner's.
    void answer(std::span<const SeamRequest> requests) {
        for (std::size_t begin = 0; begin < requests.size();) {
            std::size_t end = begin + 1;
            while (end < requests.size() && requests[end].edge == requests[begin].edge) ++end;
            const Answer answer =
                end - begin > 1 ? Answer{requests[begin].cluster, requests[begin].place} : Answer{no_owner, 0};
            for (; begin < end; ++begin)
                answers_.set(first_candidate_[requests[begin].cluster] + requests[begin].place, answer);
        }
    }

    /// Afterwards the answers to the clusters' own seams hold their numbers among these.
    void number_own_seams() {
        worker_each(draft_.clusters(), clusters_per_task, [&](std::size_t c) {
            const auto self = static_cast<std::uint32_t>(c);
            std::uint16_t own = 0;
            for (std::size_t k = first_candidate_[c]; k < first_candidate_[c + 1]; ++k)
                if (answers_[k].owner == self) answers_.set(k, {self, own++});
            packed_.headers[c].own_seams = own;
        });
    }

    /// Adds the links of one cluster to the list, and their numbers to its header.
    void add_links(std::size_t c, Neighbourhood& neighbourhood, std::vector<std::uint32_t>& list) {
        ClusterHeader& header = packed_.headers[c];
        neighbourhood.clear();
        for (std::size_t k = 0; k < header.ghost_points; ++k) neighbourhood.add_point(ref(c, k).owner());
        std::vector<SeamEdge> own_seams;
        own_seams.reserve(header.own_seams);
        for (std::size_t k = first_candidate_[c]; k < first_candidate_[c + 1]; ++k) {
            const Answer answer = answers_[k];
            if (answer.owner == c) own_seams.push_back(candidates_[k]);
            else if (answer.owner != no_owner)
                neighbourhood.add_seam(answer.owner, candidates_[k],
                                       answers_[first_candidate_[answer.owner] + answer.place].place);
        }
        neighbourhood.finish();
        header.neighbours = static_cast<std::uint16_t>(neighbourhood.table().size());
        header.ghost_seams = static_cast<std::uint16_t>(neighbourhood.seams().size());
        header.wide_seams = std::ranges::any_of(neighbourhood.table(), [&](const Neighbour& neighbour) {
            return neighbour.ghost_seams && packed_.headers[neighbour.cluster].own_seams > 256;
        });
        std::uint8_t points[max_cluster_points];
        for (std::size_t k = 0; k < header.ghost_points; ++k) points[k] = ref(c, k).index();

        const std::size_t before = list.size();
        list.resize(before + ClusterLinks::words(header));
        auto* out = reinterpret_cast<std::uint8_t*>(list.data() + before); // what fills up the last word stays 0
        const auto put = [&out](const auto& parts) {
            const std::size_t bytes = parts.size() * sizeof parts[0];
            if (bytes) std::memcpy(out, parts.data(), bytes);
            out += bytes;
        };
        put(neighbourhood.table());
        put(own_seams);
        put(neighbourhood.seams());
        put(std::span(points, header.ghost_points));
        if (header.wide_seams) put(neighbourhood.indices());
        else
            out = std::ranges::transform(neighbourhood.indices(), out, [](std::uint16_t index) {
                      return static_cast<std::uint8_t>(index);
                  }).out;
    }

    Draft& draft_;
    Packed& packed_;
    Buffer<std::uint8_t> shared_; ///< by packed point: held by more than one cluster
    Buffer<std::uint64_t> first_candidate_;
    Buffer<SeamEdge> candidates_;
    Answers answers_;
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
