// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Field names as the formats can hold them. A name in a grid can be any bytes.
#pragma once

#include <set>
#include <string>
#include <string_view>

namespace isotet::io {

/// Control characters and bytes that are not UTF-8 become %XX; all else stays.
std::string printable_name(std::string_view name);

/// printable_name() with & < > and quotes as XML entities.
std::string xml_name(std::string_view name);

/// As VTK's legacy writer does it: everything but visible ASCII, and " and %, becomes %XX.
/// VTK reads back the same bytes.
std::string legacy_vtk_name(std::string_view name);

/// One word for a PLY header: visible ASCII stays, all else becomes _.
std::string ply_name(std::string_view name);

/// Printable, without the double quotes between which Gocad wants names with spaces.
std::string gocad_name(std::string_view name);

/// `name`, or `name`_2, _3 ... if that is taken already; "field" if it is empty. Takes it.
std::string take_name(std::string_view name, std::set<std::string, std::less<>>& taken);

} // namespace isotet::io
