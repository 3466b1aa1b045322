// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/join/shared_faces.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/buffer.hpp"
#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"
#include "io/pieces/join/face_streams.hpp"

namespace isotet::io {
namespace {

constexpr std::size_t faces_grain = std::size_t{1} << 14U;
constexpr std::size_t cells_grain = std::size_t{1} << 10U;

Result<void> check_index_array(const Array& array, const char* what) {
    if (array.empty()) return {};
    if (!is_floating(array.type()) && size_of(array.type()) >= 4 && array.components() == 1) return {};
    return invalid_data(fmt::format("{} are {} with {} components, but must be integers of 32 or 64 bits with 1", what,
                                    name_of(array.type()), array.components()));
}

/// The lowest i below count that is wrong; count if none is.
template <class IsWrong>
std::size_t first_wrong(std::size_t count, const IsWrong& is_wrong) {
    std::atomic<std::size_t> lowest = count;
    core::parallel_ranges(count, faces_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!is_wrong(i)) continue;
            std::size_t seen = lowest.load();
            while (i < seen && !lowest.compare_exchange_weak(seen, i)) {}
            return;
        }
    });
    return lowest.load();
}

Result<void> check_ranges(const Array& offsets, std::size_t size, const char* owner, const char* what) {
    if (offsets.empty()) return invalid_data(fmt::format("there are no offsets of the {} of a {}", what, owner));
    const core::IndexColumn at(offsets);
    const std::size_t wrong = first_wrong(offsets.size() - 1, [&](std::size_t i) {
        return at[i] > at[i + 1] || at[i + 1] > size; // negative numbers are large ones
    });
    if (wrong + 1 == offsets.size()) return {};
    return invalid_data(fmt::format("{} {} has {} {} to {} of {}, but offsets must not fall or leave the list", owner,
                                    wrong, what, static_cast<std::int64_t>(at[wrong]),
                                    static_cast<std::int64_t>(at[wrong + 1]), size));
}

/// The checked arrays, and where each cell's part of the stream begins.
struct FacePlan {
    core::IndexColumn points, face_offsets, faces, cell_offsets;
    core::Buffer<std::int64_t> places;

    std::uint64_t corners(std::uint64_t face) const { return face_offsets[face + 1] - face_offsets[face]; }
};

/// Faces have two sides: where they have many more, a small file would fill any memory.
std::uint64_t max_stream(const SharedFaces& shared) {
    return 16 * (std::uint64_t{shared.points.size()} + shared.faces.size()) + 1024;
}

Result<std::uint64_t> measure_parts(const SharedFaces& shared, FacePlan& plan) {
    const std::size_t cells = shared.cell_offsets.size() - 1;
    plan.places = core::Buffer<std::int64_t>(cells + 1);
    core::parallel_each(cells, faces_grain, [&](std::size_t cell) {
        const std::uint64_t begin = plan.cell_offsets[cell], end = plan.cell_offsets[cell + 1];
        std::uint64_t entries = begin == end ? 0 : 1 + end - begin;
        for (std::uint64_t i = begin; i < end; ++i) entries += plan.corners(plan.faces[i]);
        plan.places[cell + 1] = static_cast<std::int64_t>(entries);
    });
    const std::uint64_t limit = max_stream(shared);
    std::uint64_t sum = 0;
    plan.places[0] = 0;
    for (std::size_t cell = 0; cell < cells; ++cell) {
        sum += static_cast<std::uint64_t>(plan.places[cell + 1]);
        if (sum > limit)
            return invalid_data(fmt::format("the faces of the cells 0 to {} have {} entries, but {} points of {} faces "
                                            "are in the file: a face has two sides",
                                            cell, sum, shared.points.size(), shared.face_offsets.size() - 1));
        plan.places[cell + 1] = static_cast<std::int64_t>(sum);
    }
    return sum;
}

template <class Index>
Array make_stream(const FacePlan& plan, std::uint64_t size) {
    core::Buffer<Index> stream(size);
    core::parallel_each(plan.places.size() - 1, faces_grain, [&](std::size_t cell) {
        const std::uint64_t begin = plan.cell_offsets[cell], end = plan.cell_offsets[cell + 1];
        if (begin == end) return;
        Index* next = stream.data() + plan.places[cell];
        *next++ = static_cast<Index>(end - begin);
        for (std::uint64_t i = begin; i < end; ++i) {
            const std::uint64_t face = plan.faces[i], last = plan.face_offsets[face + 1];
            *next++ = static_cast<Index>(plan.corners(face));
            for (std::uint64_t at = plan.face_offsets[face]; at < last; ++at)
                *next++ = static_cast<Index>(plan.points[at]);
        }
    });
    return std::move(stream).to_array();
}

