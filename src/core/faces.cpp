// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/faces.hpp"

#include <algorithm>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include "core/buffer.hpp"
#include "core/parallel.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t cells_a_chunk = 1 << 13;

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

/// A face in 24 bytes: the direction is the lowest bit of the last point.
struct FaceUse {
    std::array<std::uint64_t, 3> key;
    friend bool operator<(const FaceUse& a, const FaceUse& b) { return a.key < b.key; }
};

bool same_face(const FaceUse& a, const FaceUse& b) {
    return a.key[0] == b.key[0] && a.key[1] == b.key[1] && a.key[2] >> 1 == b.key[2] >> 1;
}

struct NumberedTet {
    Tet corners; ///< ascending
    TetId id;
    friend bool operator<(const NumberedTet& a, const NumberedTet& b) {
        return a.corners != b.corners ? a.corners < b.corners : a.id.value < b.id.value;
    }
};

bool in_hand(std::uint64_t point, std::uint64_t hand, std::uint64_t hands) {
    return hands == 1 || (point * 0x9e3779b97f4a7c15u >> 32) % hands == hand;
}

std::uint64_t hands_for(std::uint64_t bytes, std::uint64_t memory) {
    return 1 + bytes / std::max<std::uint64_t>(memory, 1);
}

/// Collects what visit(cell, emit) emits for all cells, each chunk of cells to its own place: counted first, so that no
/// list grows.
template <class Item, class Visit>
Buffer<Item> collect(std::size_t cells, const Visit& visit) {
    const std::size_t chunks = (cells + cells_a_chunk - 1) / cells_a_chunk;
    std::vector<std::uint64_t> first(chunks + 1, 0);
    const auto for_chunk = [&](std::size_t chunk, const auto& emit) {
        for (std::size_t cell = chunk * cells_a_chunk; cell < std::min(cells, (chunk + 1) * cells_a_chunk); ++cell)
            visit(cell, emit);
    };
    parallel_each(chunks, 1, [&](std::size_t chunk) {
        std::uint64_t count = 0;
        for_chunk(chunk, [&](const Item&) { ++count; });
        first[chunk + 1] = count;
    });
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) first[chunk + 1] += first[chunk];
    Buffer<Item> items(first[chunks]);
    parallel_each(chunks, 1, [&](std::size_t chunk) {
        Item* out = items.data() + first[chunk];
        for_chunk(chunk, [&](const Item& item) { *out++ = item; });
    });
    return items;
}

/// Calls run(first, last) for every run of equal items, in parallel, and adds up what it returns.
template <class Item, class Same, class Run>
std::uint64_t sum_over_runs(const Buffer<Item>& items, const Same& same, const Run& run) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, items.size(), 1 << 14), std::uint64_t{0},
        [&](const tbb::blocked_range<std::size_t>& range, std::uint64_t sum) {
            std::size_t begin = range.begin();
            while (begin > 0 && begin < range.end() && same(items[begin - 1], items[begin])) ++begin; // not ours
            while (begin < range.end()) {
                std::size_t end = begin + 1;
                while (end < items.size() && same(items[begin], items[end])) ++end;
                sum += run(items.data() + begin, items.data() + end);
                begin = end;
            }
            return sum;
        },
        [](std::uint64_t a, std::uint64_t b) { return a + b; });
}

/// Repeated tets, all but the first of each, ascending.
Result<std::vector<std::uint64_t>> find_repeated(const CellReader& cells, std::uint64_t tets, std::uint64_t memory,
                                                 const Progress& progress) {
    std::vector<std::uint64_t> repeated;
    const std::uint64_t hands = hands_for(tets * sizeof(NumberedTet), memory);
    for (std::uint64_t hand = 0; hand < hands; ++hand) {
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "checking the grid was cancelled"};
        progress("check", 0.4 + 0.2 * static_cast<double>(hand) / static_cast<double>(hands));
        Buffer<NumberedTet> all = collect<NumberedTet>(cells.count(), [&](std::size_t cell, const auto& emit) {
            const CellTets pieces = cells.tets(cell);
            for (int piece = 0; piece < pieces.count; ++piece) {
                Tet corners = pieces.tets[static_cast<std::size_t>(piece)];
                std::sort(corners.begin(), corners.end());
                if (in_hand(corners[0], hand, hands))
                    emit(NumberedTet{corners, TetId::make(cell, static_cast<unsigned>(piece))});
            }
        });
        tbb::parallel_sort(all.begin(), all.end());
        tbb::enumerable_thread_specific<std::vector<std::uint64_t>> found;
        sum_over_runs(
            all, [](const NumberedTet& a, const NumberedTet& b) { return a.corners == b.corners; },
            [&](const NumberedTet* first, const NumberedTet* last) {
                for (const NumberedTet* tet = first + 1; tet < last; ++tet) found.local().push_back(tet->id.value);
                return std::uint64_t{0};
            });
        for (const auto& part : found) repeated.insert(repeated.end(), part.begin(), part.end());
    }
    std::sort(repeated.begin(), repeated.end());
    return repeated;
}

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

Result<FaceSurvey> survey_faces(const Grid& grid, const CellReader& cells, const TetSurvey& survey,
                                std::uint64_t memory, const Progress& progress) {
    const auto repeated = find_repeated(cells, survey.tets, memory, progress);
    if (!repeated) return repeated.error();
    FaceSurvey out;
    out.repeated = repeated->size();
    const Orienter orienter(grid.points, survey.mostly_negative);
    const auto for_stored_tets = [&](std::size_t cell, Orienter::Counts& counts, const auto& visit) {
        const CellTets pieces = cells.tets(cell);
        for (unsigned piece = 0; piece < static_cast<unsigned>(pieces.count); ++piece)
            if (repeated->empty() ||
                !std::binary_search(repeated->begin(), repeated->end(), TetId::make(cell, piece).value))
                visit(orienter.stored(cells.type(cell), pieces, piece, counts));
    };
    tbb::enumerable_thread_specific<Orienter::Counts> counts;
    parallel_ranges(cells.count(), cells_a_chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end; ++cell) for_stored_tets(cell, counts.local(), [](const Tet&) {});
    });
    for (const Orienter::Counts& part : counts) out.orientation.combine(part);
    out.inverted = orienter.inverted(out.orientation);

    const std::uint64_t hands = hands_for(4 * survey.tets * sizeof(FaceUse), memory);
    for (std::uint64_t hand = 0; hand < hands; ++hand) {
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "checking the grid was cancelled"};
        progress("check", 0.6 + 0.4 * static_cast<double>(hand) / static_cast<double>(hands));
        Buffer<FaceUse> uses = collect<FaceUse>(cells.count(), [&](std::size_t cell, const auto& emit) {
            Orienter::Counts ignored;
            for_stored_tets(cell, ignored, [&](const Tet& tet) {
                for (std::size_t f = 0; f < 4; ++f) {
                    const DirectedFace face = face_of(tet, f);
                    if (in_hand(face.points[0], hand, hands))
                        emit(FaceUse{
                            {face.points[0], face.points[1], face.points[2] << 1 | std::uint64_t{face.mirrored}}});
                }
            });
        });
        tbb::parallel_sort(uses.begin(), uses.end());
        out.boundary_faces += sum_over_runs(uses, same_face, [](const FaceUse* first, const FaceUse* last) {
            std::int64_t balance = 0;
            for (; first != last; ++first) balance += first->key[2] & 1 ? -1 : 1;
            return std::uint64_t{balance != 0};
        });
    }
    return out;
}

} // namespace isotet::core
