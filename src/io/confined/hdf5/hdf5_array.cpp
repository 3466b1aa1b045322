// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include <fmt/core.h>
#include <hdf5.h>

#include "io/files/escape.hpp"
#include "io/files/text_scanner.hpp"
#include "io/confined/hdf5/hdf5_array.hpp"
#include "io/confined/hdf5/hdf5_file.hpp"
#include "io/confined/hdf5/hdf5_filters.hpp"
#include "io/confined/hdf5/hdf5_handle.hpp"
#include "io/confined/hdf5/hdf5_rows.hpp"
#include "io/confined/hdf5/hdf5_unwritten.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::uint64_t too_many = std::uint64_t(1) << 50;

/// How data sets are looked up: a link to another file fails.
hid_t access_inside_file() {
    const hid_t access = H5Pcreate(H5P_DATASET_ACCESS);
    H5Pset_elink_cb(
        access,
        [](const char*, const char*, const char*, const char*, unsigned*, hid_t, void*) -> herr_t { return -1; },
        nullptr);
    return access;
}

/// The values lie in the file itself, not in others that it names.
bool lies_inside_file(hid_t data) {
    const Handle creation(H5Dget_create_plist(data), H5Pclose);
    return creation.good() && H5Pget_external_count(creation) == 0 && H5Pget_layout(creation) != H5D_VIRTUAL;
}

/// Selects the box; its size in `dimensions`.
bool select(hid_t space, const Box& box, std::vector<std::uint64_t>& dimensions) {
    if (box.count.empty()) return true;
    if (box.count.size() != dimensions.size() || box.start.size() != dimensions.size() ||
        box.stride.size() != dimensions.size())
        return false;
    std::vector<hsize_t> start, stride, count;
    for (std::size_t i = 0; i < dimensions.size(); ++i) {
        if (box.count[i] == 0 || box.stride[i] == 0 || box.start[i] >= dimensions[i] ||
            (box.count[i] - 1) > (dimensions[i] - 1 - box.start[i]) / box.stride[i])
            return false;
        start.push_back(box.start[i]);
        stride.push_back(box.stride[i]);
        count.push_back(box.count[i]);
    }
    dimensions = box.count;
    return H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), stride.data(), count.data(), nullptr) >= 0;
}

/// All values of a data set in the file itself, one a tuple; nothing where it has no such rows.
std::optional<Result<Array>> read_whole(const std::string& file, const std::string& name, HdfNumbers numbers) {
    const auto rows = Hdf5Rows::open(file);
    const auto shape = rows ? rows->shape(name) : std::nullopt;
    if (!shape) return std::nullopt;
    auto values = numbers == HdfNumbers::indices ? rows->read_indices(name, 0, shape->rows) : rows->read(name);
    if (!values || values->components() == 1) return values;
    auto owner = std::make_shared<const Array>(*values);
    return Result(Array(values->type(), values->data(), values->size(), 1, std::move(owner)));
}

} // namespace

std::optional<ScalarType> scalar_type_of(hid_t type) {
    const std::size_t size = H5Tget_size(type);
    if (H5Tget_class(type) == H5T_FLOAT)
        return size <= sizeof(float) ? ScalarType::float32 : ScalarType::float64; // others are converted by the library
    if (H5Tget_class(type) != H5T_INTEGER) return std::nullopt;
    const bool is_signed = H5Tget_sign(type) == H5T_SGN_2;
    switch (size) {
    case 1: return is_signed ? ScalarType::int8 : ScalarType::uint8;
    case 2: return is_signed ? ScalarType::int16 : ScalarType::uint16;
    case 4: return is_signed ? ScalarType::int32 : ScalarType::uint32;
    case 8: return is_signed ? ScalarType::int64 : ScalarType::uint64;
    default: return std::nullopt;
    }
}

std::uint64_t ShapedValues::count() const {
    std::uint64_t count = 1;
    for (const std::uint64_t length : dimensions) {
        if (length != 0 && count > too_many / length) return too_many;
        count *= length;
    }
    return count;
}

Result<ShapedValues> read_hdf5_array(const std::string& file, const std::string& name, const Box& box, Depth depth,
                                     HdfNumbers numbers) {
    const auto failed = [&](std::string_view what) {
        return broken(file, fmt::format("data set \"{}\" {}", escaped(name), what));
    };
    const auto opened = open_hdf5(file);
    if (!opened) return opened.error();
    const Handle access(access_inside_file(), H5Pclose);
    const Handle data(H5Dopen2((*opened)->file, name.c_str(), access), H5Dclose);
    if (!data.good()) return failed("is not there, or is a link to another file");
    if (!lies_inside_file(data)) return failed("has its values in another file");
    const Handle stored(H5Dget_type(data), H5Tclose);
    const auto type = scalar_type_of(stored);
    if (!type) return failed("does not hold numbers of 1, 2, 4 or 8 bytes");

    const Handle space(H5Dget_space(data), H5Sclose);
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank < 0) return failed("has no shape");
    std::vector<hsize_t> extent(static_cast<std::size_t>(rank));
    H5Sget_simple_extent_dims(space, extent.data(), nullptr);
    ShapedValues result;
    result.dimensions.assign(extent.begin(), extent.end());
    if (!select(space, box, result.dimensions)) return failed("does not have the part that is wanted of it");
    const std::uint64_t count = result.count();
    if (count == too_many) return failed("is too large");
    result.values = Array(*type, nullptr, 0, 1, nullptr);
    if (depth == Depth::description) return result;
    if (box.count.empty() && (rank == 1 || rank == 2) && count > 0)
        if (auto values = read_whole(file, name, numbers)) {
            if (!*values) return values->error();
            result.values = **std::move(values);
            return result;
        }
    // Of another shape in memory HDF5 would list each row of each chunk.
    const std::vector<hsize_t> shape(result.dimensions.begin(), result.dimensions.end());
    const Handle memory(rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, shape.data(), nullptr), H5Sclose);
    return Array(result.values).visit([&](auto none) -> Result<ShapedValues> {
        using T = typename decltype(none)::value_type;
        std::vector<std::remove_const_t<T>> values(count);
        const HdfRead read = read_written(data, native_type<std::remove_const_t<T>>(), memory, space,
                                          std::as_writable_bytes(std::span(values)));
        if (read == HdfRead::failed) return failed(why_not_read(data));
        if (read == HdfRead::unwritten) return failed("has values that were never written");
        result.values = Array::own(std::move(values));
        return std::move(result);
    });
}

