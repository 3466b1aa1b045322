// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/med/med_file.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <hdf5.h>

#include "io/files/escape.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::size_t letters_of_group_name = 80, max_attribute_bytes = 1 << 20, max_group_names = 1 << 20;

/// Up to the first NUL, without blanks at the end.
std::string trimmed_text(std::string_view text) {
    text = text.substr(0, text.find('\0'));
    return std::string(text.substr(0, text.find_last_not_of(' ') + 1));
}

/// Reads one number of an attribute.
template <class T>
std::optional<T> number_of_attribute(hid_t file, const std::string& group, const char* name, hid_t type) {
    if (H5Aexists_by_name(file, group.c_str(), name, H5P_DEFAULT) <= 0) return std::nullopt;
    const Handle attribute(H5Aopen_by_name(file, group.c_str(), name, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    const Handle space(attribute.good() ? H5Aget_space(attribute) : -1, H5Sclose);
    T value = 0;
    if (!space.good() || H5Sget_simple_extent_npoints(space) != 1 || H5Aread(attribute, type, &value) < 0)
        return std::nullopt;
    return value;
}

} // namespace

Result<MedFile> MedFile::open(const std::string& path) {
    auto file = open_hdf5(path);
    if (!file) return broken(path, "not a MED file: it is no HDF5 file, or a broken one");
    auto rows = Hdf5Rows::open(path);
    if (!rows) return rows.error();
    MedFile opened(path, *std::move(file), *std::move(rows));
    const auto version = opened.integer("/INFOS_GENERALES", "MAJ");
    if (!version) return opened.wrong("not a MED file: it states no version");
    if (*version < 3)
        return opened.wrong(
            fmt::format("a MED file of version {}.{}, but 3.0 and later are read: medimport converts it", *version,
                        opened.integer("/INFOS_GENERALES", "MIN").value_or(0)));
    return opened;
}

std::vector<std::string> MedFile::groups(const std::string& group) const {
    std::vector<std::string> names;
    if (H5Lexists(file_->file, group.c_str(), H5P_DEFAULT) <= 0) return names;
    const Handle inside(H5Gopen2(file_->file, group.c_str(), H5P_DEFAULT), H5Gclose);
    if (!inside.good()) return names;
    const auto add = [](hid_t at, const char* name, const H5L_info_t*, void* to) -> herr_t {
        const Handle object(H5Oopen(at, name, H5P_DEFAULT), H5Oclose);
        if (object.good() && H5Iget_type(object) == H5I_GROUP)
            static_cast<std::vector<std::string>*>(to)->emplace_back(name);
        return 0;
    };
    H5Literate(inside, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names);
    return names;
}

std::optional<std::int64_t> MedFile::integer(const std::string& group, const char* name) const {
    return number_of_attribute<std::int64_t>(file_->file, group, name, H5T_NATIVE_INT64);
}

std::optional<double> MedFile::real(const std::string& group, const char* name) const {
    return number_of_attribute<double>(file_->file, group, name, H5T_NATIVE_DOUBLE);
}

std::string MedFile::text(const std::string& group, const char* name) const {
    if (H5Aexists_by_name(file_->file, group.c_str(), name, H5P_DEFAULT) <= 0) return {};
    const Handle attribute(H5Aopen_by_name(file_->file, group.c_str(), name, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    const Handle type(attribute.good() ? H5Aget_type(attribute) : -1, H5Tclose);
    if (!type.good() || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0) return {};
    const std::size_t size = H5Tget_size(type);
    if (size > max_attribute_bytes || H5Aget_storage_size(attribute) > size) return {};
    std::string text(size, '\0');
    return H5Aread(attribute, type, text.data()) < 0 ? std::string() : trimmed_text(text);
}

std::vector<std::string> MedFile::texts(const std::string& data_set) const {
    const Handle data(H5Dopen2(file_->file, data_set.c_str(), H5P_DEFAULT), H5Dclose);
    const Handle type(data.good() ? H5Dget_type(data) : -1, H5Tclose);
    const Handle space(data.good() ? H5Dget_space(data) : -1, H5Sclose);
    if (!type.good() || !space.good() || H5Tget_size(type) != letters_of_group_name) return {};
    const H5T_class_t kind = H5Tget_class(type);
    const bool fixed = kind == H5T_STRING && H5Tis_variable_str(type) == 0;
    const Handle letter(kind == H5T_ARRAY ? H5Tget_super(type) : -1, H5Tclose);
    if (!fixed && !(letter.good() && H5Tget_class(letter) == H5T_INTEGER && H5Tget_size(letter) == 1)) return {};
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    if (count <= 0 || static_cast<std::size_t>(count) > max_group_names) return {};
    std::string all(static_cast<std::size_t>(count) * letters_of_group_name, '\0');
    if (H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()) < 0) return {};
    std::vector<std::string> names;
    for (std::size_t at = 0; at < all.size(); at += letters_of_group_name)
        names.push_back(trimmed_text(std::string_view(all).substr(at, letters_of_group_name)));
    return names;
}

Result<void> MedFile::check(const std::string& data_set, std::uint64_t count) const {
    const auto known = rows_.shape(data_set);
    if (!known || known->columns != 1) return wrong(fmt::format("\"{}\" is no list of numbers", escaped(data_set)));
    if (known->rows != count)
        return wrong(fmt::format("\"{}\" has {} numbers, but {} are needed", escaped(data_set), known->rows, count));
    return {};
}

Result<Array> MedFile::numbers(const std::string& data_set, std::uint64_t count, std::uint64_t first,
                               std::uint64_t some) const {
    if (auto there = check(data_set, count); !there) return there.error();
    return rows_.read(data_set, first, some);
}

Result<void> MedFile::each_block(const std::string& data_set, std::uint64_t count, const Hdf5Rows::Visit& visit) const {
    if (auto there = check(data_set, count); !there) return there;
    return rows_.each_block(data_set, 0, count, visit);
}

std::vector<MedStep> med_steps(const MedFile& file, const std::string& group) {
    std::vector<MedStep> steps;
    for (const std::string& name : file.groups(group)) {
        const std::string inside = group + "/" + name;
        const auto number = file.integer(inside, "NDT"), iteration = file.integer(inside, "NOR");
        if (!number || !iteration) continue;
        const double time = file.real(inside, "PDT").value_or(0);
        steps.push_back({*number, *iteration, std::isnan(time) ? 0 : time, inside});
    }
    std::ranges::stable_sort(steps, {}, &MedStep::key);
    return steps;
}

} // namespace isotet::io::confined
