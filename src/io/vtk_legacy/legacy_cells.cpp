// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk_legacy/legacy_cells.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "io/files/first_error.hpp"
#include "io/files/text_scanner.hpp"
#include "io/pieces/narrow_indices.hpp"

namespace isotet::io {
namespace {

template <class Number>
Number with_bytes_swapped(Number number) {
    auto bytes = std::bit_cast<std::array<std::byte, sizeof(Number)>>(number);
    std::ranges::reverse(bytes);
    return std::bit_cast<Number>(bytes);
}

Error is_little_endian(std::string_view keyword) {
    return invalid_data(fmt::format("the numbers of {} make sense only as little-endian ones, but binary legacy VTK "
                                    "files are big-endian: the program that wrote it has to swap the bytes",
                                    keyword));
}

class CellsOfLegacy {
public:
    CellsOfLegacy(LegacyValues& values, LegacyList wanted)
        : values_(values), geometry_(wanted != LegacyList::skipped), leaves_(wanted == LegacyList::without_corners) {}

    Result<void> read(LegacyCells& cells, std::string_view keyword) {
        if (cells.count > 0) return values_.before_here(fmt::format("{} occurs twice", keyword));
        const auto first = values_.read_count("the number of cells"),
                   second = values_.read_count("the size of the cells");
        if (!first) return first.error();
        if (!second) return second.error();
        const auto before = values_.scanner().position();
        const bool has_offsets = lower(values_.scanner().word()) == "offsets";
        cells.announced = has_offsets ? *second : *second - std::min(*first, *second);
        if (has_offsets) return read_offsets(cells, keyword, *first, *second);
        values_.scanner().seek(before);
        if (*first == 0 && *second == 0) return {};
        return read_interleaved(cells, keyword, *first, *second);
    }

    /// What read() has left in the file.
    Result<void> read_left(LegacyCells& cells, const CornersInFile& stored) {
        if (stored.interleaved) return read_interleaved(cells, "CELLS", cells.count, stored.count);
        auto corners = read_indices(stored.type, stored.count, "CELLS");
        if (!corners) return corners.error();
        cells.connectivity = *std::move(corners);
        return {};
    }

    Result<void> read_types(LegacyFile& file) {
        const auto count = values_.read_count("the number of cell types");
        if (!count) return count.error();
        file.cell_type_count = *count;
        if (values_.binary() && geometry_) {
            const auto one = read_one_type(*count);
            if (!one) return one.error();
            file.one_type = *one;
            if (*one) return {};
        }
        const auto types = values_.read_values(legacy_integers, *count, 1, "CELL_TYPES", geometry_);
        if (!types) return types.error();
        std::atomic<bool> fit = true;
        file.cell_types = mapped<std::uint8_t>(*types, [&](auto type) {
            if (type < 0 || type > 255) fit = false;
            return static_cast<std::uint8_t>(type);
        });
        if (!fit && values_.binary() && std::ranges::all_of(types->as<std::int32_t>(), [](std::int32_t type) {
                return static_cast<std::uint32_t>(with_bytes_swapped(type)) <= 255;
            }))
            return is_little_endian("CELL_TYPES");
        if (!fit) return invalid_data("CELL_TYPES: a type is not between 0 and 255");
        return {};
    }

private:
    /// Until version 4.2: count, corner, corner, ..., count, ...
    Result<void> read_interleaved(LegacyCells& cells, std::string_view keyword, std::uint64_t count,
                                  std::uint64_t size) {
        if (leaves_ && values_.binary() && leave_interleaved(cells, count, size)) {
            const auto skipped = values_.read_values(legacy_integers, size, 1, keyword, false);
            return skipped ? Result<void>() : skipped.error();
        }
        const auto values = values_.read_values(legacy_integers, size, 1, keyword, geometry_);
        if (!values) return values.error();
        if (!geometry_) return {};
        const auto numbers = values->as<std::int32_t>();
        const auto does_not_fit = [&](std::uint64_t cell) {
            if (values_.binary() && fits_swapped(numbers, count)) return is_little_endian(keyword);
            return invalid_data(
                fmt::format("{}: cell {} of {} does not fit into the {} numbers", keyword, cell, count, size));
        };
        if (count > size) return does_not_fit(size);
        cells.count = count;
        cells.interleaved = true;
        if (take_regular(cells, numbers)) return {};
        core::Buffer<std::int32_t> corners(numbers.size());
        core::Buffer<std::int64_t> offsets(static_cast<std::size_t>(count) + 1);
        std::size_t at = 0, next = 0;
        for (std::uint64_t cell = 0; cell < count; ++cell) {
            if (at >= numbers.size() || numbers[at] < 0 ||
                static_cast<std::size_t>(numbers[at]) > numbers.size() - at - 1)
                return does_not_fit(cell);
            const auto length = static_cast<std::size_t>(numbers[at]);
            offsets[cell] = static_cast<std::int64_t>(next);
            std::copy_n(numbers.data() + at + 1, length, corners.data() + next);
            next += length;
            at += length + 1;
        }
        offsets[count] = static_cast<std::int64_t>(next);
        corners.shrink(next);
        cells.connectivity = std::move(corners).to_array();
        cells.offsets = std::move(offsets).to_array();
        return {};
    }

