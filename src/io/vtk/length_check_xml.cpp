// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTK XML: the header (everything before the raw data) is parsed, then every appended block's own length is compared
// with what the file holds.
#include <algorithm>
#include <bit>
#include <cstring>

#include <fmt/core.h>
#include <pugixml.hpp>

#include "io/vtk/length_check.hpp"
#include "io/own/escape.hpp"
#include "io/own/loaded.hpp"
#include "io/vtk/mapped_file.hpp"

namespace isotet::io::vtk {
namespace {

struct Blocks {
    std::string_view data; ///< after the '_'
    bool swap = false;
    bool wide = false; ///< 64-bit headers
    bool compressed = false;

    /// The header word at `at`; nothing when it lies outside.
    std::optional<std::uint64_t> word(std::uint64_t at) const {
        const std::uint64_t size = wide ? 8 : 4;
        if (at > data.size() || data.size() - at < size) return std::nullopt;
        unsigned char bytes[8] = {};
        std::memcpy(bytes, data.data() + at, size);
        std::uint64_t value = 0;
        for (std::uint64_t i = 0; i < size; ++i) value |= std::uint64_t(bytes[swap ? size - 1 - i : i]) << (8 * i);
        return value;
    }

    /// Bytes that the block at `offset` needs; nothing when its header lies outside or is impossible.
    std::optional<std::uint64_t> needed(std::uint64_t offset) const {
        const std::uint64_t size = wide ? 8 : 4;
        const auto first = word(offset);
        if (!first) return std::nullopt;
        if (!compressed) return *first > data.size() ? std::nullopt : std::optional(size + *first);
        // compressed: number of blocks, their size, size of the last, compressed size of each
        if (*first > data.size() / size) return std::nullopt;
        std::uint64_t total = size * (3 + *first);
        for (std::uint64_t block = 0; block < *first; ++block) {
            const auto length = word(offset + size * (3 + block));
            if (!length || *length > data.size()) return std::nullopt;
            total += *length;
        }
        return total;
    }
};

Result<void> check_blocks(const std::string& path, const pugi::xml_node& root, const Blocks& blocks) {
    for (const auto& found : root.select_nodes(".//DataArray[@format='appended'] | .//Array[@format='appended']")) {
        const auto offset = found.node().attribute("offset").as_ullong();
        const auto needed = blocks.needed(offset);
        if (!needed || offset > blocks.data.size() || *needed > blocks.data.size() - offset)
            return broken(
                path, fmt::format("array \"{}\" begins at byte {} of {} appended bytes and does not end inside them: "
                                  "the file is cut short or broken",
                                  escaped(found.node().attribute("Name").as_string()), offset, blocks.data.size()));
    }
    return {};
}

} // namespace

Result<void> check_xml_length(const std::string& path) {
    auto file = MappedFile::open(path);
    if (!file) return file.error();
    const std::string_view text = file->text();
    const std::size_t tail = std::min<std::size_t>(text.size(), 4096);
    if (text.substr(text.size() - tail).find("</VTKFile>") == std::string_view::npos)
        return broken(path,
                      fmt::format("the file ends after {} bytes without </VTKFile>: it is cut short", text.size()));

    if (text.substr(0, 1 << 16).find("\"appended\"") == std::string_view::npos) return {};
    const auto appended = text.find("<AppendedData");
    const auto underscore = appended == std::string_view::npos ? appended : text.find('_', text.find('>', appended));
    if (underscore == std::string_view::npos)
        return broken(path, "arrays are said to be appended, but there is no AppendedData");
    if (text.substr(appended, underscore - appended).find("raw") == std::string_view::npos) return {};

    pugi::xml_document document; // the end tags lie after the data: the tree of what comes before it is complete anyway
    document.load_buffer(text.data(), appended, pugi::parse_default | pugi::parse_fragment);
    const pugi::xml_node root = document.child("VTKFile");
    Blocks blocks;
    blocks.data = text.substr(underscore + 1);
    blocks.swap = (std::string_view(root.attribute("byte_order").as_string()) == "BigEndian") !=
                  (std::endian::native == std::endian::big);
    blocks.wide = std::string_view(root.attribute("header_type").as_string()) == "UInt64";
    blocks.compressed = !root.attribute("compressor").empty();
    return check_blocks(path, root, blocks);
}

} // namespace isotet::io::vtk
