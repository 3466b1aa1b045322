// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTH and VTHB: an index of images by level, whose boxes overlap.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <pugixml.hpp>

#include "io/amr/boxes_as_pieces.hpp"
#include "io/files/byte_source.hpp"
#include "io/files/escape.hpp"
#include "io/files/index_file.hpp"
#include "io/files/text_scanner.hpp"
#include "io/vtk_xml/document.hpp"
#include "io/vtk_xml/load.hpp"
#include "io/vtk_xml/read_vtk_xml.hpp"

namespace isotet::io {
namespace {

constexpr std::size_t max_levels = 64;
constexpr double in_cell = 1e-3; ///< of its length: how far an image may be from its box

/// The index: what levels and boxes it states, and the file of each box.
class AmrIndex {
public:
    AmrIndex(std::string path, const ReadOptions& options) : path_(std::move(path)), options_(options) {}

    Result<void> read(const Progress& progress) {
        const auto source = ByteSource::open(path_);
        if (!source) return source.error();
        const auto document = vtk_xml::open_document(*source, progress);
        if (!document) return broken(path_, document.error().message);
        const pugi::xml_node root = document->primary();
        const std::string_view axes = root.attribute("grid_description").as_string("XYZ");
        if (axes != "XYZ")
            return broken(path_, fmt::format("its boxes are {}, but must be of three dimensions: grid_description XYZ",
                                             in_quotes(axes)));
        if (auto done = read_numbers(root, "origin", hierarchy.origin); !done) return done;
        for (const auto& element : root.children("Block"))
            if (auto done = add_level(element); !done) return done;
        if (files.empty()) return broken(path_, "the index names no files");
        return {};
    }

    amr::Hierarchy hierarchy;
    std::vector<vtk_xml::File> files; ///< level by level

private:
    template <class Numbers>
    Result<void> read_numbers(const pugi::xml_node& element, const char* attribute, Numbers& numbers) const {
        const char* const text = element.attribute(attribute).value();
        TextScanner scanner(text);
        for (auto& number : numbers)
            if (!scanner.number(number))
                return broken(path_, fmt::format("{} of an element {} is {}, not {} numbers", attribute, element.name(),
                                                 in_quotes(text), numbers.size()));
        return {};
    }

    Result<void> add_level(const pugi::xml_node& element) {
        const std::size_t number = hierarchy.levels.size();
        if (element.attribute("level").as_ullong(number) != number || number == max_levels)
            return broken(path_, fmt::format("level {} stands where level {} should: they go from 0 upward, {} at most",
                                             in_quotes(element.attribute("level").value()), number, max_levels));
        amr::Level& level = hierarchy.levels.emplace_back();
        if (auto done = read_numbers(element, "spacing", level.spacing); !done) return done;
        for (const auto& data : element.children("DataSet")) {
            std::array<std::int32_t, 6> box{};
            if (auto done = read_numbers(data, "amr_box", box); !done) return done;
            level.boxes.push_back({{box[0], box[2], box[4]}, {box[1], box[3], box[5]}});
            const std::string_view name = data.attribute("file").value();
            if (!name.ends_with(".vti"))
                return broken(path_, fmt::format("box {} of level {} names the file {}, but must name a .vti",
                                                 level.boxes.size() - 1, number, in_quotes(name)));
            auto path = named_file(path_, std::string(name), options_.allow_outside);
            if (!path) return path.error();
            files.push_back({std::move(*path), "ImageData", Depth::arrays});
        }
        return {};
    }

    std::string path_;
    const ReadOptions& options_;
};

/// An image has the points of its box.
Result<void> check_image(const amr::Hierarchy& hierarchy, const amr::Level& level, const amr::CellBox& box,
                         const Piece& piece) {
    const auto size = [](std::int64_t first, std::int64_t last) {
        return static_cast<std::uint64_t>(last - first) + 1;
    };
    const Array& points = piece.grid.points;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::uint64_t found = piece.extent ? size((*piece.extent)[2 * axis], (*piece.extent)[2 * axis + 1]) : 0;
        if (found != box.cells(axis) + 1)
            return broken(piece.name,
                          fmt::format("the image has {} points along {}, but its box has {} cells: one more "
                                      "point must be there",
                                      found, "xyz"[axis], box.cells(axis)));
        const double lower = hierarchy.origin[axis] + level.spacing[axis] * static_cast<double>(box.first[axis]);
        const double upper = hierarchy.origin[axis] + level.spacing[axis] * static_cast<double>(box.last[axis] + 1);
        const double first = points.at(0, axis), last = points.at(points.tuples() - 1, axis);
        const double most = in_cell * level.spacing[axis];
        if (!(std::abs(first - lower) <= most && std::abs(last - upper) <= most))
            return broken(piece.name, fmt::format("the image goes from {} to {} along {}, but its box from {} to {}",
                                                  first, last, "xyz"[axis], lower, upper));
    }
    return {};
}

Result<void> check_images(const amr::Hierarchy& hierarchy, const std::vector<Piece>& pieces) {
    std::size_t number = 0;
    for (const amr::Level& level : hierarchy.levels)
        for (const amr::CellBox& box : level.boxes)
            if (auto sound = check_image(hierarchy, level, box, pieces[number++]); !sound) return sound;
    return {};
}

} // namespace

Result<Loaded> load_amr(const std::string& path, const ReadOptions& options, Depth depth, const Progress& progress) {
    AmrIndex index(path, options);
    if (auto read = index.read(progress); !read) return read.error();
    if (const auto sound = amr::Lattice::make(index.hierarchy); !sound) return in_file(path, sound.error());
    for (vtk_xml::File& file : index.files) file.depth = depth;
    auto parts = vtk_xml::load_files(index.files, amr::options_of_boxes(options), progress);
    if (!parts) return parts.error();
    const std::vector<double> times = parts->front().info.times;
    for (Loaded& part : *parts) part.notes.clear(); // of each image alone
    Loaded loaded = vtk_xml::put_together(std::move(*parts));
    loaded.info.times = times;
    for (vtk_xml::File& file : index.files) loaded.info.files.push_back(std::move(file.path));
    amr::announce_point_values(loaded.info);
    if (depth == Depth::description) return loaded;
    if (auto sound = check_images(index.hierarchy, loaded.pieces); !sound) return sound.error();
    if (auto done = amr::boxes_as_pieces(index.hierarchy, options, loaded, progress); !done)
        return in_file(path, done.error());
    return loaded;
}

} // namespace isotet::io