    /// True where the numbers are whole cells once their bytes are swapped.
    static bool fits_swapped(std::span<const std::int32_t> numbers, std::uint64_t count) {
        std::uint64_t at = 0;
        for (std::uint64_t cell = 0; cell < count && at < numbers.size(); ++cell)
            at += 1 + static_cast<std::uint64_t>(
                          static_cast<std::uint32_t>(with_bytes_swapped(numbers[static_cast<std::size_t>(at)])));
        return count > 0 && at == numbers.size();
    }

    /// The same of offsets.
    static bool fits_swapped(const Array& offsets, std::uint64_t size) {
        return offsets.visit([&](auto all) {
            std::uint64_t last = 0;
            for (const auto stored : all) {
                const auto offset = static_cast<std::uint64_t>(with_bytes_swapped(stored));
                if (offset < last) return false;
                last = offset;
            }
            return last == size;
        });
    }

    /// Counts of numbers tell that all cells may have as many corners; each_of_corners() sees whether they have.
    bool leave_interleaved(LegacyCells& cells, std::uint64_t count, std::uint64_t size) {
        if (count == 0 || size % count != 0 || size / count < 2) return false;
        cells.count = count;
        cells.interleaved = true;
        cells.corners = size / count - 1;
        cells.in_file = {values_.scanner().position(), legacy_integers, size, cells.corners, true};
        return true;
    }

    /// Cells that all have as many corners as the first.
    static bool take_regular(LegacyCells& cells, std::span<const std::int32_t> numbers) {
        const auto count = static_cast<std::size_t>(cells.count);
        if (count == 0 || numbers[0] < 1 || numbers.size() / count != static_cast<std::size_t>(numbers[0]) + 1 ||
            numbers.size() % count != 0)
            return false;
        const auto corners = static_cast<std::size_t>(numbers[0]);
        std::atomic<bool> regular = true;
        core::Buffer<std::int32_t> connectivity(count * corners);
        core::parallel_ranges(count, legacy_piece, [&](std::size_t begin, std::size_t end) {
            bool same = true;
            for (std::size_t cell = begin; cell < end; ++cell) {
                const std::int32_t* const from = numbers.data() + cell * (corners + 1);
                same = same && from[0] == numbers[0];
                std::copy_n(from + 1, corners, connectivity.data() + cell * corners);
            }
            if (!same) regular = false;
        });
        if (!regular) return false;
        cells.connectivity = std::move(connectivity).to_array();
        cells.corners = corners;
        return true;
    }

