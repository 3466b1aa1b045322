// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The XML of an XDMF file: entities of its DOCTYPE replaced, references and XInclude followed.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <pugixml.hpp>

#include <isotet/result.hpp>

namespace isotet::io::confined {

/// Names in XDMF are the same in upper and lower case.
bool same_word(std::string_view a, std::string_view b);

/// All text of an element, without its comments and elements, and without space at its ends.
std::string text_of(pugi::xml_node node);

/// An XDMF file and the files that it includes. Included elements are never copied: they are children of several
/// elements, and children() finds them.
class XdmfDocument {
public:
    /// Errors   invalid_data: not XML, no Domain, a reference that names nothing, includes that name nothing or
    ///          contain themselves, files that must not be included
    static Result<XdmfDocument> open(const std::string& path, bool allow_outside);

    /// The children of this name, those that are included there among them.
    std::vector<pugi::xml_node> children(pugi::xml_node parent, std::string_view name) const;
    pugi::xml_node child(pugi::xml_node parent, std::string_view name) const;

    std::vector<pugi::xml_node> domains() const;

    /// The element that `node` stands for: itself, or what its Reference names. Null when that is not there, or not a
    /// plain path.
    pugi::xml_node resolve(pugi::xml_node node) const;

    /// The file that an element is in: names in it are relative to its folder.
    const std::string& file_of(pugi::xml_node node) const;
    /// The one that was opened.
    const std::string& first_file() const { return files_.front()->path; }

private:
    struct File {
        std::string path;
        pugi::xml_document xml;
    };
    using Elements = std::vector<pugi::xml_node>;

    XdmfDocument() = default;
    Result<const File*> open_file(const std::string& path);
    Result<void> follow_includes(const File& file);
    Result<const Elements*> included(const File& file, pugi::xml_node include, int depth);
    Result<Elements> selected(const File& file, pugi::xml_node include);
    Result<const File*> file_named(const File& file, std::string_view name);
    const File* file_with(pugi::xml_node node) const;

    bool allow_outside_ = false;
    std::vector<std::unique_ptr<File>> files_;                ///< the first is the one that was opened
    std::map<std::string, Elements, std::less<>> inclusions_; ///< by file, href and xpointer
    std::unordered_map<const void*, const Elements*> by_include_;
    mutable std::map<std::string, pugi::xml_node, std::less<>> found_; ///< what references named before
};

} // namespace isotet::io::confined
