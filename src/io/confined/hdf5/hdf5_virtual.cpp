// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/hdf5/hdf5_virtual.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "io/confined/hdf5/hdf5_file.hpp"
#include "io/confined/hdf5/hdf5_unwritten.hpp"
#include "io/files/escape.hpp"
#include "io/files/index_file.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::string_view own_file = "."; ///< HDF5's name for the file of the virtual data set

Error wrong(std::string what) { return {ErrorCode::invalid_data, std::move(what)}; }

/// The name of a file or data set that one part of a virtual data set has.
template <class Get>
std::optional<std::string> name_of(const Get& get, hid_t creation, std::size_t part) {
    constexpr ssize_t most = 1 << 16;
    const ssize_t length = get(creation, part, nullptr, 0);
    if (length <= 0 || length > most) return std::nullopt;
    std::string name(static_cast<std::size_t>(length) + 1, '\0');
    if (get(creation, part, name.data(), name.size()) != length) return std::nullopt;
    name.pop_back();
    return name;
}

/// HDF5 puts a number into such names.
bool is_pattern(std::string_view name) {
    return name.find("%b") != std::string_view::npos || name.find("%%") != std::string_view::npos;
}

struct Extent {
    std::vector<hsize_t> lengths;

    explicit Extent(hid_t space) {
        const int rank = H5Sget_simple_extent_ndims(space);
        lengths.resize(rank < 0 ? 0 : static_cast<std::size_t>(rank));
        if (rank > 0) H5Sget_simple_extent_dims(space, lengths.data(), nullptr);
    }
    /// Nothing where they are too many to count.
    std::optional<hsize_t> count() const {
        hsize_t all = 1;
        for (const hsize_t length : lengths) {
            if (length != 0 && all > (hsize_t{1} << 60U) / length) return std::nullopt;
            all *= length;
        }
        return all;
    }
};

/// First and last place along each axis of what is selected.
struct Bounds {
    std::vector<hsize_t> first, last;

    static std::optional<Bounds> of(hid_t space, std::size_t rank) {
        if (H5Sget_simple_extent_ndims(space) != static_cast<int>(rank)) return std::nullopt;
        Bounds bounds{std::vector<hsize_t>(rank), std::vector<hsize_t>(rank)};
        if (H5Sget_select_bounds(space, bounds.first.data(), bounds.last.data()) < 0) return std::nullopt;
        return bounds;
    }
};

struct Rows {
    hsize_t first, end;
};

/// Nothing where all columns of some rows are not what is selected.
std::optional<Rows> selected_rows(hid_t space, hsize_t selected, const Extent& whole) {
    const auto bounds = Bounds::of(space, whole.lengths.size());
    const auto all = whole.count();
    if (!bounds || !all || *all == 0) return std::nullopt;
    for (std::size_t axis = 1; axis < whole.lengths.size(); ++axis)
        if (bounds->first[axis] != 0 || bounds->last[axis] + 1 != whole.lengths[axis]) return std::nullopt;
    const Rows rows{bounds->first[0], bounds->last[0] + 1};
    if (rows.end > whole.lengths[0] || selected != (rows.end - rows.first) * (*all / whole.lengths[0]))
        return std::nullopt;
    return rows;
}

/// Whether a data set of this extent has all that is selected.
bool has_all(const Extent& extent, hid_t selection, hsize_t selected) {
    if (H5Sget_select_type(selection) == H5S_SEL_ALL) return extent.count() == selected;
    const auto bounds = Bounds::of(selection, extent.lengths.size());
    if (!bounds || H5Sget_select_npoints(selection) != static_cast<hssize_t>(selected)) return false;
    for (std::size_t axis = 0; axis < extent.lengths.size(); ++axis)
        if (bounds->last[axis] >= extent.lengths[axis]) return false;
    return true;
}

