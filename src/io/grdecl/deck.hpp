// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Keywords of a reservoir simulator's input ("deck") and what follows each, through its included files.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet::io::grdecl {

/// The content of a file. Copies share it.
struct DeckText {
    std::string path; ///< for messages
    std::shared_ptr<const void> owner;
    std::string_view text;
};

/// Opens a file that INCLUDE names.
using OpenIncluded = std::function<Result<DeckText>(std::string_view name)>;

/// A keyword with what stands before its '/'.
struct Record {
    std::string keyword; ///< in capitals
    DeckText file;
    std::string_view body; ///< without the '/'

    /// "PATH: line 12: ZCORN: WHAT"
    Error fail(std::string_view what) const;
};

struct Deck {
    std::vector<Record> records;      ///< those that describe a grid or are lists of numbers, in the order of the deck
    std::set<std::string> operations; ///< keywords that change arrays, which are not carried out
};

/// Reads a deck up to its schedule. Tables of fluids and rocks (between PROPS and the next section) are gone over.
///
/// Errors   invalid_data: a record without its '/', more than 1,000 included files, or a file that includes itself;
///          those of `open`; cancelled
/// Cost     O(bytes), serial; no memory but for the texts
ISOTET_API Result<Deck> read_deck(const DeckText& text, const OpenIncluded& open, const Progress& progress);

} // namespace isotet::io::grdecl
