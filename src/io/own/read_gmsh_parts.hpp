// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the parts of the MSH reader share: the file as sections, and the mesh they make of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/read.hpp>
#include <isotet/result.hpp>

#include "io/own/byte_reader.hpp"
#include "io/own/cell_list.hpp"
#include "io/own/number_map.hpp"
#include "io/own/pace.hpp"
#include "io/own/text_scanner.hpp"

namespace isotet::io::gmsh {

/// What stands between $Name and $EndName.
struct Section {
    std::string_view name; ///< without the $
    std::string_view body;
    std::size_t start = 0; ///< of the body, in the file
    bool ended = false;    ///< false: the file ends before $EndName
};

struct File {
    bool version_4 = false; ///< 4.1; else 2.0 to 2.2
    bool binary = false;
    bool swapped = false;         ///< binary, in the other byte order
    std::size_t number_bytes = 4; ///< of a node or element number in $Nodes and $Elements, binary
    std::vector<Section> sections;

    const Section* find(std::string_view name) const;
};

/// Reads the header and finds the sections; their content is not looked at.
Result<File> open(std::string_view bytes);

/// "$Nodes: message".
Error broken(const Section& section, const std::string& message);

/// One of Gmsh's element types.
struct ElementType {
    std::uint8_t vtk_type;
    std::uint32_t nodes;
    std::span<const std::uint16_t> order; ///< for each node in VTK's order its position in the file; empty: the same
};
std::optional<ElementType> element_type(std::int32_t number);

/// A cell of points in the order of the file.
void add_element(CellList& cells, const ElementType& type, std::span<const std::uint64_t> points);

/// What is wanted beside points and cells.
struct Wants {
    bool physical = false, geometrical = false, element_numbers = false;
};

struct Mesh {
    std::vector<double> points; ///< x y z x y z ...
    NumberMap nodes;
    CellList cells{0};
    NumberMap elements; ///< if wanted
    std::vector<std::int32_t> physical, geometrical;
};

/// The names of the physical groups of volumes, numbers of the cell field `field`.
Result<std::vector<RegionName>> names_of_volumes(const File& file, std::string_view field);

/// Which of `gmsh:physical` and `gmsh:geometrical` the file has.
Result<Wants> tags_of_2(const File& file);
Result<Wants> tags_of_4(const File& file);

Result<Mesh> read_mesh_2(const File& file, const Wants& wants, Pace& pace);
Result<Mesh> read_mesh_4(const File& file, const Wants& wants, Pace& pace);

/// The header of a $NodeData or $ElementData section, and where its values start.
struct DataSection {
    const Section* section = nullptr;
    Association association = Association::point;
    std::string name;
    double time = 0;
    std::int32_t step = 0;
    std::int32_t components = 1;
    std::int32_t count = 0;
    std::size_t values = 0; ///< position in the section's body
};
Result<std::vector<DataSection>> data_sections(const File& file);

/// Puts the values of a section at the positions of their nodes or elements.
Result<void> read_values(const File& file, const DataSection& data, const NumberMap& numbers, Pace& pace,
                         std::vector<double>& values);

/// Numbers of an ascii section.
class TextSource {
public:
    static constexpr bool is_text = true;

    TextSource(const File&, const Section& section, std::size_t from = 0, std::size_t = 0)
        : scanner_(section.body), start_(section.start) {
        scanner_.seek(from);
    }

    bool count_line(std::int64_t& value) { return scanner_.number(value); }
    bool integer(std::int32_t& value) { return scanner_.number(value); }
    bool number(std::int64_t& value) { return scanner_.number(value); }
    bool real(double& value) { return scanner_.number(value); }
    bool at_end() { return scanner_.at_end(); }

    std::size_t position() const { return start_ + scanner_.position(); }
    std::string where() const { return scanner_.where() + " of the section"; }

    /// No more records of so many integers, numbers and reals than this can be left.
    std::uint64_t records_left(std::size_t integers, std::size_t numbers, std::size_t reals) const {
        return (scanner_.left() + 1) / (2 * (integers + numbers + reals));
    }

private:
    TextScanner scanner_;
    std::size_t start_;
};

/// Numbers of a binary section.
class ByteSource {
public:
    static constexpr bool is_text = false;

    /// `number_bytes`   0: as in $Nodes and $Elements
    ByteSource(const File& file, const Section& section, std::size_t from = 0, std::size_t number_bytes = 0)
        : reader_(section.body, file.swapped),
          start_(section.start),
          number_bytes_(number_bytes ? number_bytes : file.number_bytes) {
        reader_.seek(from);
    }

    /// A count that is written as a line of text in binary files, too.
    bool count_line(std::int64_t& value) {
        TextScanner scanner(reader_.rest());
        if (!scanner.number(value)) return false;
        scanner.next_line();
        return reader_.skip(scanner.position());
    }
    bool integer(std::int32_t& value) { return reader_.read(value); }
    bool number(std::int64_t& value) {
        if (number_bytes_ == 8) return reader_.read(value);
        std::int32_t narrow = 0;
        if (!reader_.read(narrow)) return false;
        value = narrow;
        return true;
    }
    bool real(double& value) { return reader_.read(value); }
    bool at_end() { return TextScanner(reader_.rest()).at_end(); }

    std::size_t position() const { return start_ + reader_.position(); }
    std::string where() const;

    std::uint64_t records_left(std::size_t integers, std::size_t numbers, std::size_t reals) const {
        return reader_.left() / (4 * integers + number_bytes_ * numbers + 8 * reals);
    }

private:
    ByteReader reader_;
    std::size_t start_;
    std::size_t number_bytes_;
};

/// Calls `parse` with the source that fits the file: `parse(TextSource&)` or `parse(ByteSource&)`.
template <class Parse>
auto with_source(const File& file, const Section& section, const Parse& parse) {
    if (file.binary) {
        ByteSource source(file, section);
        return parse(source);
    }
    TextSource source(file, section);
    return parse(source);
}

/// After the last record of a section: there must be no more, and $End... must follow.
template <class Source>
Result<void> finish_section(const Section& section, Source& source) {
    if (!source.at_end()) return broken(section, "holds more than it states, at " + source.where());
    if (!section.ended) return broken(section, "has no $End" + std::string(section.name) + ": the file is cut short");
    return {};
}

/// $Nodes and $Elements (or another pair) are there, once.
Result<const Section*> only_section(const File& file, std::string_view name);

} // namespace isotet::io::gmsh
