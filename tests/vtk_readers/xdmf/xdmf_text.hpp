// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Parts of XDMF files for tests: two tets on five points.
#pragma once

#include <string>

namespace isotet::test {

inline std::string xdmf_document(const std::string& domain) {
    return "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\" xmlns:xi=\"http://www.w3.org/2001/XInclude\"><Domain>" +
           domain + "</Domain></Xdmf>\n";
}

/// `element` with these attributes around some text.
inline std::string xdmf_item(const std::string& attributes, const std::string& text) {
    return "<DataItem " + attributes + ">" + text + "</DataItem>";
}

inline std::string xdmf_points(const std::string& above = "1") {
    return "<Geometry GeometryType=\"XYZ\">" +
           xdmf_item("Format=\"XML\" Dimensions=\"5 3\" Precision=\"8\"",
                     "0 0 0  1 0 0  0 1 0  0 0 " + above + "  0 0 -1") +
           "</Geometry>";
}
inline std::string xdmf_tets(const std::string& numbers = "0 1 2 3  0 2 1 4") {
    return "<Topology TopologyType=\"Tetrahedron\">" + xdmf_item("Format=\"XML\" NumberType=\"Int\"", numbers) +
           "</Topology>";
}
inline std::string xdmf_field(const std::string& name, const std::string& values, const std::string& center = "Node") {
    return "<Attribute Name=\"" + name + "\" Center=\"" + center + "\">" +
           xdmf_item("Format=\"XML\" Precision=\"8\"", values) + "</Attribute>";
}

inline std::string xdmf_grid(const std::string& name, const std::string& content) {
    return "<Grid Name=\"" + name + "\" GridType=\"Uniform\">" + content + "</Grid>";
}
inline std::string xdmf_mesh() { return xdmf_grid("mesh", xdmf_points() + xdmf_tets()); }
inline std::string xdmf_collection(const std::string& name, const std::string& kind, const std::string& content) {
    return "<Grid Name=\"" + name + "\" GridType=\"Collection\" CollectionType=\"" + kind + "\">" + content + "</Grid>";
}

inline std::string xdmf_time(const std::string& time) { return "<Time Value=\"" + time + "\"/>"; }

} // namespace isotet::test
