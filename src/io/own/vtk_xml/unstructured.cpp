// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells whose types and offsets say nothing (all of one kind, one after another) get neither: they are only looked at,
// block by block.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <limits>

#include <fmt/core.h>

#include "core/cell_faces.hpp"
#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "io/own/active_filter.hpp"
#include "io/own/face_streams.hpp"
#include "io/own/shared_faces.hpp"
#include "io/own/narrow_indices.hpp"
#include "io/own/old_hexahedra.hpp"
#include "io/own/surface_scalars.hpp"
#include "io/own/text_scanner.hpp"
#include "io/own/vtk_xml/load.hpp"

namespace isotet::io::vtk_xml {
namespace {

constexpr std::size_t grain = std::size_t{1} << 16;

std::optional<std::uint64_t> corners_of_uniform(std::uint8_t type) {
    constexpr std::uint64_t corners[] = {4, 8, 8, 6, 5}; // tetrahedron, voxel, hexahedron, wedge, pyramid
    if (type < 10 || type > 14) return std::nullopt;
    return corners[type - 10];
}

/// Calls test(first index, values) on pieces of an array, in parallel; true if all say true.
template <class Test>
bool all_pieces(const Array& array, const Test& test) {
    std::atomic<bool> all = true;
    array.visit([&](auto values) {
        core::parallel_ranges(values.size(), grain, [&](std::size_t begin, std::size_t end) {
            if (all && !test(std::uint64_t{begin}, values.subspan(begin, end - begin))) all = false;
        });
    });
    return all;
}

/// True if offsets[i] is (first + i + 1) * corners for all of them.
template <class Offsets>
bool are_regular(std::uint64_t first, Offsets offsets, std::uint64_t corners) {
    std::uint64_t wrong = 0;
    for (std::size_t i = 0; i < offsets.size(); ++i)
        wrong |= static_cast<std::uint64_t>(offsets[i]) ^ ((first + i + 1) * corners);
    return wrong == 0;
}

bool are_uniform(const Array& types) {
    const std::uint8_t first = types.as<std::uint8_t>().front();
    return all_pieces(types, [&](std::uint64_t, auto values) {
        return std::ranges::all_of(values, [&](auto type) { return type == first; });
    });
}

template <class To>
Array converted(const Array& array) {
    core::Buffer<To> values(array.size());
    array.visit([&](auto from) {
        core::parallel_each(from.size(), grain, [&](std::size_t i) { values[i] = static_cast<To>(from[i]); });
    });
    return std::move(values).to_array();
}

/// Reads the arrays of the Cells element of one piece.
class CellsReader {
public:
    CellsReader(Document& document, const pugi::xml_node& piece, std::uint64_t count, std::size_t step,
                const Progress& progress)
        : document_(document), piece_(piece), count_(count), step_(step), progress_(progress) {}

    /// Where that can be done, read() keeps active cells only. `grid`: all but the cells
    void ask_for_active_cells(const Grid& grid, const ReadOptions& options) {
        grid_ = &grid;
        options_ = &options;
    }
    bool kept_active_cells() const { return kept_active_; }

    /// Offsets and types are empty where all cells are of one kind, one after another.
    Result<Cells> read() {
        Cells cells;
        if (count_ == 0) return cells;
        auto section = describe_section(document_, piece_.child("Cells"), step_);
        if (!section) return section.error();
        section_ = std::move(*section);
        const auto size = read_types_and_offsets(cells);
        if (!size) return size.error();
        const auto stored = find_stored("connectivity", *size);
        if (!stored) return stored.error();
        if (grid_ && cells.offsets.empty()) {
            auto active = read_active(*stored, cells.uniform_type);
            if (!active) return active.error();
            kept_active_ = active->has_value();
            if (kept_active_) return **std::move(active);
        }
        auto connectivity = indices(*stored);
        if (!connectivity) return connectivity.error();
        cells.connectivity = std::move(*connectivity);
        if (auto read = read_faces(cells); !read) return read.error();
        if (is_of_vtk_8()) reorder_old_hexahedra(cells);
        return cells;
    }

private:
    /// Nothing where all cells are needed.
    Result<std::optional<Cells>> read_active(const StoredArray& corners, CellType type) const {
        std::optional<Cells> cells;
        const ScalarType index = corners.array().type;
        if (size_of(index) < 4 || !corners.has_blocks()) return cells;
        auto filter = active_filter(*grid_, type, *options_);
        if (!filter) return cells;
        auto done = corners.each_block([&](std::uint64_t first, std::span<const std::byte> bytes) {
            filter->add(first, Array(index, bytes.data(), bytes.size() / size_of(index), 1, nullptr));
        });
        if (!done) return done.error();
        auto kept = filter->finish();
        if (kept) cells = *std::move(kept);
        else if (kept.error().code != ErrorCode::invalid_data) return kept.error();
        return cells; // what is broken is told when all cells are there
    }