/// One part: `selected` values of a data set of this file.
Result<void> check_source(const std::string& file, const std::string& name, hid_t selection, hsize_t selected) {
    const auto failed = [&](std::string_view why) {
        return wrong(fmt::format("is put together of \"{}\" in \"{}\", {}", escaped(name), escaped(file), why));
    };
    const auto opened = open_hdf5(file);
    const Handle data(opened ? H5Dopen2((*opened)->file, name.c_str(), H5P_DEFAULT) : -1, H5Dclose);
    if (!data.good()) return failed("which HDF5 cannot open");
    const Handle creation(H5Dget_create_plist(data), H5Pclose);
    const Handle space(H5Dget_space(data), H5Sclose);
    if (!creation.good() || !space.good()) return failed("which cannot be read");
    if (H5Pget_layout(creation) == H5D_VIRTUAL) return failed("which is virtual itself: this is not read");
    if (!has_all(Extent(space), selection, selected)) return failed("which has fewer values");
    if (may_be_unwritten(data)) return failed("which has values that were never written");
    return {};
}

} // namespace

Result<std::vector<std::string>> files_of_virtual_data(hid_t data) {
    const Handle creation(H5Dget_create_plist(data), H5Pclose);
    std::size_t parts = 0;
    if (!creation.good() || H5Pget_virtual_count(creation, &parts) < 0) return wrong("cannot be read");
    std::vector<std::string> files;
    for (std::size_t part = 0; part < parts; ++part) {
        auto file = name_of(H5Pget_virtual_filename, creation, part);
        if (!file) return wrong("is put together of a file whose name cannot be read");
        if (is_pattern(*file))
            return wrong(fmt::format("is put together of files \"{}\": numbers in names are not read", escaped(*file)));
        if (*file != own_file && std::ranges::find(files, *file) == files.end()) files.push_back(*std::move(file));
    }
    return files;
}

Result<void> check_virtual_data(hid_t data, const std::string& file, bool allow_outside, bool may_lack_rows) {
    const Handle creation(H5Dget_create_plist(data), H5Pclose);
    const Handle space(H5Dget_space(data), H5Sclose);
    std::size_t parts = 0;
    if (!creation.good() || !space.good() || H5Pget_virtual_count(creation, &parts) < 0) return wrong("cannot be read");
    const Extent whole(space);
    if (whole.lengths.empty()) return wrong("is a virtual data set of one value, which is not read");
    std::vector<Rows> all;
    for (std::size_t part = 0; part < parts; ++part) {
        const Handle place(H5Pget_virtual_vspace(creation, part), H5Sclose);
        const Handle selection(H5Pget_virtual_srcspace(creation, part), H5Sclose);
        const hssize_t selected = place.good() ? H5Sget_select_npoints(place) : 0;
        if (selected == 0) continue;
        const auto rows = selected < 0 ? std::nullopt : selected_rows(place, static_cast<hsize_t>(selected), whole);
        if (!rows || !selection.good())
            return wrong("is a virtual data set that is not put together of rows: this is not read");
        all.push_back(*rows);
        const auto name = name_of(H5Pget_virtual_filename, creation, part);
        const auto source = name_of(H5Pget_virtual_dsetname, creation, part);
        if (!name || !source || is_pattern(*source))
            return wrong("is put together of a data set whose name is not read");
        const auto path = *name == own_file ? Result<std::string>(file) : named_file(file, *name, allow_outside);
        if (!path) return path.error();
        if (auto there = check_source(*path, *source, selection, static_cast<hsize_t>(selected)); !there) return there;
    }
    std::ranges::sort(all, {}, &Rows::first);
    hsize_t next = 0;
    for (const Rows& rows : all) {
        if (rows.first > next && !may_lack_rows) break;
        if (rows.first < next) return wrong(fmt::format("is a virtual data set with row {} twice", rows.first));
        next = rows.end;
    }
    if (next < whole.lengths[0] && !may_lack_rows)
        return wrong(fmt::format("is a virtual data set without row {}", next));
    return {};
}

} // namespace isotet::io::confined