    /// From version 5.1 on: all offsets, one more than there are cells, then all corners.
    Result<void> read_offsets(LegacyCells& cells, std::string_view keyword, std::uint64_t count, std::uint64_t size) {
        for (Array* const numbers : {&cells.offsets, &cells.connectivity}) {
            const bool first = numbers == &cells.offsets;
            if (!first)
                if (const auto word = lower(values_.scanner().word()); word != "connectivity")
                    return invalid_data(
                        fmt::format("{}: {} where connectivity was expected", keyword, in_quotes(word)));
            const auto type = values_.read_type();
            if (!type) return type.error();
            const std::uint64_t needed = first ? count : size;
            const bool usual = !is_floating(type->type) && size_of(type->type) >= 4;
            if (usual && first && values_.binary() && geometry_ && count > 1) {
                const auto corners = read_regular(*type, count, size, keyword);
                if (!corners) return corners.error();
                cells.corners = *corners;
                if (*corners > 0) continue;
            }
            if (usual && !first && leaves_ && cells.corners > 0 && type->type != ScalarType::uint64) {
                cells.in_file = {values_.scanner().position(), *type, needed, cells.corners, false};
                const auto skipped = values_.read_values(*type, needed, 1, keyword, false);
                if (!skipped) return skipped.error();
                continue;
            }
            auto values = usual ? read_indices(*type, needed, keyword) : read_odd_indices(*type, needed, keyword);
            if (!values) return values.error();
            *numbers = *std::move(values);
        }
        if (!geometry_) return {};
        cells.count = count == 0 ? 0 : count - 1;
        if (cells.count == 0 || cells.corners > 0) return {};
        FirstError failed;
        cells.offsets.visit([&](auto offsets) {
            core::parallel_ranges(offsets.size(), legacy_piece, [&](std::size_t begin, std::size_t end) {
                auto last = begin == 0 ? 0 : static_cast<std::uint64_t>(offsets[begin - 1]);
                for (std::size_t i = begin; i < end && !failed; ++i) {
                    const auto offset = static_cast<std::uint64_t>(offsets[i]);
                    if (offset > size || offset < last || (i == 0 && offset != 0))
                        failed.add(
                            i, invalid_data(fmt::format("{}: offsets[{}] is {}, outside 0 to {} or lower than before",
                                                        keyword, i, offsets[i], size)));
                    last = offset;
                }
            });
        });
        auto sound = failed.result();
        if (!sound && values_.binary() && fits_swapped(cells.offsets, size)) return is_little_endian(keyword);
        return sound;
    }

    /// Narrow ones where they fit.
    Result<Array> read_indices(const LegacyType& type, std::uint64_t count, std::string_view keyword) {
        if (values_.binary() && geometry_ && NarrowIndices::narrows(type.type)) {
            auto narrow = values_.read_narrow(type, count, keyword);
            if (!narrow) return narrow.error();
            if (*narrow) return **std::move(narrow);
        }
        return values_.read_values(type, count, 1, keyword, geometry_);
    }

    /// Of types that VTK reads as indices, but never writes.
    Result<Array> read_odd_indices(const LegacyType& type, std::uint64_t count, std::string_view keyword) {
        auto values = values_.read_values(type, count, 1, keyword, geometry_);
        if (!values || !geometry_) return values;
        return values->visit([&](auto numbers) -> Result<Array> {
            core::Buffer<std::int64_t> indices(numbers.size());
            for (std::size_t i = 0; i < numbers.size(); ++i) {
                const auto number = static_cast<double>(numbers[i]);
                if (!(number >= 0 && number < 0x1p53 && std::trunc(number) == number))
                    return invalid_data(fmt::format("{}: {} is no offset or corner", keyword, numbers[i]));
                indices[i] = static_cast<std::int64_t>(numbers[i]);
            }
            return std::move(indices).to_array();
        });
    }

    /// How many corners each cell has; 0, and the place as before, where not all have as many, one after another.
    Result<std::uint64_t> read_regular(const LegacyType& type, std::uint64_t count, std::uint64_t size,
                                       std::string_view what) {
        const std::uint64_t corners = size / (count - 1);
        if (corners == 0 || size % (count - 1) != 0 || type.bits) return std::uint64_t{0};
        const auto look = [&]<class Offset>(std::size_t first, std::span<const Offset> offsets) {
            std::uint64_t different = 0;
            for (std::size_t i = 0; i < offsets.size(); ++i)
                different |= static_cast<std::uint64_t>(offsets[i]) ^ ((first + i) * corners);
            return different == 0;
        };
        const auto regular = size_of(type.type) == 8 ? values_.read_while<std::int64_t>(type, count, what, look)
                                                     : values_.read_while<std::int32_t>(type, count, what, look);
        if (!regular) return regular.error();
        return *regular ? corners : 0;
    }