    bool is_of_vtk_8() const {
        TextScanner version(document_.tree.child("VTKFile").attribute("version").as_string("2.1"));
        double number = 2.1;
        return version.number(number) && number < 2.1;
    }

    bool has(std::string_view name) const {
        return std::ranges::find(section_.arrays, name, &DataArray::name) != section_.arrays.end();
    }

    /// Of polyhedra, where there are some: VTK 9.4 stores each face once, older versions a stream of faces for each cell.
    Result<void> read_faces(Cells& cells) const {
        if (cells.types.empty()) return {};
        const auto types = cells.types.as<std::uint8_t>();
        if (std::ranges::find(types, core::polyhedron_type) == types.end()) return {};
        if (has("faces") && has("faceoffsets")) return read_face_streams(cells);
        if (has("face_connectivity") && has("polyhedron_to_faces")) return read_shared_faces(cells);
        return {};
    }

    Result<void> read_face_streams(Cells& cells) const {
        const auto ends = numbers("faceoffsets", count_);
        if (!ends) return ends.error();
        std::vector<std::int64_t> offsets{0}; // a cell without faces ends at -1 in the file
        offsets.reserve(ends->size() + 1);
        for (const std::int64_t end : *ends) offsets.push_back(end < 0 ? offsets.back() : end);
        if (!std::ranges::is_sorted(offsets)) return invalid_data("Cells 'faceoffsets' falls");
        auto faces = indices("faces", static_cast<std::uint64_t>(offsets.back()));
        if (!faces) return faces.error();
        cells.faces = std::move(*faces);
        cells.face_offsets = Array::own(std::move(offsets));
        return {};
    }

    Result<void> read_shared_faces(Cells& cells) const {
        const auto cell_ends = numbers("polyhedron_offsets", count_);
        if (!cell_ends) return cell_ends.error();
        auto faces = indices("polyhedron_to_faces", last_end(*cell_ends));
        if (!faces) return faces.error();
        const auto face_ends = numbers("face_offsets", faces_in(*faces));
        if (!face_ends) return face_ends.error();
        auto points = indices("face_connectivity", last_end(*face_ends));
        if (!points) return points.error();
        return write_out_faces({*std::move(points), offsets_of(*face_ends), *std::move(faces), offsets_of(*cell_ends)},
                               cells);
    }

    /// One more than the highest number of a face.
    static std::uint64_t faces_in(const Array& faces) {
        std::int64_t most = -1;
        faces.visit([&](auto values) {
            for (const auto face : values) most = std::max(most, static_cast<std::int64_t>(face));
        });
        return static_cast<std::uint64_t>(most + 1);
    }

    static Array offsets_of(const std::vector<std::int64_t>& ends) {
        std::vector<std::int64_t> offsets{0};
        offsets.insert(offsets.end(), ends.begin(), ends.end());
        return Array::own(std::move(offsets));
    }

    static std::uint64_t last_end(const std::vector<std::int64_t>& ends) {
        return ends.empty() || ends.back() < 0 ? 0 : static_cast<std::uint64_t>(ends.back());
    }

    Result<std::vector<std::int64_t>> numbers(const char* name, std::uint64_t size) const {
        std::vector<std::int64_t> out;
        if (size == 0) return out;
        const auto array = indices(name, size);
        if (!array) return array.error();
        array->visit([&](auto values) {
            out.reserve(values.size());
            for (const auto value : values) out.push_back(static_cast<std::int64_t>(value));
        });
        return out;
    }

    Result<DataArray> find(const char* name) const {
        const auto found = std::ranges::find(section_.arrays, name, &DataArray::name);
        if (found == section_.arrays.end())
            return invalid_data(fmt::format("Cells has no array {}, but there are {} cells", in_quotes(name), count_));
        if (found->components != 1 || is_floating(found->type))
            return invalid_data(fmt::format("Cells {} is {} with {} components, not integers with one", in_quotes(name),
                                            isotet::name_of(found->type), found->components));
        return *found;
    }

