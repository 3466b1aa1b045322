// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/gocad/read_gocad.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/parallel.hpp"
#include "io/files/pace.hpp"
#include "io/files/text_scanner.hpp"
#include "io/pieces/loaded.hpp"
#include "io/pieces/number_map.hpp"
#include "io/reader.hpp"

namespace isotet::io {

namespace {

constexpr std::string_view volume_name = "tvolume";

/// A property of points or cells.
struct Property {
    std::string name;
    std::size_t components = 1;
    double no_data = std::numeric_limits<double>::quiet_NaN(); ///< NaN: there is none
    bool wanted = true;
    std::vector<double> values;
};

class Solid {
public:
    Solid(std::string_view text, const ReadOptions& options, const Progress& progress)
        : options_(options), progress_(progress), text_(text), scanner_(text, '#'), pace_(progress, text.size()) {}

    /// Reads up to the first point: the names of everything.
    Result<void> read_header() {
        if (scanner_.word() != "GOCAD" || scanner_.word_of_line() != "TSolid") {
            return Error{ErrorCode::invalid_data,
                         "does not begin with GOCAD TSolid, but " + in_quotes(text_.substr(0, 30))};
        }
        for (scanner_.next_line(); !scanner_.at_end(); scanner_.next_line()) {
            const std::size_t start = scanner_.position();
            const std::string_view keyword = scanner_.word();
            if (is_content(keyword)) {
                scanner_.seek(start);
                break;
            }
            if (auto read = read_header_line(keyword); !read) return read;
        }
        for (auto* properties : {&point_properties_, &cell_properties_}) {
            const auto association = properties == &point_properties_ ? Association::point : Association::cell;
            std::size_t components = 0;
            for (Property& property : *properties) {
                property.wanted = io::wanted(options_, association, property.name);
                components += property.components;
            }
            if (components > max_components) {
                return broken("PROPERTIES", fmt::format("have {} components, but isotet takes {} at most", components,
                                                        max_components));
            }
        }
        wants_volumes_ = io::wanted(options_, Association::cell, volume_name);
        return {};
    }

    FileInfo info() const {
        FileInfo info;
        info.format = "gocad";
        for (const Property& property : point_properties_) {
            info.fields.push_back({property.name, Association::point, ScalarType::float64, property.components});
        }
        for (const Property& property : cell_properties_) {
            info.fields.push_back({property.name, Association::cell, ScalarType::float64, property.components});
        }
        info.fields.push_back({std::string(volume_name), Association::cell, ScalarType::int32, 1});
        const std::vector<std::string> volumes = names_of_volumes();
        for (std::size_t i = 0; i < volumes.size() && volumes.size() > 1; ++i)
            info.regions.push_back({std::string(volume_name), static_cast<int>(i), volumes[i]});
        return info;
    }

    /// Reads points and tets; after read_header().
    Result<void> read_content() {
        bool ended = false;
        std::string_view last;
        for (; !ended && !scanner_.at_end(); scanner_.next_line()) {
            const std::string_view keyword = scanner_.word();
            Result<void> read;
            if (keyword == "TETRA") read = read_tetra();
            else if (keyword == "VRTX") read = read_vertex(false);
            else if (keyword == "PVRTX") read = read_vertex(true);
            else if (keyword == "ATOM") read = read_atom(false);
            else if (keyword == "PATOM") read = read_atom(true);
            else if (keyword == "TVOLUME") volumes_.emplace_back(scanner_.word_of_line());
            else if (keyword == "END") ended = true;
            else if (!keyword.empty()) note_unread(keyword);
            if (!read) return read;
            if (!pace_.goes_on(scanner_.position())) return Pace::cancelled();
            if (!keyword.empty()) last = keyword;
        }
        without_end_ = !ended && last == "TETRA" && text_.ends_with('\n');
        if (!ended && !without_end_) return Error{ErrorCode::invalid_data, "has no END: the file is cut short"};
        if (points_.empty()) return Error{ErrorCode::invalid_data, "has no vertices before END"};
        another_ =
            text_.find("\nGOCAD ", scanner_.position() == 0 ? 0 : scanner_.position() - 1) != std::string_view::npos;
        return {};
    }