    /// The type of all cells of a binary file; nothing, and the place as before, where there are several.
    Result<std::optional<std::uint8_t>> read_one_type(std::uint64_t count) {
        if (count == 0) return std::optional<std::uint8_t>();
        constexpr std::int32_t unknown = -1;
        std::atomic<std::int32_t> first = unknown;
        const auto same = values_.read_while<std::int32_t>(
            legacy_integers, count, "CELL_TYPES", [&](std::size_t, std::span<const std::int32_t> types) {
                const std::int32_t own = types.front();
                std::int32_t expected = unknown, different = 0;
                if (!first.compare_exchange_strong(expected, own) && expected != own) return false;
                for (const std::int32_t type : types) different |= type ^ own;
                return different == 0 && own >= 0 && own <= 255;
            });
        if (!same) return same.error();
        return *same ? std::optional(static_cast<std::uint8_t>(first.load())) : std::nullopt;
    }

    LegacyValues& values_;
    bool geometry_, leaves_ = false;
};

} // namespace

void LegacyCells::each(const std::function<void(std::span<const std::uint64_t>)>& visit) const {
    std::vector<std::uint64_t> cell;
    connectivity.visit([&](auto all) {
        const auto add = [&](std::size_t begin, std::size_t end) {
            cell.clear();
            for (std::size_t i = begin; i < end; ++i) cell.push_back(static_cast<std::uint64_t>(all[i]));
            visit(cell);
        };
        if (offsets.empty())
            for (std::size_t i = 0; i < count; ++i)
                add(i * static_cast<std::size_t>(corners), (i + 1) * static_cast<std::size_t>(corners));
        else
            offsets.visit([&](auto begins) {
                for (std::size_t i = 0; i + 1 < begins.size(); ++i)
                    add(static_cast<std::size_t>(begins[i]), static_cast<std::size_t>(begins[i + 1]));
            });
    });
}

Result<void> read_legacy_cells(LegacyValues& values, std::string_view keyword, LegacyList wanted, LegacyCells& cells) {
    return CellsOfLegacy(values, wanted).read(cells, keyword);
}

Result<bool> each_of_corners(LegacyValues& values, const CornersInFile& stored,
                             const std::function<bool(std::uint64_t first, const Array& corners)>& take) {
    values.scanner().seek(stored.position);
    const auto look = [&]<class Number>(std::size_t first, std::span<const Number> numbers) {
        return take(first, Array(stored.type.type, numbers.data(), numbers.size(), 1, nullptr));
    };
    if (!stored.interleaved)
        return size_of(stored.type.type) == 8
                   ? values.read_while<std::int64_t>(stored.type, stored.count, "CELLS", look)
                   : values.read_while<std::int32_t>(stored.type, stored.count, "CELLS", look);
    const std::size_t each = static_cast<std::size_t>(stored.corners) + 1; // numbers of a cell
    return values.read_while<std::int32_t>(
        stored.type, stored.count, "CELLS", [&](std::size_t first, std::span<const std::int32_t> numbers) {
            thread_local std::vector<std::int32_t> corners;
            corners.clear();
            for (std::size_t i = 0; i < numbers.size();) {
                const std::size_t in_cell = (first + i) % each;
                if (in_cell == 0 && static_cast<std::uint64_t>(numbers[i]) != stored.corners) return false;
                const std::size_t from = i + (in_cell == 0 ? 1 : 0), to = std::min(numbers.size(), i + each - in_cell);
                corners.insert(corners.end(), numbers.begin() + static_cast<std::ptrdiff_t>(from),
                               numbers.begin() + static_cast<std::ptrdiff_t>(to));
                i = to;
            }
            const std::size_t counts_before = (first + each - 1) / each;
            return take(first - counts_before, Array(ScalarType::int32, corners.data(), corners.size(), 1, nullptr));
        });
}

Result<void> read_corners(LegacyValues& values, LegacyCells& cells) {
    const CornersInFile stored = *std::exchange(cells.in_file, std::nullopt);
    values.scanner().seek(stored.position);
    return CellsOfLegacy(values, LegacyList::whole).read_left(cells, stored);
}

Result<void> read_legacy_cell_types(LegacyValues& values, bool geometry, LegacyFile& file) {
    return CellsOfLegacy(values, geometry ? LegacyList::whole : LegacyList::skipped).read_types(file);
}

} // namespace isotet::io