namespace {

struct NamesOfKind {
    H5I_type_t kind;
    std::vector<std::string> names = {};
};

std::vector<std::string> objects_of(const std::string& file, const std::string& group, H5I_type_t kind) {
    NamesOfKind found{kind};
    const auto opened = open_hdf5(file);
    const Handle inside(opened ? H5Gopen2((*opened)->file, group.c_str(), H5P_DEFAULT) : -1, H5Gclose);
    if (!inside.good()) return {};
    const auto add = [](hid_t at, const char* name, const H5L_info_t*, void* data) -> herr_t {
        auto* const to = static_cast<NamesOfKind*>(data);
        const Handle object(H5Oopen(at, name, H5P_DEFAULT), H5Oclose);
        if (object.good() && H5Iget_type(object) == to->kind) to->names.emplace_back(name);
        return 0;
    };
    H5Literate(inside, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &found);
    return found.names;
}

} // namespace

std::vector<std::string> data_sets_of(const std::string& file, const std::string& group) {
    return objects_of(file, group, H5I_DATASET);
}

std::vector<std::string> groups_of(const std::string& file, const std::string& group) {
    return objects_of(file, group, H5I_GROUP);
}

bool is_written(const std::string& file, const std::string& name) {
    const auto opened = open_hdf5(file);
    const Handle data(opened ? H5Dopen2((*opened)->file, name.c_str(), H5P_DEFAULT) : -1, H5Dclose);
    return data.good() && !may_be_unwritten(data);
}

std::vector<double> numbers_attribute(const std::string& file, const std::string& group, const char* name) {
    constexpr hssize_t most = 1024;
    const auto opened = open_hdf5(file);
    if (!opened || H5Aexists_by_name((*opened)->file, group.c_str(), name, H5P_DEFAULT) <= 0) return {};
    const Handle attribute(H5Aopen_by_name((*opened)->file, group.c_str(), name, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    const Handle space(attribute.good() ? H5Aget_space(attribute) : -1, H5Sclose);
    const hssize_t count = space.good() ? H5Sget_simple_extent_npoints(space) : 0;
    if (count < 1 || count > most) return {};
    std::vector<double> values(static_cast<std::size_t>(count));
    if (H5Aread(attribute, H5T_NATIVE_DOUBLE, values.data()) < 0) return {};
    return values;
}

std::optional<std::int64_t> integer_attribute(const std::string& file, const std::string& group, const char* name) {
    const std::vector<double> values = numbers_attribute(file, group, name);
    constexpr double most = 0x1p53;
    if (values.size() != 1 || !(std::abs(values[0]) <= most)) return std::nullopt;
    return static_cast<std::int64_t>(values[0]);
}

namespace {

/// Up to the first zero, without blanks at the end: Fortran pads its texts with them.
std::string unpadded(std::string text) {
    text.resize(std::min(text.find('\0'), text.size()));
    while (!text.empty() && is_space(text.back())) text.pop_back();
    return text;
}

/// One text of any length, as h5py writes texts of Python.
std::string variable_text(hid_t attribute, hid_t type) {
    const Handle space(H5Aget_space(attribute), H5Sclose);
    char* text = nullptr;
    if (!space.good() || H5Sget_simple_extent_npoints(space) != 1 || H5Aread(attribute, type, &text) < 0) return {};
    std::string out = text ? text : "";
    H5Dvlen_reclaim(type, space, H5P_DEFAULT, &text);
    return out;
}

} // namespace

std::string text_attribute(const std::string& file, const std::string& group, const char* name) {
    const auto opened = open_hdf5(file);
    if (!opened || H5Aexists_by_name((*opened)->file, group.c_str(), name, H5P_DEFAULT) <= 0) return {};
    const Handle attribute(H5Aopen_by_name((*opened)->file, group.c_str(), name, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    const Handle type(attribute.good() ? H5Aget_type(attribute) : -1, H5Tclose);
    if (!type.good() || H5Tget_class(type) != H5T_STRING) return {};
    if (H5Tis_variable_str(type) > 0) return unpadded(variable_text(attribute, type));
    constexpr std::size_t most = 1 << 16; // bytes of one attribute in HDF5's usual form
    const std::size_t size = H5Tget_size(type);
    if (size > most || H5Aget_storage_size(attribute) != size) return {}; // or there are several
    std::string text(size, '\0');
    return H5Aread(attribute, type, text.data()) < 0 ? std::string() : unpadded(std::move(text));
}

} // namespace isotet::io::confined
