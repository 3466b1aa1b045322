// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Results of CalculiX (.frd), in text and binary.
#pragma once

#include <string_view>

#include <isotet/progress.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

namespace isotet::io {

/// True for the first bytes of such a file.
bool looks_like_frd(std::string_view head);

/// Tells the point fields (DISP, STRESS ...) and times. A step is what follows without a change of its number and value:
/// increments, or modes, whose value is a frequency.
Result<FileInfo> inspect_frd(std::string_view file, const Progress& progress);

/// Reads the mesh and the fields of one step; nodes that a field does not have are NaN.
///
/// Errors   invalid_data: a rule of the format broken in the mesh, with place, value and rule. Fields that are broken are left
///          out, with the reason
Result<ReadResult> parse_frd(std::string_view file, const ReadOptions& options, const Progress& progress);

} // namespace isotet::io
