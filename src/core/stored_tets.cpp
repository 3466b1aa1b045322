// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/stored_tets.hpp"

#include <algorithm>

#include <tbb/parallel_sort.h>

#include "core/orientation.hpp"
#include "core/parallel.hpp"

namespace isotet::core {

StoredTets stored_tets(const Grid& grid, const CellReader& cells, const TetSurvey& survey) {
    struct Numbered {
        Tet sorted;
        TetId id;
    };
    std::vector<Numbered> all;
    all.reserve(survey.tets);
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        const CellTets tets = cells.tets(cell);
        for (int piece = 0; piece < tets.count; ++piece) {
            Tet sorted = tets.tets[static_cast<std::size_t>(piece)];
            std::sort(sorted.begin(), sorted.end());
            all.push_back({sorted, TetId::make(cell, static_cast<unsigned>(piece))});
        }
    }
    tbb::parallel_sort(all.begin(), all.end(), [](const Numbered& a, const Numbered& b) {
        return a.sorted != b.sorted ? a.sorted < b.sorted : a.id.value < b.id.value;
    });
    StoredTets out;
    const auto last = std::unique(all.begin(), all.end(), [](const Numbered& a, const Numbered& b) { return a.sorted == b.sorted; });
    out.repeated = static_cast<std::uint64_t>(all.end() - last);
    all.erase(last, all.end());
    tbb::parallel_sort(all.begin(), all.end(), [](const Numbered& a, const Numbered& b) { return a.id.value < b.id.value; });

    const Orienter orienter(grid.points, survey.mostly_negative);
    Orienter::Counts counts;
    out.tets.reserve(all.size());
    for (const Numbered& tet : all)
        out.tets.push_back(orienter.stored(cells.type(tet.id.cell()), cells.tets(tet.id.cell()), tet.id.piece(), counts));
    out.negative = counts.negative + counts.twisted;
    out.inverted = orienter.inverted(counts);
    out.flat = counts.flat;
    return out;
}

std::vector<StoredFace> faces_of(const std::vector<Tet>& tets) {
    std::vector<StoredFace> faces(4 * tets.size());
    // Outward faces of an upright tet.
    static constexpr std::size_t corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    parallel_each(tets.size(), 1 << 14, [&](std::size_t t) {
        for (std::size_t f = 0; f < 4; ++f) {
            std::array<std::uint64_t, 3> p{tets[t][corners[f][0]], tets[t][corners[f][1]], tets[t][corners[f][2]]};
            const bool odd = (p[0] > p[1]) ^ (p[0] > p[2]) ^ (p[1] > p[2]);
            std::sort(p.begin(), p.end());
            faces[4 * t + f] = {p, odd ? 0u : 1u, odd ? 1u : 0u};
        }
    });
    tbb::parallel_sort(faces.begin(), faces.end(), [](const StoredFace& a, const StoredFace& b) { return a.points < b.points; });
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

std::vector<StoredFace> boundary_faces(const std::vector<Tet>& tets) {
    std::vector<StoredFace> faces = faces_of(tets);
    std::erase_if(faces, [](const StoredFace& face) { return face.forward == face.backward; });
    return faces;
}

} // namespace isotet::core
