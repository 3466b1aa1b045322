// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A field's file: the values inside, and those that are known on patches.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <isotet/result.hpp>

#include "io/foam/case_files.hpp"
#include "io/foam/mesh.hpp"
#include "io/foam/scanner.hpp"

namespace isotet::io::foam {

/// One tuple for all, or one for each.
struct Values {
    bool uniform = true;
    std::vector<double> values;
};

/// What boundaryField has of one patch, of a group of patches, or of all whose names fit a pattern.
struct PatchEntry {
    std::string key, type;
    bool pattern = false;
    std::optional<Values> value;
};

struct FieldFile {
    std::string path;
    Header header;
    std::size_t components = 1;
    std::optional<Values> inside;
    std::vector<PatchEntry> patches;
    std::set<std::string> faults;      ///< of values of patches: these are taken for not given
    std::set<std::string> unread;      ///< files of an OpenFOAM installation that it includes
    bool has_constraint_types = false; ///< among these, entries without values for all constraint patches
};

/// `most`   as many tuples as a list may repeat one value for
/// Errors   as CaseFiles::open(); invalid_data: broken or cut short; values inside that would have to be computed or run
///          (#calc, #codeStream); an included file outside of the case
Result<FieldFile> read_field_file(const CaseFiles& files, const std::string& name, std::size_t most,
                                  bool allow_outside);

/// The values of a patch that are known, not copied from the cells beside it; nothing on empty, processor, cyclic and
/// wedge patches, and where there are none.
std::optional<Values> known_values(const FieldFile& field, const Patch& patch);

/// True when a pattern of OpenFOAM fits a whole name: . * + ? ( | ) [ ]. Patterns that take too long do not.
ISOTET_API bool fits_pattern(std::string_view pattern, std::string_view name);

} // namespace isotet::io::foam
