// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the parts of the MSH reader share: the file as sections, and the mesh they make of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <isotet/read.hpp>
#include <isotet/result.hpp>

#include "io/files/byte_reader.hpp"
#include "io/files/pace.hpp"
#include "io/files/text_scanner.hpp"
#include "io/pieces/cell_list.hpp"
#include "io/pieces/node_means.hpp"
#include "io/pieces/number_map.hpp"

namespace isotet::io::gmsh {

/// How numbers are written.
struct Form {
    bool binary = false;
    bool swapped = false;         ///< binary, in the other byte order
    std::size_t number_bytes = 4; ///< of a node or element number in $Nodes and $Elements, binary
    std::size_t count_bytes = 4;  ///< of a count there
};

/// What stands between $Name and $EndName.
struct Section {
    std::string_view name; ///< without the $
    std::string_view body;
    std::size_t start = 0; ///< of the body, in the file
    bool ended = false;    ///< false: the file ends before $EndName
    Form form = {};        ///< by the last $MeshFormat before: views that were appended have their own
};

enum class Version : std::uint8_t { v1, v2, v40, v41 };

struct File {
    Version version = Version::v2;
    std::vector<Section> sections;

    const Section* find(std::string_view name) const;
    std::string_view name_of_nodes() const;
    std::string_view name_of_elements() const { return version == Version::v1 ? "ELM" : "Elements"; }
};

/// Reads the header and finds the sections; their content is not looked at.
Result<File> open(std::string_view bytes);

/// "$EndNodes", "$ENDNOD".
std::string end_of(std::string_view name);

/// "$Nodes: message".
Error broken(const Section& section, const std::string& message);

/// One of Gmsh's element types.
struct ElementType {
    std::uint8_t vtk_type;
    std::uint32_t nodes;
    std::span<const std::uint16_t> order; ///< for each node in VTK's order its position in the file; empty: the same
};
std::optional<ElementType> element_type(std::int32_t number);

/// What is wanted beside points and cells.
struct Wants {
    bool physical = false, geometrical = false, partition = false, element_numbers = false;
    bool element_points = false; ///< in the order of the file
    bool all_groups = false;     ///< elements once for each physical group they are in, where the file has them so
    /// Dimensions and numbers of those that are chosen; none: all.
    std::vector<std::pair<std::int32_t, std::int32_t>> groups = {};
};

/// Tags of one element, or of the elements of an entity.
struct Tags {
    std::int32_t physical = 0, geometrical = 0, partition = 0;
    bool left_out = false;
};

struct Mesh {
    std::vector<double> points; ///< x y z x y z ...
    NumberMap nodes;
    CellList cells{0};
    // If wanted:
    NumberMap elements;
    std::vector<std::int32_t> physical, geometrical, partition;
    std::vector<std::uint64_t> element_points, element_ends;
    std::vector<std::uint8_t> left_out; ///< nonzero for each ghost and repeat; empty, or up to the last of them
    std::uint64_t repeats = 0; ///< elements that are there again for another physical group

    /// `in_file`   the points in the order of the file
    void add_element(const Wants& wants, const ElementType& type, std::int64_t number,
                     std::span<const std::uint64_t> in_file, const Tags& tags) {
        cells.start(type.vtk_type, type.nodes);
        if (type.order.empty())
            for (const std::uint64_t point : in_file) cells.corner(point);
        else
            for (const std::uint16_t position : type.order) cells.corner(in_file[position]);
        if (tags.left_out) {
            left_out.resize(cells.size());
            left_out.back() = 1;
        }
        if (wants.element_numbers) elements.add(number);
        if (wants.physical) physical.push_back(tags.physical);
        if (wants.geometrical) geometrical.push_back(tags.geometrical);
        if (wants.partition) partition.push_back(tags.partition);
        if (!wants.element_points) return;
        element_points.insert(element_points.end(), in_file.begin(), in_file.end());
        element_ends.push_back(element_points.size());
    }
};

/// The names of the physical groups of volumes or surfaces (3 or 2), numbers of the cell field `field`.
Result<std::vector<RegionName>> names_of_groups(const File& file, std::int32_t of_dimension, std::string_view field);

/// Which of `gmsh:physical`, `gmsh:geometrical` and `gmsh:partition` the file has.
Result<Wants> tags_of(const File& file);

/// Points and elements. Where the sections occur again, as Gmsh writes them before each view that it appends, they must
/// hold the same nodes and elements.
Result<Mesh> read_mesh(const File& file, const Wants& wants, Pace& pace);

// The parts of the two: of versions 1 and 2, and of 4.0 and 4.1. `nodes` and `elements` are one section of the file.
Result<Wants> tags_of_2(const File& file);
Result<Wants> tags_of_4(const File& file);
Result<void> read_nodes_2(const File& file, const Section& nodes, Mesh& mesh, Pace& pace);
Result<void> read_nodes_4(const File& file, const Section& nodes, Mesh& mesh, Pace& pace);
Result<void> read_elements_2(const File& file, const Section& elements, const Wants& wants, Mesh& mesh, Pace& pace);
Result<void> read_elements_4(const File& file, const Section& elements, const Wants& wants, Mesh& mesh, Pace& pace);

/// How many nodes and elements the file states; the highest number where it does not say.
struct Totals {
    std::uint64_t nodes = ~std::uint64_t{0}, elements = ~std::uint64_t{0};
};
Totals totals_of(const File& file);

/// What values of a section belong to.
enum class DataKind : std::uint8_t { node, element, element_node };

/// The header of a $NodeData, $ElementData or $ElementNodeData section, and where its values start.
struct DataSection {
    const Section* section = nullptr;
    DataKind kind = DataKind::node;
    std::string name;
    double time = 0;
    std::int32_t step = 0;
    std::int32_t components = 1;
    std::int32_t count = 0;
    std::int32_t partition = 0;
    std::size_t values = 0; ///< position in the section's body

