// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The XML of an XDMF file: entities of its DOCTYPE replaced, references followed, grids sorted by time.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

#include <isotet/result.hpp>

namespace isotet::io::vtk {

/// Names in XDMF are the same in upper and lower case.
bool same_word(std::string_view a, std::string_view b);

/// The uniform grids of one time.
struct XdmfStep {
    double time = 0;
    bool has_time = false;
    std::vector<pugi::xml_node> grids;
};

class XdmfDocument {
public:
    /// Errors   invalid_data: not XML, no Domain, XInclude, a reference to nothing
    static Result<XdmfDocument> open(const std::string& path);

    const std::vector<XdmfStep>& steps() const noexcept { return steps_; }

    /// The element that `node` stands for: itself, or what its Reference names. Null when that is not there, or not a
    /// plain path.
    pugi::xml_node resolve(pugi::xml_node node) const;

private:
    XdmfDocument() = default;
    Result<void> gather(pugi::xml_node parent, int depth);
    Result<void> gather_temporal(pugi::xml_node collection, int depth);

    std::string path_;
    pugi::xml_document document_;
    std::vector<XdmfStep> steps_;
    mutable std::map<std::string, pugi::xml_node, std::less<>> found_; ///< what references named before
    std::size_t visited_ = 0; ///< collections, each as often as it is referred to
};

} // namespace isotet::io::vtk
