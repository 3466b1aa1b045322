// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells whose types and offsets say nothing (all of one kind, one after another) get neither: they are only looked at,
// block by block.
#include "io/vtk_xml/cells_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <type_traits>
#include <utility>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "grid/cell_faces.hpp"
#include "grid/fixed_corners.hpp"
#include "io/files/scalars.hpp"
#include "io/files/text_scanner.hpp"
#include "io/pieces/narrow_indices.hpp"
#include "io/pieces/join/shared_faces.hpp"
#include "io/pieces/uniform_cells.hpp"
#include "io/vtk_legacy/old_hexahedra.hpp"
#include "io/vtk_xml/columns.hpp"

namespace isotet::io::vtk_xml {
namespace {

template <class To>
Array converted(const Array& array) {
    core::Buffer<To> values(array.size());
    array.visit([&](auto from) {
        core::parallel_each(from.size(), values_at_once, [&](std::size_t i) { values[i] = static_cast<To>(from[i]); });
    });
    return std::move(values).to_array();
}

/// Whether a value is a whole number that a double holds exactly.
template <class Value>
bool is_whole(Value value) {
    if constexpr (std::is_floating_point_v<Value>)
        return std::abs(value) <= Value{0x1p53} && value == std::floor(value);
    else return true;
}

/// As int32 where all values fit; nothing where that gains nothing, or where one does not fit.
Result<std::optional<Array>> narrowed(const StoredArray& stored, std::uint64_t size, std::size_t zeros) {
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

/// As int32 where the type is narrower; floating ones, which some writers take, as int64.
Result<Array> as_indices_of_cells(Array array, std::string_view name) {
    if (!is_floating(array.type())) return size_of(array.type()) < 4 ? converted<std::int32_t>(array) : array;
    const bool whole = all_pieces(array, [](std::uint64_t, auto values) {
        return std::ranges::all_of(values, [](auto value) { return is_whole(value); });
    });
    if (!whole)
        return invalid_data(fmt::format("Cells {} is {}, and not all of its values are whole numbers", in_quotes(name),
                                        isotet::name_of(array.type())));
    return converted<std::int64_t>(array);
}

class CellsReader {
public:
    CellsReader(Document& document, const CellsElement& element, bool corners_later, const Progress& progress)
        : document_(document),
          piece_(element.piece),
          count_(element.count),
          step_(element.step),
          corners_later_(corners_later),
          progress_(progress) {}

    Result<CellsRead> read() {
        Cells cells;
        section_ = describe_section(document_, piece_.child("Cells"), step_);
        if (count_ == 0) return check_no_types();
        const auto size = read_types_and_offsets(cells);
        if (!size) return size.error();
        const auto stored = find_stored("connectivity", *size);
        if (!stored) return stored.error();
        if (corners_later_ && places_ && has_blocks_of_indices(*stored))
            return CellsRead{std::move(cells), *stored, std::move(places_)};
        auto connectivity = read_corners(*stored);
        if (!connectivity) return connectivity.error();
        if (places_) cells = cells_at(*places_, cells.types, *std::move(connectivity));
        else cells.connectivity = *std::move(connectivity);
        if (auto read = read_faces(cells); !read) return read.error();
        if (is_of_vtk_8()) reorder_old_hexahedra(cells);
        return CellsRead{std::move(cells)};
    }

private:
    static bool has_blocks_of_indices(const StoredArray& stored) {
        return size_of(stored.array().type) >= 4 && !is_floating(stored.array().type) && stored.has_blocks();
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

    /// No cells may be announced only where none are there. Where an appended array of nothing begins, others may.
    Result<CellsRead> check_no_types() const {
        const auto types = std::ranges::find(section_.arrays, "types", &DataArray::name);
        if (types == section_.arrays.end() || !types->inside) return CellsRead{};
        const auto first = load_array(document_, *types, 1, progress_);
        if (first) return invalid_data("NumberOfCells is 0, but the array 'types' holds values");
        return first.error().code == ErrorCode::invalid_data ? Result<CellsRead>(CellsRead{}) : first.error();
    }

    Result<DataArray> find(const char* name) const {
        for (const LeftOut& item : section_.left_out)
            if (item.name == name) return invalid_data(fmt::format("Cells {}: {}", in_quotes(name), item.reason));
        const auto found = std::ranges::find(section_.arrays, name, &DataArray::name);
        if (found == section_.arrays.end())
            return invalid_data(fmt::format("Cells has no array {}, but there are {} cells", in_quotes(name), count_));
        if (found->components != 1)
            return invalid_data(fmt::format("Cells {} has {} components, not one", in_quotes(name), found->components));
        return *found;
    }

    /// An array with one value a cell: more of them would be cells that are not announced.
    Result<StoredArray> find_of_cells(const char* name) const {
        auto stored = find_stored(name, count_);
        if (!stored) return stored;
        if (auto all = stored->check_stored(); !all) return in_cells(all.error());
        return stored;
    }

    Error in_cells(const Error& error) const {
        return error.code == ErrorCode::invalid_data
                   ? invalid_data(fmt::format("NumberOfCells is {}: {}", count_, error.message))
                   : error;
    }

    Result<StoredArray> find_stored(const char* name, std::uint64_t size) const {
        const auto described = find(name);
        if (!described) return described.error();
        return StoredArray::find(document_, *described, size, progress_);
    }

    /// Returns how many corners there are. Neither types nor offsets become arrays where they say nothing.
    Result<std::uint64_t> read_types_and_offsets(Cells& cells) {
        const auto types = find_of_cells("types");
        if (!types) return types.error();
        const auto type = one_type(*types);
        if (!type) return type.error();
        if (!*type) // else they have been looked at
            if (auto read = read_types(*types, cells); !read) return read.error();
        const auto offsets = find_of_cells("offsets");
        if (!offsets) return offsets.error();
        const auto corners = *type ? corners_of_uniform(**type) : std::nullopt;
        if (corners && offsets->has_blocks()) {
            const auto regular = are_regular_offsets(*offsets, *corners);
            if (!regular) return regular.error();
            if (*regular) {
                cells.uniform_type = static_cast<CellType>(**type);
                places_ = CellPlaces(cells.uniform_type, count_);
                return count_ * *corners;
            }
        }
        if (*type)
            if (auto read = read_types(*types, cells); !read) return read.error();
        if (corners_later_) {
            if (auto found = find_places(*offsets, cells.types); !found) return found.error();
            if (places_) return places_->corners();
        }
        auto from_0 = offsets_from_0(*offsets);
        if (!from_0) return from_0.error();
        const auto last = last_of(*from_0);
        cells.offsets = std::move(*from_0);
        simplify(cells);
        return last;
    }

    /// Sets places_ where the types tell all that the offsets do.
    Result<void> find_places(const StoredArray& offsets, const Array& types) {
        auto places = CellPlaces::make(types.as<std::uint8_t>());
        if (!places || !offsets.has_blocks()) return {};
        const auto same = with_type(offsets.array().type, [&](auto zero) -> Result<bool> {
            using Scalar = decltype(zero);
            if constexpr (std::is_integral_v<Scalar>) {
                if (!std::in_range<Scalar>(places->corners())) return false;
                return offsets.holds([&](std::uint64_t first, std::span<std::byte> bytes) {
                    auto* const values = reinterpret_cast<Scalar*>(bytes.data());
                    std::uint64_t end = places->begin(first);
                    for (std::size_t i = 0; i < bytes.size() / sizeof(Scalar); ++i)
                        values[i] = static_cast<Scalar>(end += core::fixed_corners_of(places->type(first + i)));
                });
            } else return false; // find() takes no floating offsets
        });
        if (!same) return same.error();
        if (*same) places_ = std::move(places);
        return {};
    }

    /// The type of all cells, looked at block by block; nothing where there are several, or no such blocks.
    static Result<std::optional<std::uint8_t>> one_type(const StoredArray& stored) {
        if (stored.array().type != ScalarType::uint8 || !stored.has_blocks()) return std::optional<std::uint8_t>();
        std::uint8_t first = 0;
        if (auto read = stored.read_first(std::as_writable_bytes(std::span(&first, 1))); !read) return read.error();
        const auto all = stored.holds(
            [&](std::uint64_t, std::span<std::byte> types) { std::ranges::fill(types, std::byte{first}); });
        if (!all) return all.error();
        return *all ? std::optional(first) : std::nullopt;
    }

    static Result<void> read_types(const StoredArray& stored, Cells& cells) {
        auto types = filled_array(stored.array().type, static_cast<std::size_t>(stored.scalars()), 1,
                                  [&](std::byte* to) { return stored.decode_all(to); });
        if (!types) return types.error();
        if (types->type() != ScalarType::uint8) {
            const bool fits = all_pieces(*types, [](std::uint64_t, auto values) {
                return std::ranges::all_of(values,
                                           [](auto type) { return type >= 0 && type <= 255 && is_whole(type); });
            });
            if (!fits) return invalid_data("a cell type is not a whole number between 0 and 255");
            types = converted<std::uint8_t>(*types);
        }
        cells.types = std::move(*types);
        return {};
    }

    /// Whether offset i is (i + 1) * corners.
    static Result<bool> are_regular_offsets(const StoredArray& stored, std::uint64_t corners) {
        return with_type(stored.array().type, [&](auto zero) -> Result<bool> {
            using Scalar = decltype(zero);
            if constexpr (std::is_integral_v<Scalar>) {
                if (!std::in_range<Scalar>(stored.scalars() * corners)) return false;
                return stored.holds([&](std::uint64_t first, std::span<std::byte> bytes) {
                    auto* const values = reinterpret_cast<Scalar*>(bytes.data());
                    for (std::size_t i = 0; i < bytes.size() / sizeof(Scalar); ++i)
                        values[i] = static_cast<Scalar>((first + i + 1) * corners);
                });
            } else return false; // find() takes no floating offsets
        });
    }

    /// With the 0 in front that files leave out.
    Result<Array> offsets_from_0(const StoredArray& stored) const {
        auto narrow = narrowed(stored, count_, 1);
        if (!narrow) return narrow.error();
        if (*narrow) return **std::move(narrow);
        const ScalarType type = stored.array().type;
        auto offsets = filled_array(type, static_cast<std::size_t>(count_) + 1, 1, [&](std::byte* to) {
            std::memset(to, 0, size_of(type));
            return stored.decode_all(to + size_of(type));
        });
        if (!offsets) return offsets;
        return as_indices_of_cells(std::move(*offsets), "offsets");
    }

    static Result<std::uint64_t> last_of(const Array& offsets) {
        return offsets.visit([](auto values) -> Result<std::uint64_t> {
            if (values.back() < 0) return invalid_data(fmt::format("the last of the offsets is {}", values.back()));
            return static_cast<std::uint64_t>(values.back());
        });
    }

    Result<Array> indices(const char* name, std::uint64_t size) const {
        const auto stored = find_stored(name, size);
        return stored ? read_corners(*stored) : stored.error();
    }

    Document& document_;
    pugi::xml_node piece_;
    std::uint64_t count_;
    std::size_t step_;
    bool corners_later_;
    const Progress& progress_;
    Section section_;
    std::optional<CellPlaces> places_; ///< where there are no offsets
};

} // namespace

Result<CellsRead> read_cells(Document& document, const CellsElement& element, bool corners_later,
                             const Progress& progress) {
    return CellsReader(document, element, corners_later, progress).read();
}

Result<Array> read_corners(const StoredArray& stored) {
    auto narrow = narrowed(stored, stored.scalars(), 0);
    if (!narrow) return narrow.error();
    if (*narrow) return **std::move(narrow);
    auto values = filled_array(stored.array().type, static_cast<std::size_t>(stored.scalars()), 1,
                               [&](std::byte* to) { return stored.decode(to); });
    if (!values) return values;
    return as_indices_of_cells(std::move(*values), stored.array().name);
}

} // namespace isotet::io::vtk_xml