    /// The grid, after read_content().
    Result<void> finish(ReadResult& result) {
        if (const auto closed = numbers_.close("vertex"); !closed) return closed.error();
        if (auto resolved = resolve_atoms(); !resolved) return resolved;
        if (auto resolved = resolve_corners(); !resolved) return resolved;
        Grid& grid = result.grid;
        grid.points = Array::own(std::move(points_), 3);
        grid.cells.connectivity = Array::own(std::move(corners_));
        give(point_properties_, grid.point_fields);
        give(cell_properties_, grid.cell_fields);
        if (wants_volumes_)
            grid.cell_fields.push_back({std::string(volume_name), Array::own(std::move(volume_of_tet_))});
        add_notes(result.notes);
        tell_unread(result.info);
        return {};
    }

private:
    /// What follows TVOLUME at the beginning of lines, until END. No other line is looked at.
    std::vector<std::string> names_of_volumes() const {
        constexpr std::string_view blanks = " \t", keyword = "TVOLUME";
        const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
        std::size_t end = text_.find("\nEND");
        while (end != std::string_view::npos && end + 4 < text_.size() && !is_blank(text_[end + 4]))
            end = text_.find("\nEND", end + 4);
        const std::string_view object = text_.substr(0, end);
        std::vector<std::string> names;
        for (std::size_t at = 0; (at = object.find(keyword, at)) != std::string_view::npos;) {
            const std::string_view before =
                object.substr(0, object.find_last_not_of(blanks, at - (at > 0 ? 1 : 0)) + 1);
            at += keyword.size();
            if (!before.ends_with('\n') || at >= object.size() || !is_blank(object[at])) continue;
            const std::string_view line = object.substr(at, object.find('\n', at) - at);
            names.emplace_back(name_of_line(line));
        }
        return names;
    }

    /// All of the line, blanks between words included, or what stands between quotation marks.
    static std::string_view name_of_line(std::string_view line) {
        const std::string_view name = without_blanks(line);
        return name.starts_with('"') ? name.substr(1, name.find('"', 1) - 1) : name;
    }

    static bool is_content(std::string_view keyword) {
        constexpr std::string_view keywords[] = {"TVOLUME", "VRTX", "PVRTX", "ATOM", "PATOM", "TETRA", "END"};
        return std::find(std::begin(keywords), std::end(keywords), keyword) != std::end(keywords);
    }

    Error broken(std::string_view keyword, const std::string& message) const {
        return {ErrorCode::invalid_data, fmt::format("{}: {}", keyword, message)};
    }

    Result<void> read_header_line(std::string_view keyword) {
        const bool of_cells = keyword.starts_with("TETRA_");
        auto& properties = of_cells ? cell_properties_ : point_properties_;
        const std::string_view what = of_cells ? keyword.substr(6) : keyword;
        if (what == "ZPOSITIVE") {
            const std::string_view word = scanner_.word_of_line();
            depth_ = word == "Depth";
            if (!depth_ && word != "Elevation" && word != "Upward") {
                return broken(keyword, fmt::format("is {}, but Elevation or Depth is the rule", in_quotes(word)));
            }
        } else if (what == "PROPERTIES") {
            properties.clear();
            while (!scanner_.at_line_end())
                properties.push_back({std::string(scanner_.quoted_of_line()), 1, no_value, true, {}});
        } else if (what == "ESIZES") {
            for (Property& property : properties) {
                if (!scanner_.number_of_line(property.components) || property.components < 1 ||
                    property.components > max_components) {
                    return broken(keyword, fmt::format("has no size from 1 to {} for {}, at {}", max_components,
                                                       in_quotes(property.name), scanner_.where()));
                }
            }
        } else if (what == "NO_DATA_VALUES") {
            for (Property& property : properties) {
                // Words that are no numbers ("**none**") stand where there is no such value.
                const std::string_view word = scanner_.word_of_line();
                if (!parse_number(word, property.no_data)) property.no_data = no_value;
            }
        }
        return {};
    }

    bool read_properties(std::vector<Property>& properties) {
        for (Property& property : properties) {
            for (std::size_t c = 0; c < property.components; ++c) {
                double value = 0;
                if (!scanner_.number_of_line(value)) return false;
                if (property.wanted) property.values.push_back(value == property.no_data ? no_value : value);
            }
        }
        return true;
    }

    Error broken_line(const char* keyword) const {
        return broken(keyword, "has a broken line, at " + scanner_.where());
    }

    Result<void> read_vertex(bool with_properties) {
        std::int64_t number = 0;
        double x = 0, y = 0, z = 0;
        const char* keyword = with_properties ? "PVRTX" : "VRTX";
        if (!scanner_.number_of_line(number) || !scanner_.number_of_line(x) || !scanner_.number_of_line(y) ||
            !scanner_.number_of_line(z)) {
            return broken_line(keyword);
        }
        numbers_.add(number);
        if (!atoms_.empty()) point_of_vertex_.push_back(points_.size() / 3);
        points_.insert(points_.end(), {x, y, depth_ ? -z : z});
        if (with_properties) return read_properties(point_properties_) ? Result<void>() : broken_line(keyword);
        for (Property& property : point_properties_) {
            if (property.wanted) property.values.insert(property.values.end(), property.components, no_value);
        }
        return {};
    }