    Result<StoredArray> find_stored(const char* name, std::uint64_t size) const {
        const auto described = find(name);
        if (!described) return described.error();
        return StoredArray::find(document_, *described, size, progress_);
    }

    /// Returns how many corners there are. Neither types nor offsets become arrays where they say nothing.
    Result<std::uint64_t> read_types_and_offsets(Cells& cells) const {
        const auto types = find_stored("types", count_);
        if (!types) return types.error();
        const auto type = one_type(*types);
        if (!type) return type.error();
        if (!*type) // else they have been looked at
            if (auto read = read_types(*types, cells); !read) return read.error();
        const auto offsets = find_stored("offsets", count_);
        if (!offsets) return offsets.error();
        const auto corners = *type ? corners_of_uniform(**type) : std::nullopt;
        if (corners && offsets->has_blocks()) {
            const auto regular = are_regular_blocks(*offsets, *corners);
            if (!regular) return regular.error();
            if (*regular) {
                cells.uniform_type = static_cast<CellType>(**type);
                return count_ * *corners;
            }
        }
        if (*type)
            if (auto read = read_types(*types, cells); !read) return read.error();
        auto from_0 = offsets_from_0(*offsets);
        if (!from_0) return from_0.error();
        const auto last = last_of(*from_0);
        cells.offsets = std::move(*from_0);
        simplify(cells);
        return last;
    }

    /// The type of all cells, looked at block by block; nothing where there are several, or no such blocks.
    static Result<std::optional<std::uint8_t>> one_type(const StoredArray& stored) {
        if (stored.array().type != ScalarType::uint8 || !stored.has_blocks()) return std::optional<std::uint8_t>();
        constexpr int unknown = -1;
        std::atomic<int> first = unknown;
        std::atomic<bool> all = true;
        auto done = stored.each_block([&](std::uint64_t, std::span<const std::byte> types) {
            if (!all) return;
            const auto own = std::to_integer<int>(types.front());
            int expected = unknown;
            if (!first.compare_exchange_strong(expected, own) && expected != own) all = false;
            unsigned different = 0;
            for (const std::byte type : types) different |= std::to_integer<unsigned>(type ^ types.front());
            if (different != 0) all = false;
        });
        if (!done) return done.error();
        return all ? std::optional(static_cast<std::uint8_t>(first.load())) : std::nullopt;
    }

    static Result<void> read_types(const StoredArray& stored, Cells& cells) {
        auto types = filled_array(stored.array().type, static_cast<std::size_t>(stored.scalars()), 1,
                                  [&](std::byte* to) { return stored.decode(to); });
        if (!types) return types.error();
        if (types->type() != ScalarType::uint8) {
            const bool fits = all_pieces(*types, [](std::uint64_t, auto values) {
                return std::ranges::all_of(values, [](auto type) { return type >= 0 && type <= 255; });
            });
            if (!fits) return invalid_data("a cell type is not between 0 and 255");
            types = converted<std::uint8_t>(*types);
        }
        cells.types = std::move(*types);
        return {};
    }

    Result<bool> are_regular_blocks(const StoredArray& stored, std::uint64_t corners) const {
        std::atomic<bool> regular = true;
        auto done = stored.each_block([&](std::uint64_t first, std::span<const std::byte> bytes) {
            with_type(stored.array().type, [&](auto zero) {
                using Scalar = decltype(zero);
                const auto* const values = reinterpret_cast<const Scalar*>(bytes.data());
                if (!are_regular(first, std::span(values, bytes.size() / sizeof(Scalar)), corners)) regular = false;
            });
        });
        if (!done) return done.error();
        return regular.load();
    }

    /// As int32 where all values fit; nothing where that gains nothing, or where one does not fit.
    static Result<std::optional<Array>> narrowed(const StoredArray& stored, std::uint64_t size, std::size_t zeros) {
        if (!NarrowIndices::narrows(stored.array().type) || !stored.has_blocks()) return std::optional<Array>();
        NarrowIndices narrow(static_cast<std::size_t>(size) + zeros);
        constexpr std::int64_t zero_in_front = 0;
        for (std::size_t i = 0; i < zeros; ++i) narrow.add(i, std::span(&zero_in_front, 1));
        auto done = stored.each_block([&](std::uint64_t first, std::span<const std::byte> bytes) {
            with_type(stored.array().type, [&](auto zero) {
                using Scalar = decltype(zero);
                const auto* const values = reinterpret_cast<const Scalar*>(bytes.data());
                narrow.add(first + zeros, std::span(values, bytes.size() / sizeof(Scalar)));
            });
        });
        if (!done) return done.error();
        return std::move(narrow).to_array();
    }