Result<FacePlan> make_plan(const SharedFaces& shared) {
    for (const auto& [array, what] :
         {std::pair(&shared.points, "points of faces"), std::pair(&shared.face_offsets, "offsets of faces"),
          std::pair(&shared.faces, "faces of cells"), std::pair(&shared.cell_offsets, "offsets of cells' faces")})
        if (auto fits = check_index_array(*array, what); !fits) return fits.error();
    if (auto fits = check_ranges(shared.face_offsets, shared.points.size(), "face", "points"); !fits)
        return fits.error();
    if (auto fits = check_ranges(shared.cell_offsets, shared.faces.size(), "cell", "faces"); !fits) return fits.error();
    FacePlan plan{core::IndexColumn(shared.points),
                  core::IndexColumn(shared.face_offsets),
                  core::IndexColumn(shared.faces),
                  core::IndexColumn(shared.cell_offsets),
                  {}};
    const std::uint64_t count = shared.face_offsets.size() - 1;
    const std::size_t wrong = first_wrong(shared.faces.size(), [&](std::size_t i) { return plan.faces[i] >= count; });
    if (wrong < shared.faces.size())
        return invalid_data(fmt::format("a polyhedron has face {}, but there are {} faces",
                                        static_cast<std::int64_t>(plan.faces[wrong]), count));
    if (auto measured = measure_parts(shared, plan); !measured) return measured.error();
    return plan;
}

/// The corners of a cell: of one with faces their points, each once, ascending.
class CornerList {
public:
    CornerList(const Cells& cells, const core::FaceReader& faces)
        : faces_(faces), connectivity_(cells.connectivity), offsets_(cells.offsets) {}

    const std::vector<std::int64_t>& of(std::size_t cell) {
        corners_.clear();
        if (faces_.begin(cell) == faces_.end(cell)) {
            for (std::uint64_t i = offsets_[cell]; i < offsets_[cell + 1]; ++i)
                corners_.push_back(static_cast<std::int64_t>(connectivity_[i]));
            return corners_;
        }
        for (std::uint64_t at = faces_.begin(cell) + 1; at < faces_.end(cell);)
            for (std::uint64_t left = faces_.at(at++); left > 0; --left)
                corners_.push_back(static_cast<std::int64_t>(faces_.at(at++)));
        std::ranges::sort(corners_);
        corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
        return corners_;
    }

private:
    const core::FaceReader& faces_;
    core::IndexColumn connectivity_, offsets_;
    std::vector<std::int64_t> corners_;
};

} // namespace

Result<void> check_shared_faces(const SharedFaces& shared) {
    if (auto plan = make_plan(shared); !plan) return plan.error();
    return {};
}

Result<void> write_out_faces(const SharedFaces& shared, Cells& cells) {
    auto plan = make_plan(shared);
    if (!plan) return plan.error();
    const auto size = static_cast<std::uint64_t>(plan->places[plan->places.size() - 1]);
    const bool narrow =
        shared.points.type() == ScalarType::int32 && size <= std::uint64_t{std::numeric_limits<std::int32_t>::max()};
    cells.faces = narrow ? make_stream<std::int32_t>(*plan, size) : make_stream<std::int64_t>(*plan, size);
    cells.face_offsets = std::move(plan->places).to_array();
    return {};
}

Result<void> list_points_of_faces(std::uint64_t points, Cells& cells) {
    const auto faces = core::FaceReader::open(cells);
    if (!faces) return faces.error();
    if (!faces->has_faces()) return {};
    if (auto sound = check_face_streams(cells, points); !sound) return sound;
    if (auto sound = check_ranges(cells.offsets, cells.connectivity.size(), "cell", "corners"); !sound) return sound;
    const std::size_t count = cells.count();
    core::Buffer<std::int64_t> offsets(count + 1);
    offsets[0] = 0;
    core::parallel_ranges(count, cells_grain, [&](std::size_t begin, std::size_t end) {
        CornerList corners(cells, *faces);
        for (std::size_t cell = begin; cell < end; ++cell)
            offsets[cell + 1] = static_cast<std::int64_t>(corners.of(cell).size());
    });
    for (std::size_t cell = 0; cell < count; ++cell) offsets[cell + 1] += offsets[cell];
    const auto fill = [&]<class Index>(core::Buffer<Index> connectivity) {
        core::parallel_ranges(count, cells_grain, [&](std::size_t begin, std::size_t end) {
            CornerList corners(cells, *faces);
            for (std::size_t cell = begin; cell < end; ++cell) {
                Index* to = connectivity.data() + offsets[cell];
                for (const std::int64_t corner : corners.of(cell)) *to++ = static_cast<Index>(corner);
            }
        });
        cells.connectivity = std::move(connectivity).to_array();
    };
    const auto size = static_cast<std::size_t>(offsets[count]);
    if (points <= std::uint64_t{std::numeric_limits<std::int32_t>::max()}) fill(core::Buffer<std::int32_t>(size));
    else fill(core::Buffer<std::int64_t>(size));
    cells.offsets = std::move(offsets).to_array();
    return {};
}

} // namespace isotet::io
