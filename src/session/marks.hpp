// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the session last stored, to be known again: by its memory, or else by a fingerprint of its contents.
#pragma once

#include <isotet/grid.hpp>

#include "base/array_identity.hpp"
#include "session/fingerprint.hpp"

namespace isotet::session {

/// Cells as they were when the grid was packed.
class CellsMark {
public:
    explicit CellsMark(const Grid& grid);

    /// Equal cells in other memory are known by that memory afterwards.
    bool is(const Grid& grid);

private:
    bool has_the_memory_of(const Cells& cells) const;

    core::ArrayIdentity connectivity_, offsets_, types_, faces_, face_offsets_, numbers_;
    CellType uniform_type_;
    Fingerprint print_, numbers_print_;
};

/// Points or values as they were when they were stored.
class ArrayMark {
public:
    explicit ArrayMark(const Array& array) : identity_(array), print_(fingerprint(array)) {}

    /// Equal contents in other memory are known by that memory afterwards.
    bool is(const Array& array);

private:
    core::ArrayIdentity identity_;
    Fingerprint print_;
};

} // namespace isotet::session