    Association association() const { return kind == DataKind::element ? Association::cell : Association::point; }
};

/// The data sections of a file; those without a sound header are left out.
std::vector<DataSection> data_sections(const File& file, FileInfo& info);

/// Puts the values of a section at the positions of their nodes or elements; values that are not NaN there and differ are
/// counted in `replaced`.
Result<void> read_values(const DataSection& data, const NumberMap& numbers, Pace& pace, std::vector<double>& values,
                         std::uint64_t& replaced);

/// Adds what a $ElementNodeData section has.
Result<void> read_corner_values(const DataSection& data, const Mesh& mesh, Pace& pace, NodeMeans& means);

/// Numbers of an ascii section.
class TextSource {
public:
    static constexpr bool is_text = true;

    explicit TextSource(const Section& section, std::size_t from = 0, std::size_t = 0)
        : scanner_(section.body), start_(section.start) {
        scanner_.seek(from);
    }

    bool count_line(std::int64_t& value) { return scanner_.number(value); }
    bool integer(std::int32_t& value) { return scanner_.number(value); }
    bool number(std::int64_t& value) { return scanner_.number(value); }
    bool count(std::int64_t& value) { return scanner_.number(value); }
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
    explicit ByteSource(const Section& section, std::size_t from = 0, std::size_t number_bytes = 0)
        : reader_(section.body, section.form.swapped),
          start_(section.start),
          number_bytes_(number_bytes ? number_bytes : section.form.number_bytes),
          count_bytes_(section.form.count_bytes) {
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
    bool number(std::int64_t& value) { return read_of(number_bytes_, value); }
    bool count(std::int64_t& value) { return read_of(count_bytes_, value); }
    bool real(double& value) { return reader_.read(value); }
    bool at_end() { return TextScanner(reader_.rest()).at_end(); }

    std::size_t position() const { return start_ + reader_.position(); }
    std::string where() const;

    std::uint64_t records_left(std::size_t integers, std::size_t numbers, std::size_t reals) const {
        return reader_.left() / (4 * integers + number_bytes_ * numbers + 8 * reals);
    }

private:
    bool read_of(std::size_t bytes, std::int64_t& value) {
        if (bytes == 8) return reader_.read(value);
        std::int32_t narrow = 0;
        if (!reader_.read(narrow)) return false;
        value = narrow;
        return true;
    }

    ByteReader reader_;
    std::size_t start_;
    std::size_t number_bytes_, count_bytes_;
};

/// Calls `parse` with the source that fits the section: `parse(TextSource&)` or `parse(ByteSource&)`.
template <class Parse>
auto with_source(const Section& section, const Parse& parse) {
    if (section.form.binary) {
        ByteSource source(section);
        return parse(source);
    }
    TextSource source(section);
    return parse(source);
}

/// After the last record of a section: there must be no more, and $End... must follow.
template <class Source>
Result<void> finish_section(const Section& section, Source& source) {
    if (!source.at_end()) return broken(section, "holds more than it states, at " + source.where());
    if (!section.ended) return broken(section, "has no " + end_of(section.name) + ": the file is cut short");
    return {};
}

/// The first section of a name, which must be there.
Result<const Section*> first_section(const File& file, std::string_view name);

} // namespace isotet::io::gmsh
