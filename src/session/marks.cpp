// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "session/marks.hpp"

namespace isotet::session {

namespace {

bool is_same(const core::ArrayIdentity& before, const Array& now) {
    return now.empty() ? before.is_empty() : before.is(now);
}

} // namespace

CellsMark::CellsMark(const Grid& grid)
    : connectivity_(grid.cells.connectivity),
      offsets_(grid.cells.offsets),
      types_(grid.cells.types),
      faces_(grid.cells.faces),
      face_offsets_(grid.cells.face_offsets),
      numbers_(grid.point_numbers),
      uniform_type_(grid.cells.uniform_type),
      print_(fingerprint(grid.cells)),
      numbers_print_(fingerprint(grid.point_numbers)) {}

bool CellsMark::has_the_memory_of(const Cells& cells) const {
    return is_same(connectivity_, cells.connectivity) && is_same(offsets_, cells.offsets) &&
           is_same(types_, cells.types) && is_same(faces_, cells.faces) && is_same(face_offsets_, cells.face_offsets) &&
           uniform_type_ == cells.uniform_type;
}

bool CellsMark::is(const Grid& grid) {
    const Cells& cells = grid.cells;
    if (!is_same(numbers_, grid.point_numbers)) {
        if (numbers_print_ != fingerprint(grid.point_numbers)) return false;
        numbers_ = core::ArrayIdentity(grid.point_numbers);
    }
    if (has_the_memory_of(cells)) return true;
    if (print_ != fingerprint(cells)) return false;
    connectivity_ = core::ArrayIdentity(cells.connectivity);
    offsets_ = core::ArrayIdentity(cells.offsets);
    types_ = core::ArrayIdentity(cells.types);
    faces_ = core::ArrayIdentity(cells.faces);
    face_offsets_ = core::ArrayIdentity(cells.face_offsets);
    uniform_type_ = cells.uniform_type;
    return true;
}

bool ArrayMark::is(const Array& array) {
    if (identity_.is(array)) return true;
    if (print_ != fingerprint(array)) return false;
    identity_ = core::ArrayIdentity(array);
    return true;
}

} // namespace isotet::session
