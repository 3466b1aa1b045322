// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The arrays of a packed grid, and the pieces of a file that fill them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "io/packed/chunk_cache.hpp"
#include "packed/packed.hpp"

namespace isotet::io {

/// Makes the arrays of a packed grid.
class ArrayMaker {
public:
    enum class As { reserved, memory };
    ArrayMaker(As as, const ChunkPlaces& places) : as_(as), places_(places) {}

    /// `components`   numbers a point, word, link word or group;  `slack`  more that may be read at the end
    template <class T>
    ChunkedArray make(core::SharedBuffer<T>& out, Unit unit, std::size_t components = 1, std::size_t slack = 0) const {
        if (places_.size(unit) == 0) slack = 0; // as packing has it
        const std::size_t size = components * places_.size(unit) + slack;
        if (as_ == As::memory) {
            out = core::SharedBuffer<T>(size);
            std::fill(out.end() - static_cast<std::ptrdiff_t>(slack), out.end(), T{});
        } else {
            auto space = reserve_address_space(size * sizeof(T));
            T* const first = reinterpret_cast<T*>(space.get());
            out = core::SharedBuffer<T>(std::shared_ptr<T>(std::move(space), first), size);
        }
        return {reinterpret_cast<std::byte*>(out.data()), components * sizeof(T), unit};
    }

private:
    As as_;
    const ChunkPlaces& places_;
};

/// Arrays of own points: positions, user's numbers, ranks.
std::vector<ChunkedArray> make_point_arrays(const PackedDirectory& d, const ArrayMaker& maker, core::Packed& packed);
std::vector<ChunkedArray> make_topology_arrays(const PackedDirectory& d, const ArrayMaker& maker, core::Packed& packed);
std::vector<ChunkedArray> make_value_arrays(const FieldEntry& field, const ArrayMaker& maker, core::Packed& packed);
/// Positions alone.
std::vector<ChunkedArray> make_position_arrays(const ArrayMaker& maker, core::Packed& packed);

/// All that the directory tells of the grid, of its field, of the points of a step.
core::Packed packed_of(const PackedDirectory& d);
void set_field_of(const FieldEntry& field, core::Packed& packed);
void set_points_of(const PointsEntry& points, core::Packed& packed);

PieceKind points_kind(const PackedDirectory& d, std::vector<ChunkedArray> arrays);
PieceKind topology_kind(const PackedDirectory& d, std::vector<ChunkedArray> arrays);
PieceKind values_kind(const PackedDirectory& d, const FieldEntry& field, std::vector<ChunkedArray> arrays);
PieceKind positions_kind(const PackedDirectory& d, const PointsEntry& points, std::vector<ChunkedArray> arrays);

} // namespace isotet::io