    /// With the 0 in front that files leave out.
    Result<Array> offsets_from_0(const StoredArray& stored) const {
        auto narrow = narrowed(stored, count_, 1);
        if (!narrow) return narrow.error();
        if (*narrow) return **std::move(narrow);
        const ScalarType type = stored.array().type;
        auto offsets = filled_array(type, static_cast<std::size_t>(count_) + 1, 1, [&](std::byte* to) {
            std::memset(to, 0, size_of(type));
            return stored.decode(to + size_of(type));
        });
        if (!offsets) return offsets;
        return as_indices_of_cells(std::move(*offsets));
    }

    static Result<std::uint64_t> last_of(const Array& offsets) {
        return offsets.visit([](auto values) -> Result<std::uint64_t> {
            if (values.back() < 0) return invalid_data(fmt::format("the last of the offsets is {}", values.back()));
            return static_cast<std::uint64_t>(values.back());
        });
    }

    Result<Array> indices(const char* name, std::uint64_t size) const {
        const auto stored = find_stored(name, size);
        return stored ? indices(*stored) : stored.error();
    }

    static Result<Array> indices(const StoredArray& stored) {
        auto narrow = narrowed(stored, stored.scalars(), 0);
        if (!narrow) return narrow.error();
        if (*narrow) return **std::move(narrow);
        auto values = filled_array(stored.array().type, static_cast<std::size_t>(stored.scalars()), 1,
                                   [&](std::byte* to) { return stored.decode(to); });
        if (!values) return values;
        return as_indices_of_cells(std::move(*values));
    }

    /// As int32 where the type is narrower.
    static Array as_indices_of_cells(Array array) {
        return size_of(array.type()) < 4 ? converted<std::int32_t>(array) : array;
    }

    Document& document_;
    pugi::xml_node piece_;
    std::uint64_t count_;
    std::size_t step_;
    const Progress& progress_;
    Section section_;
    const Grid* grid_ = nullptr; ///< null: all cells are wanted
    const ReadOptions* options_ = nullptr;
    bool kept_active_ = false;
};

/// The cells of all pieces in one list.
class CellsJoiner {
public:
    explicit CellsJoiner(const std::vector<Cells>& parts) : parts_(parts) {
        for (const Cells& part : parts_) {
            cells_ += part.count();
            corners_ += part.connectivity.size();
            narrow_ = narrow_ && (part.connectivity.empty() || part.connectivity.type() == ScalarType::int32);
        }
    }

    Cells join(const std::vector<std::uint64_t>& points_of_parts) const {
        return narrow_ ? join_as<std::int32_t>(points_of_parts) : join_as<std::int64_t>(points_of_parts);
    }

private:
    template <class Index>
    Cells join_as(const std::vector<std::uint64_t>& points_of_parts) const {
        std::vector<Index> connectivity, offsets{0};
        std::vector<std::uint8_t> types;
        FaceStreams faces;
        connectivity.reserve(corners_);
        offsets.reserve(cells_ + 1);
        types.reserve(cells_);
        std::uint64_t first_point = 0;
        for (std::size_t p = 0; p < parts_.size(); ++p) {
            const Cells& part = parts_[p];
            const std::size_t first_corner = connectivity.size(), count = part.count();
            part.connectivity.visit([&](auto corners) {
                for (const auto corner : corners)
                    connectivity.push_back(static_cast<Index>(static_cast<std::uint64_t>(corner) + first_point));
            });
            if (part.offsets.empty()) {
                const auto uniform = static_cast<std::uint8_t>(part.uniform_type);
                const auto corners = static_cast<std::size_t>(*corners_of_uniform(uniform));
                for (std::size_t i = 0; i < count; ++i)
                    offsets.push_back(static_cast<Index>(first_corner + (i + 1) * corners));
                types.insert(types.end(), count, uniform);
            } else {
                part.offsets.visit([&](auto ends) {
                    for (std::size_t i = 1; i < ends.size(); ++i)
                        offsets.push_back(static_cast<Index>(static_cast<std::uint64_t>(ends[i]) + first_corner));
                });
                const auto own = part.types.as<std::uint8_t>();
                types.insert(types.end(), own.begin(), own.end());
            }
            faces.add(part, [&](std::uint64_t point) { return point + first_point; });
            first_point += points_of_parts[p];
        }
        Cells cells;
        const bool uniform = !parts_.empty() && std::ranges::all_of(parts_, [&](const Cells& part) {
            return part.connectivity.empty() || (part.offsets.empty() && part.uniform_type == first_type());
        });
        cells.connectivity = Array::own(std::move(connectivity));
        cells.uniform_type = uniform ? first_type() : CellType::tetrahedron;
        if (!uniform) {
            cells.offsets = Array::own(std::move(offsets));
            cells.types = Array::own(std::move(types));
        }
        std::move(faces).give_to(cells);
        return cells;
    }

