// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where the program isotet-reader is, wherever isotet was installed or moved to.
#pragma once

#include <string>
#include <vector>

#include <isotet/result.hpp>

namespace isotet::io::confined {

/// What tells where the reader program may be. Empty parts are passed over.
struct ReaderPlaces {
    std::string library = {}; ///< the file that holds isotet's code: a shared library, or the program
    std::string to_programs =
        {};                   ///< from the folder of libraries to that of programs, when both are installed: "../bin"
    std::string program = {}; ///< the program that runs
    std::string search_path = {}; ///< folders separated by colons, as in PATH
    std::string built_in = {};    ///< where it was to be installed when isotet was built
};

/// Of this process.
ReaderPlaces reader_places();

/// Where to look, in order: beside the library and in the folder of programs of its prefix; the same of the program;
/// in the search path (its absolute folders); the built-in path.
std::vector<std::string> reader_candidates(const ReaderPlaces& places);

/// The first candidate that can be run.
///
/// Errors   machine, with what was looked for, and the option that names one
Result<std::string> find_reader(const ReaderPlaces& places);

} // namespace isotet::io::confined
