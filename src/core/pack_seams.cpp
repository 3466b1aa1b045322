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
    std::uint16_t place;   ///< among the sender's candidates

    static Letter make(PointRef lower, PointRef higher, std::uint32_t cluster, std::uint16_t place) {
        return {std::uint64_t{lower.index()} << 40 | higher.value, cluster, place};
    }
    std::size_t lower_index() const { return edge >> 40; }
};
static_assert(sizeof(Letter) == 16);

/// What the sender is told: the owner and the edge's place among the owner's candidates; nobody when no other cluster
/// holds the edge.
struct Answer {
    std::uint32_t owner;
    std::uint16_t place;
};
constexpr std::uint32_t nobody = 0xffffffffu;

/// Sorts the letters to one cluster by edge, then sender. By the lower end first, of which there are few; what is left to
/// do for each of these is short.
void sort_letters(std::span<Letter> letters, std::vector<Letter>& scratch) {
    std::uint32_t next[max_cluster_points + 1] = {};
    for (const Letter& letter : letters) ++next[letter.lower_index() + 1];
    for (std::size_t k = 0; k < max_cluster_points; ++k) next[k + 1] += next[k];
    scratch.resize(std::max(scratch.size(), letters.size()));
    for (const Letter& letter : letters) scratch[next[letter.lower_index()]++] = letter;
    std::size_t begin = 0;
    for (std::size_t k = 0; k < max_cluster_points; ++k) { // next[k] is now where the letters of k end
        std::sort(scratch.begin() + begin, scratch.begin() + next[k], [](const Letter& a, const Letter& b) {
            return a.edge != b.edge ? a.edge < b.edge : a.cluster < b.cluster;
        });
        begin = next[k];
    }
    std::copy_n(scratch.begin(), letters.size(), letters.begin());
}

/// The neighbour table and the foreign seams of one cluster in the making.
class Neighbourhood {
public:
    /// Seams arrive in the order of the cluster's candidates and keep it among those of one owner.
    void add_seam(std::uint32_t owner, ForeignSeam seam) { seams_.push_back({owner, seam}); }
    /// Points arrive by ascending owner.
    void add_point(std::uint32_t owner) { ++entry(owner).foreign_points; }

    /// Puts seams and neighbours into order.
    void finish() {
        for (const Seam& seam : seams_) ++entry(seam.owner).foreign_seams;
        std::sort(table_.begin(), table_.end(), [](const Neighbour& a, const Neighbour& b) { return a.cluster < b.cluster; });
        sorted_.resize(seams_.size());
        std::size_t begin = 0;
        for (const Neighbour& neighbour : table_) {
            first_.push_back(begin);
            begin += neighbour.foreign_seams;
        }
        for (const Seam& seam : seams_) sorted_[first_[position(seam.owner)]++] = seam.seam;
    }
    void clear() {
        table_.clear();
        seams_.clear();
        first_.clear();
    }
    std::span<const Neighbour> table() const { return table_; }
    std::span<const ForeignSeam> seams() const { return sorted_; }

private:
    struct Seam {
        std::uint32_t owner;
        ForeignSeam seam;
    };

