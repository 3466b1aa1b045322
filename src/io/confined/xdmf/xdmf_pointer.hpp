// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What an xpointer of XInclude, or a Reference of XDMF, names in a document.
#pragma once

#include <string_view>
#include <vector>

#include <pugixml.hpp>

namespace isotet::io::confined {

/// The elements on a path: /Xdmf/Domain/Grid[@Name="a"][1]/*[self::Topology or self::Geometry], alternatives between
/// bars. Each alternative may go over the document once only: none where one has more than one "//", or a path within
/// brackets.
std::vector<pugi::xml_node> elements_on_path(const pugi::xml_node& document, std::string_view path);

/// The elements that an xpointer names: xpointer(path), element(/1/2/1) or element(id/2), an id alone; of several
/// parts those of the first that names any. Empty where there are none.
std::vector<pugi::xml_node> elements_at(const pugi::xml_node& document, std::string_view xpointer);

} // namespace isotet::io::confined
