// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// netCDF in HDF5: variables and dimensions are data sets of their names, a dimension as long as its data set.
#include <utility>

#include <hdf5.h>

#include "io/confined/hdf5/hdf5_array.hpp"
#include "io/confined/hdf5/hdf5_file.hpp"
#include "io/confined/hdf5/hdf5_rows.hpp"
#include "io/confined/netcdf/netcdf_file.hpp"

namespace isotet::io::confined {
namespace {

class NetcdfInHdf5 final : public NetcdfFile {
public:
    NetcdfInHdf5(std::string path, Hdf5Rows rows) : path_(std::move(path)), rows_(std::move(rows)) {}

    std::optional<std::uint64_t> dimension(const std::string& name) const override {
        const auto lengths = shape(name);
        return lengths && lengths->size() == 1 ? std::optional(lengths->front()) : std::nullopt;
    }
    std::optional<std::vector<std::uint64_t>> shape(const std::string& variable) const override {
        auto described = read_hdf5_array(path_, variable, {}, Depth::description);
        if (!described || described->dimensions.empty()) return std::nullopt;
        if (!rows_.shape(variable) && !has_many(described->dimensions)) return std::nullopt;
        return std::move(described->dimensions);
    }
    Result<Array> rows(const std::string& variable, std::uint64_t first, std::uint64_t count) const override {
        if (!rows_.shape(variable))
            if (const auto extents = shape(variable)) return rows_of_many_dimensions(variable, *extents, first, count);
        const auto read = rows_.read(variable, first, count);
        if (!read) return read.error();
        return Array(read->type(), read->data(), read->size(), 1, read->owner().lock());
    }
    std::vector<std::string> texts(const std::string& variable) const override;
    std::optional<std::string> text_attribute(const std::string& variable, const char* name) const override {
        std::string text = isotet::io::confined::text_attribute(path_, object(variable), name);
        return text.empty() ? std::nullopt : std::optional(std::move(text));
    }
    std::optional<double> number_attribute(const std::string& variable, const char* name) const override {
        const auto numbers = numbers_attribute(path_, object(variable), name);
        return numbers.size() == 1 ? std::optional(numbers.front()) : std::nullopt;
    }

private:
    /// More than Hdf5Rows reads.
    static bool has_many(const std::vector<std::uint64_t>& dimensions) { return dimensions.size() > 2; }

    Result<Array> rows_of_many_dimensions(const std::string& variable, std::vector<std::uint64_t> extents,
                                          std::uint64_t first, std::uint64_t count) const {
        Box box{std::vector<std::uint64_t>(extents.size(), 0), std::vector<std::uint64_t>(extents.size(), 1),
                std::move(extents)};
        box.start[0] = first;
        box.count[0] = count;
        auto read = read_hdf5_array(path_, variable, box, Depth::arrays);
        return read ? Result<Array>(std::move(read->values)) : read.error();
    }
    static std::string object(const std::string& variable) { return variable.empty() ? "/" : variable; }

    std::string path_;
    Hdf5Rows rows_;
};

std::vector<std::string> NetcdfInHdf5::texts(const std::string& variable) const {
    constexpr hsize_t most = hsize_t{1} << 26;
    const auto file = open_hdf5(path_);
    const Handle data(file ? H5Dopen2((*file)->file, variable.c_str(), H5P_DEFAULT) : -1, H5Dclose);
    const Handle type(data.good() ? H5Dget_type(data) : -1, H5Tclose);
    const Handle space(data.good() ? H5Dget_space(data) : -1, H5Sclose);
    if (!type.good() || !space.good() || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 ||
        H5Tget_size(type) != 1 || H5Sget_simple_extent_ndims(space) != 2)
        return {};
    hsize_t extent[2] = {0, 0};
    H5Sget_simple_extent_dims(space, extent, nullptr);
    if (extent[0] == 0 || extent[1] == 0 || extent[0] > most / extent[1]) return {};
    std::string all(extent[0] * extent[1], '\0');
    if (H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()) < 0) return {};
    return rows_of_letters(all.data(), extent[0], extent[1]);
}

} // namespace

Result<std::unique_ptr<NetcdfFile>> open_netcdf_hdf5(const std::string& path) {
    auto rows = Hdf5Rows::open(path);
    if (!rows) return rows.error();
    return std::unique_ptr<NetcdfFile>(std::make_unique<NetcdfInHdf5>(path, *std::move(rows)));
}

} // namespace isotet::io::confined