    /// Where the owner stands in the table, or its end. Tables are short, and the same owner comes several times in a row.
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
    std::vector<Seam> seams_;
    std::vector<ForeignSeam> sorted_;
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
        draft_links();
        std::uint64_t words = 0;
        for (ClusterHeader& header : packed_.headers) {
            header.first_link = words;
            words += ClusterLinks::words(header);
        }
        packed_.links = Buffer<std::uint32_t>(words);
        parallel_each(links_.size(), 1, [&](std::size_t task) {
            std::copy(links_[task].begin(), links_[task].end(), packed_.links.begin() + packed_.headers[task * clusters_a_task].first_link);
            links_[task] = {};
        });
        parallel_each(draft_.clusters(), clusters_a_task, [&](std::size_t c) { number_foreign_seams(c); });
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
                letters[slot] = Letter::make(lower, higher, static_cast<std::uint32_t>(c), place++);
            }
        });
        // Letters arrive in any order; sorting makes it one.
        answers_ = Buffer<Answer>(candidates_.size());
        parallel_ranges(n, clusters_a_task, [&](std::size_t from, std::size_t to) {
            std::vector<Letter> scratch;
            for (std::size_t c = from; c < to; ++c) {
                const std::span<Letter> mail(letters.data() + first[c], first[c + 1] - first[c]);
                sort_letters(mail, scratch);
                answer(mail);
            }
        });
    }

    /// Answers sorted letters: of those on one edge the first is the owner's.
    void answer(std::span<const Letter> letters) {
        for (std::size_t begin = 0; begin < letters.size();) {
            std::size_t end = begin + 1;
            while (end < letters.size() && letters[end].edge == letters[begin].edge) ++end;
            const Answer answer = end - begin > 1 ? Answer{letters[begin].cluster, letters[begin].place} : Answer{nobody, 0};
            for (; begin < end; ++begin) answers_[first_candidate_[letters[begin].cluster] + letters[begin].place] = answer;
        }
    }

    /// The links of each task's clusters, one after another. In foreign seams the owner's candidate stands instead of its
    /// own seam: which seam that becomes is known only when all owners have counted theirs.
    void draft_links() {
        const std::size_t n = draft_.clusters();
        links_.resize((n + clusters_a_task - 1) / clusters_a_task);
        parallel_each(links_.size(), 1, [&](std::size_t task) {
            Neighbourhood neighbourhood;
            std::vector<SeamEdge> own_seams;
            for (std::size_t c = task * clusters_a_task; c < std::min(n, (task + 1) * clusters_a_task); ++c)
                draft_links_of(c, neighbourhood, own_seams, links_[task]);
        });
        answers_.release();
    }

    /// Afterwards the cluster's candidates hold their numbers among its own seams.
    void draft_links_of(std::size_t c, Neighbourhood& neighbourhood, std::vector<SeamEdge>& own_seams,
                        std::vector<std::uint32_t>& words) {
        ClusterHeader& header = packed_.headers[c];
        neighbourhood.clear();
        for (std::size_t k = 0; k < header.foreign_points; ++k) neighbourhood.add_point(ref(c, k).owner());
        std::uint16_t own = 0;
        own_seams.clear();
        for (std::size_t k = first_candidate_[c]; k < first_candidate_[c + 1]; ++k) {
            const Answer answer = answers_[k];
            if (answer.owner == c) {
                own_seams.push_back(candidates_[k]);
                candidates_[k] = std::bit_cast<SeamEdge>(own++);
            } else if (answer.owner != nobody) {
                neighbourhood.add_seam(answer.owner, {candidates_[k], answer.place});
            }
        }
        neighbourhood.finish();
        header.neighbours = static_cast<std::uint16_t>(neighbourhood.table().size());
        header.own_seams = own;
        header.foreign_seams = static_cast<std::uint16_t>(neighbourhood.seams().size());

        const std::size_t begin = words.size();
        words.resize(begin + ClusterLinks::words(header));
        std::uint32_t* out = words.data() + begin;
        const auto put = [&out](const void* data, std::size_t bytes) {
            if (bytes) std::memcpy(out, data, bytes);
            out += words_for(bytes);
        };
        put(neighbourhood.table().data(), neighbourhood.table().size_bytes());
        std::uint8_t points[max_cluster_points];
        for (std::size_t k = 0; k < header.foreign_points; ++k) points[k] = ref(c, k).index();
        put(points, header.foreign_points);
        put(own_seams.data(), own_seams.size() * sizeof(SeamEdge));
        put(neighbourhood.seams().data(), neighbourhood.seams().size_bytes());
    }

    /// Turns the owners' candidates into the owners' own seams.
    void number_foreign_seams(std::size_t c) {
        const ClusterHeader& header = packed_.headers[c];
        const std::span<const Neighbour> neighbours = packed_.cluster_links(c).neighbours;
        std::uint32_t* word = packed_.links.data() + header.first_link + ClusterLinks::words(header) - header.foreign_seams;
        for (const Neighbour& neighbour : neighbours)
            for (std::size_t k = 0; k < neighbour.foreign_seams; ++k, ++word) {
                auto seam = std::bit_cast<ForeignSeam>(*word);
                seam.index = std::bit_cast<std::uint16_t>(candidates_[first_candidate_[neighbour.cluster] + seam.index]);
                *word = std::bit_cast<std::uint32_t>(seam);
            }
    }

    Draft& draft_;
    Packed& packed_;
    Buffer<std::uint8_t> shared_; ///< by packed point: held by more than one cluster
    Buffer<std::uint64_t> first_candidate_;
    Buffer<SeamEdge> candidates_; ///< at the end: of own seams, their numbers
    Buffer<Answer> answers_;
    std::vector<std::vector<std::uint32_t>> links_; ///< by task
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