    /// An atom takes a vertex number, but no place among the points.
    Result<void> read_atom(bool with_properties) {
        const char* keyword = with_properties ? "PATOM" : "ATOM";
        Atom atom{numbers_.size(), 0, 0, with_properties};
        std::int64_t number = 0;
        if (!scanner_.number_of_line(number) || !scanner_.number_of_line(atom.refers_to)) return broken_line(keyword);
        if (atoms_.empty()) {
            for (std::uint64_t i = 0; i < numbers_.size(); ++i) point_of_vertex_.push_back(i);
        }
        atom.number = number;
        numbers_.add(number);
        point_of_vertex_.push_back(unresolved);
        atoms_.push_back(atom);
        if (!with_properties) return {};
        for (const Property& property : point_properties_) {
            for (std::size_t c = 0; c < property.components; ++c) {
                double value = 0;
                if (!scanner_.number_of_line(value)) return broken_line(keyword);
                if (property.wanted) atom_values_.push_back(value == property.no_data ? no_value : value);
            }
        }
        return {};
    }

    Result<void> read_tetra() {
        for (int k = 0; k < 4; ++k) {
            std::int64_t number = 0;
            if (!scanner_.number_of_line(number)) return broken_line("TETRA");
            if (number < 0 || number > std::numeric_limits<std::uint32_t>::max()) {
                return broken("TETRA",
                              fmt::format("has vertex {}, but isotet takes numbers from 0 to 2^32 - 1", number));
            }
            corners_.push_back(static_cast<std::uint32_t>(number));
        }
        if (wants_volumes_)
            volume_of_tet_.push_back(volumes_.empty() ? 0 : static_cast<std::int32_t>(volumes_.size() - 1));
        return read_properties(cell_properties_) ? Result<void>() : broken_line("TETRA");
    }

    /// An atom may refer to an atom; a chain of them ends at a vertex.
    Result<void> resolve_atoms() {
        std::vector<std::uint64_t> chain;
        for (const Atom& atom : atoms_) {
            chain.clear();
            std::uint64_t vertex = atom.vertex;
            while (vertex != NumberMap::none && point_of_vertex_[vertex] == unresolved &&
                   chain.size() <= atoms_.size()) {
                chain.push_back(vertex);
                vertex = numbers_.find(atom_at(vertex).refers_to);
            }
            if (vertex == NumberMap::none || point_of_vertex_[vertex] == unresolved) {
                return broken("ATOM",
                              fmt::format("{} refers to {}, which leads to no vertex", atom.number, atom.refers_to));
            }
            for (const std::uint64_t link : chain) point_of_vertex_[link] = point_of_vertex_[vertex];
        }
        count_dropped_values();
        return {};
    }

    /// Values of atoms that differ from those of their points.
    void count_dropped_values() {
        const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
        auto of_atom = atom_values_.cbegin();
        for (const Atom& atom : atoms_) {
            if (!atom.has_properties) continue;
            for (const Property& property : point_properties_) {
                if (!property.wanted) continue;
                const auto size = static_cast<std::ptrdiff_t>(property.components);
                const auto of_point =
                    property.values.cbegin() + static_cast<std::ptrdiff_t>(point_of_vertex_[atom.vertex]) * size;
                if (!std::equal(of_point, of_point + size, of_atom, same)) ++dropped_;
                of_atom += size;
            }
        }
    }

    struct Atom {
        std::uint64_t vertex; ///< its place among vertices and atoms
        std::int64_t refers_to;
        std::int64_t number;
        bool has_properties;
    };
    const Atom& atom_at(std::uint64_t vertex) const {
        return *std::lower_bound(atoms_.begin(), atoms_.end(), vertex,
                                 [](const Atom& atom, std::uint64_t place) { return atom.vertex < place; });
    }

