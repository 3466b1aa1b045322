// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/exodus/exodus_cells.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/parallel.hpp"
#include "grid/fixed_corners.hpp"
#include "io/files/escape.hpp"
#include "io/files/first_error.hpp"
#include "io/pieces/cell_places.hpp"
#include "io/pieces/loaded.hpp"
#include "io/pieces/join/shared_faces.hpp"

namespace isotet::io::confined {
namespace {

/// All blocks hold cells of one of isotet's types: types and offsets need not be stored.
bool is_uniform(const std::vector<ExodusFile::Block>& blocks, std::uint8_t& type) {
    type = 0;
    for (const auto& block : blocks) {
        if (block.cells == 0) continue;
        const std::uint8_t here = exodus_element(block.topology, block.corners).type;
        if (here < 10 || here > 14 || (type != 0 && here != type)) return false;
        type = here;
    }
    return type != 0;
}

/// For each node in VTK's order its position in Exodus's; empty: the same. Upright edges come before those of the top, and
/// the hexahedron's centre before its faces.
std::span<const std::uint8_t> node_order(std::uint8_t type) {
    static constexpr std::array<std::uint8_t, 27> hexahedron{0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 16, 17,
                                                             18, 19, 12, 13, 14, 15, 23, 24, 25, 26, 21, 22, 20};
    static constexpr std::array<std::uint8_t, 18> wedge{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11, 15, 16, 17};
    switch (type) {
    case 25: return std::span(hexahedron).first(20);
    case 29: return hexahedron;
    case 26: return std::span(wedge).first(15);
    case 32: return wedge;
    default: return {};
    }
}

/// Node numbers of the file, from 1, to point numbers from 0, appended; of each element those that are read.
Result<void> append_corners(const std::vector<std::int64_t>& nodes, const ExodusFile::Block& block,
                            std::uint64_t points, std::vector<std::int64_t>& connectivity) {
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i] < 1 || static_cast<std::uint64_t>(nodes[i]) > points)
            return Error{ErrorCode::invalid_data,
                         fmt::format("element {} of block {} has node {}, but the nodes are 1 to {}", i / block.corners,
                                     block.id, nodes[i], points)};
    const ExodusElement element = exodus_element(block.topology, block.corners);
    const auto order = node_order(element.type);
    for (std::size_t first = 0; first + block.corners <= nodes.size() && block.corners > 0; first += block.corners)
        for (std::size_t i = 0; i < element.nodes; ++i)
            connectivity.push_back(nodes[first + (order.empty() ? i : order[i])] - 1);
    return {};
}

/// Numbers of the file, from 1 to `most`, become numbers from 0.
Result<void> count_from_0(std::vector<std::int64_t>& numbers, std::uint64_t most, const std::string& owner,
                          const char* what) {
    for (std::int64_t& number : numbers) {
        if (number < 1 || static_cast<std::uint64_t>(number) > most)
            return Error{ErrorCode::invalid_data,
                         fmt::format("{} has {} {}, but the {}s are 1 to {}", owner, what, number, what, most)};
        --number;
    }
    return {};
}

void append_offsets(const std::vector<int>& counts, std::vector<std::int64_t>& offsets) {
    for (const int count : counts) offsets.push_back(offsets.back() + count);
}

/// Gives polyhedra their faces, and the points of these.
Result<void> read_faces(ExodusFile& file, Cells& cells) {
    auto faces = file.faces();
    if (!faces) return faces.error();
    const std::uint64_t face_count = faces->counts.size();
    if (auto fits = count_from_0(faces->numbers, file.points(), "a face", "node"); !fits) return fits;
    std::vector<std::int64_t> face_offsets{0}, of_cells, cell_offsets{0};
    append_offsets(faces->counts, face_offsets);
    for (const auto& block : file.blocks()) {
        if (!block.has_faces()) {
            cell_offsets.insert(cell_offsets.end(), block.cells, cell_offsets.back());
            continue;
        }
        auto own = file.faces_of(block);
        if (!own) return own.error();
        if (auto fits = count_from_0(own->numbers, face_count, fmt::format("an element of block {}", block.id), "face");
            !fits)
            return fits;
        append_offsets(own->counts, cell_offsets);
        of_cells.insert(of_cells.end(), own->numbers.begin(), own->numbers.end());
    }
    const SharedFaces shared{Array::own(std::move(faces->numbers)), Array::own(std::move(face_offsets)),
                             Array::own(std::move(of_cells)), Array::own(std::move(cell_offsets))};
    if (auto done = write_out_faces(shared, cells); !done) return done;
    return list_points_of_faces(file.points(), cells);
}