    CellType first_type() const {
        const auto first = std::ranges::find_if(parts_, [](const Cells& part) { return !part.connectivity.empty(); });
        return first == parts_.end() ? CellType::tetrahedron : first->uniform_type;
    }

    const std::vector<Cells>& parts_;
    std::size_t cells_ = 0, corners_ = 0;
    bool narrow_ = true;
};

/// The numbers of a piece's cells must be its own points, before they become numbers of the whole grid.
Result<void> check_corners(const Cells& cells, std::uint64_t points) {
    const bool in_range = all_pieces(cells.connectivity, [&](std::uint64_t, auto corners) {
        return std::ranges::all_of(corners, [&](auto corner) { return static_cast<std::uint64_t>(corner) < points; });
    });
    if (!in_range) return invalid_data(fmt::format("a cell of a piece has a point that is not among its {}", points));
    return check_face_streams(cells, points);
}

} // namespace

void simplify(Cells& cells) {
    if (cells.types.empty() || !are_uniform(cells.types)) return;
    const std::uint8_t type = cells.types.as<std::uint8_t>().front();
    const auto corners = corners_of_uniform(type);
    if (!corners || !all_pieces(cells.offsets, [&](std::uint64_t first, auto values) {
            return first == 0 ? values[0] == 0 && are_regular(0, values.subspan(1), *corners)
                              : are_regular(first - 1, values, *corners);
        }))
        return;
    cells.offsets = cells.types = Array();
    cells.uniform_type = static_cast<CellType>(type);
}

Result<Piece> load_unstructured(Document& document, const Wanted& wanted, const Progress& progress) {
    const auto elements = pieces_of(document);
    Layout points, cells;
    for (const auto& element : elements) {
        const auto point_count = count_of(element, "NumberOfPoints"), cell_count = count_of(element, "NumberOfCells");
        if (!point_count) return point_count.error();
        if (!cell_count) return cell_count.error();
        for (const auto& [layout, count] : {std::pair(&points, *point_count), std::pair(&cells, *cell_count)}) {
            if (count > document.source.size() * 0x4000ULL - layout->total) // no compressor makes that of the file
                return invalid_data(fmt::format("{} points or cells are announced in a file of {} bytes", count,
                                                document.source.size()));
            layout->tuples.push_back(count);
            layout->total += count;
        }
    }
    Piece piece;
    auto places = load_points(document, elements, points, wanted.step, progress);
    if (!places) return places.error();
    piece.grid.points = std::move(*places);
    if (auto loaded = load_fields(document, points, cells, wanted, progress, piece); !loaded) return loaded.error();
    std::vector<Cells> parts;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        CellsReader reader(document, elements[i], cells.tuples[i], wanted.step, progress);
        const bool whole_grid = elements.size() == 1 && !wanted.ids && piece.left_out.empty();
        if (wanted.options.active_cells && whole_grid) reader.ask_for_active_cells(piece.grid, wanted.options);
        auto part = reader.read();
        if (!part) return part.error();
        if (reader.kept_active_cells()) piece.cells_in_file = cells.total;
        if (elements.size() > 1)
            if (auto checked = check_corners(*part, points.tuples[i]); !checked) return checked.error();
        parts.push_back(std::move(*part));
    }
    piece.grid.cells = parts.size() == 1 ? std::move(parts.front()) : CellsJoiner(parts).join(points.tuples);
    return piece;
}

} // namespace isotet::io::vtk_xml