    /// Replaces the file's vertex numbers by point numbers, in place.
    Result<void> resolve_corners() {
        constexpr std::size_t piece = std::size_t{1} << 22U;
        for (std::size_t begin = 0; begin < corners_.size(); begin += piece) {
            if (progress_.cancelled()) return Pace::cancelled();
            const std::size_t end = std::min(begin + piece, corners_.size());
            std::atomic<std::size_t> lowest{end};
            core::parallel_ranges(end - begin, std::size_t{1} << 16U, [&](std::size_t first, std::size_t last) {
                for (std::size_t i = begin + first; i < begin + last; ++i) {
                    const std::uint64_t vertex = numbers_.find(corners_[i]);
                    if (vertex == NumberMap::none) {
                        std::size_t seen = lowest.load();
                        while (i < seen && !lowest.compare_exchange_weak(seen, i)) {}
                        return;
                    }
                    corners_[i] = static_cast<std::uint32_t>(atoms_.empty() ? vertex : point_of_vertex_[vertex]);
                }
            });
            if (const std::size_t bad = lowest.load(); bad != end) {
                return broken("TETRA", fmt::format("number {} (from 1) has vertex {}, which is not in the file",
                                                   bad / 4 + 1, corners_[bad]));
            }
        }
        return {};
    }

    static void give(std::vector<Property>& properties, std::vector<Field>& fields) {
        for (Property& property : properties) {
            if (property.wanted)
                fields.push_back({property.name, Array::own(std::move(property.values), property.components)});
        }
    }

    /// Lines among points and tets with a keyword that is not read; of many keywords the first.
    void note_unread(std::string_view keyword) {
        constexpr std::size_t most = 16;
        if (std::ranges::find(unread_, keyword) != unread_.end()) return;
        if (unread_.size() < most) unread_.push_back(keyword);
        else ++unread_others_;
    }

    void tell_unread(FileInfo& info) const {
        constexpr std::string_view of_surfaces[] = {"MODEL",        "SURFACE",     "TFACE",  "TRGL",
                                                    "MODEL_REGION", "KEYVERTICES", "BSTONE", "BORDER"};
        for (const std::string_view keyword : unread_) {
            const bool known = std::ranges::find(of_surfaces, keyword) != std::end(of_surfaces);
            leave_out(info, {"line", std::string(keyword.substr(0, 40)),
                             known ? "surfaces between volumes are not read" : "the keyword is not known"});
        }
        if (unread_others_ > 0)
            leave_out(info, {"line", "others", fmt::format("{} lines have more unknown keywords", unread_others_)});
    }

    void add_notes(std::vector<std::string>& notes) const {
        if (depth_)
            notes.emplace_back("z is depth in the file (ZPOSITIVE Depth): its sign is changed, so that up is positive");
        if (!atoms_.empty()) notes.push_back(fmt::format("{} atoms are the points that they refer to", atoms_.size()));
        if (dropped_ > 0) {
            notes.push_back(
                fmt::format("properties of atoms that differ from those of their points are dropped: {}", dropped_));
        }
        if (without_end_)
            notes.emplace_back("the file has no END: if it was cut short behind a line, tetrahedra are missing");
        if (another_) notes.emplace_back("the file holds more than one Gocad object: the first is read");
    }

    static constexpr std::size_t max_components = 1000; ///< of all properties together
    static constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
    static constexpr std::uint64_t unresolved = NumberMap::none;

    const ReadOptions& options_;
    const Progress& progress_;
    std::string_view text_;
    TextScanner scanner_;
    Pace pace_;
    bool depth_ = false;
    bool wants_volumes_ = true;
    bool another_ = false, without_end_ = false;
    std::vector<Property> point_properties_, cell_properties_;
    NumberMap numbers_;                          ///< of vertices and atoms
    std::vector<std::uint64_t> point_of_vertex_; ///< empty as long as there are no atoms
    std::vector<Atom> atoms_;
    std::vector<double> atom_values_;
    std::size_t dropped_ = 0;
    std::vector<std::string_view> unread_; ///< keywords
    std::size_t unread_others_ = 0;
    std::vector<double> points_;
    std::vector<std::uint32_t> corners_; ///< the file's numbers, then point numbers
    std::vector<std::int32_t> volume_of_tet_;
    std::vector<std::string_view> volumes_;
};

} // namespace

Result<FileInfo> inspect_gocad(std::string_view text, const Progress& progress) {
    const ReadOptions options;
    Solid solid(text, options, progress);
    if (const auto read = solid.read_header(); !read) return read.error();
    return solid.info();
}

Result<ReadResult> parse_gocad(std::string_view text, const ReadOptions& options, const Progress& progress) {
    Solid solid(text, options, progress);
    if (const auto read = solid.read_header(); !read) return read.error();
    ReadResult result;
    result.info = solid.info();
    if (const auto step = choose_step(result.info, options); !step) return step.error();
    if (const auto read = solid.read_content(); !read) return read.error();
    if (const auto finished = solid.finish(result); !finished) return finished.error();
    return result;
}

} // namespace isotet::io