Result<Cells> read_all(ExodusFile& file) {
    Cells cells;
    std::uint8_t uniform_type = 0;
    const bool uniform = is_uniform(file.blocks(), uniform_type);
    std::uint64_t corner_count = 0;
    for (const auto& block : file.blocks())
        corner_count += block.cells * exodus_element(block.topology, block.corners).nodes;
    std::vector<std::int64_t> connectivity, offsets;
    std::vector<std::uint8_t> types;
    connectivity.reserve(corner_count);
    if (!uniform) offsets.push_back(0);
    for (const auto& block : file.blocks()) {
        const ExodusElement element = exodus_element(block.topology, block.corners);
        if (element.nodes > 0) {
            auto nodes = file.connectivity(block);
            if (!nodes) return nodes.error();
            if (auto appended = append_corners(*nodes, block, file.points(), connectivity); !appended)
                return appended.error();
        }
        if (uniform) continue;
        types.insert(types.end(), block.cells, element.type);
        for (std::uint64_t i = 0; i < block.cells; ++i)
            offsets.push_back(offsets.back() + static_cast<std::int64_t>(element.nodes));
    }
    cells.connectivity = Array::own(std::move(connectivity));
    if (uniform) cells.uniform_type = static_cast<CellType>(uniform_type);
    else {
        cells.offsets = Array::own(std::move(offsets));
        cells.types = Array::own(std::move(types));
    }
    if (std::ranges::any_of(file.blocks(), &ExodusFile::Block::has_faces))
        if (auto read = read_faces(file, cells); !read) return read.error();
    return cells;
}

/// Some cells of a block.
struct ExodusStretch {
    std::size_t block = 0;
    std::uint64_t first_corner = 0; ///< of the first one, among the corners of all blocks
    std::uint64_t first = 0, count = 0;
};

std::vector<ExodusStretch> stretches_of(const std::vector<ExodusFile::Block>& blocks) {
    constexpr std::uint64_t at_once = std::uint64_t{1} << 14;
    std::vector<ExodusStretch> all;
    std::uint64_t corner = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i)
        for (std::uint64_t first = 0; first < blocks[i].cells; first += at_once) {
            all.push_back({i, corner, first, std::min(at_once, blocks[i].cells - first)});
            corner += all.back().count * blocks[i].corners;
        }
    return all;
}

/// Counted from 0; of 0 and less no point's number comes.
std::vector<std::int64_t> points_of_nodes(const Array& nodes) {
    std::vector<std::int64_t> points;
    points.reserve(nodes.size());
    nodes.visit([&]<class T>(std::span<const T> values) {
        if constexpr (std::is_integral_v<T>)
            for (const T node : values)
                points.push_back(static_cast<std::int64_t>(static_cast<std::uint64_t>(node) - 1));
    });
    return points;
}

class ExodusCells final : public CellSource {
public:
    ExodusCells(CellPlaces places, Array types, std::shared_ptr<ExodusFile> file, std::string path)
        : CellSource(std::move(places), std::move(types)), file_(std::move(file)), path_(std::move(path)) {}

    Result<void> each_block(const Visit& visit) const override {
        const auto& blocks = file_->blocks();
        const std::vector<ExodusStretch> stretches = stretches_of(blocks);
        FirstError failed;
        core::parallel_each(stretches.size(), 1, [&](std::size_t i) {
            if (failed) return;
            const ExodusStretch& stretch = stretches[i];
            const auto nodes = file_->nodes(blocks[stretch.block], stretch.first, stretch.count);
            if (!nodes) return failed.add(i, nodes.error());
            visit(stretch.first_corner, Array::own(points_of_nodes(*nodes)));
        });
        return failed.result();
    }
    Result<Cells> read() const override { return read_exodus_cells(*file_, path_); }

private:
    std::shared_ptr<ExodusFile> file_;
    std::string path_;
};

} // namespace

Result<Cells> read_exodus_cells(ExodusFile& file, const std::string& path) {
    auto cells = read_all(file);
    if (cells || cells.error().message.starts_with(escaped(path))) return cells; // what the library says names the file
    return broken(path, cells.error().message);
}

std::shared_ptr<const CellSource> unread_exodus_cells(const std::shared_ptr<ExodusFile>& file,
                                                      const std::string& path) {
    std::vector<std::uint8_t> list;
    for (const ExodusFile::Block& block : file->blocks()) {
        if (block.cells == 0) continue;
        const ExodusElement element = exodus_element(block.topology, block.corners);
        const auto none = file->nodes(block, 0, 0);
        const bool fits = none && (none->type() == ScalarType::int32 || none->type() == ScalarType::int64);
        if (!fits || element.nodes != block.corners || core::fixed_corners_of(element.type) != block.corners)
            return nullptr;
        list.insert(list.end(), block.cells, element.type);
    }
    if (list.empty()) return nullptr;
    Array types = Array::own(std::move(list));
    auto places = CellPlaces::make(types.as<std::uint8_t>());
    if (!places) return nullptr;
    if (places->are_uniform()) types = Array();
    return std::make_shared<const ExodusCells>(*std::move(places), std::move(types), file, path);
}

} // namespace isotet::io::confined
