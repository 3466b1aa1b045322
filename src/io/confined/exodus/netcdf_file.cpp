// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/exodus/netcdf_file.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include <netcdf.h>

namespace isotet::io::confined {
namespace {

constexpr std::uint64_t most_text = std::uint64_t{1} << 26;
constexpr int every_attribute = NC_GLOBAL;

/// The number of values; nothing where it is more than any file holds.
std::optional<std::size_t> number_of_values(std::span<const std::uint64_t> dimensions) {
    constexpr std::uint64_t most = std::uint64_t{1} << 48U;
    std::uint64_t values = 1;
    for (const std::uint64_t size : dimensions) {
        if (size > most || (size > 0 && values > most / size)) return std::nullopt;
        values *= size;
    }
    return static_cast<std::size_t>(values);
}

int get(int file, int variable, const std::size_t* start, const std::size_t* count, std::int32_t* values) {
    return nc_get_vara_int(file, variable, start, count, values);
}
int get(int file, int variable, const std::size_t* start, const std::size_t* count, std::int64_t* values) {
    static_assert(sizeof(long long) == sizeof(std::int64_t));
    return nc_get_vara_longlong(file, variable, start, count, reinterpret_cast<long long*>(values));
}
int get(int file, int variable, const std::size_t* start, const std::size_t* count, float* values) {
    return nc_get_vara_float(file, variable, start, count, values);
}
int get(int file, int variable, const std::size_t* start, const std::size_t* count, double* values) {
    return nc_get_vara_double(file, variable, start, count, values);
}
int get(int file, int variable, const std::size_t* start, const std::size_t* count, char* values) {
    return nc_get_vara_text(file, variable, start, count, values);
}

} // namespace

std::optional<NetcdfFile> NetcdfFile::open(const std::string& path) {
    int number = -1;
    if (nc_open(path.c_str(), NC_NOWRITE, &number) != NC_NOERR) return std::nullopt;
    return NetcdfFile(number);
}

NetcdfFile::NetcdfFile(NetcdfFile&& other) noexcept : number_(std::exchange(other.number_, -1)) {}

NetcdfFile::~NetcdfFile() {
    if (number_ >= 0) nc_close(number_);
}

std::optional<std::uint64_t> NetcdfFile::dimension(const std::string& name) const {
    int id = -1;
    std::size_t length = 0;
    if (nc_inq_dimid(number_, name.c_str(), &id) != NC_NOERR || nc_inq_dimlen(number_, id, &length) != NC_NOERR)
        return std::nullopt;
    return length;
}

int NetcdfFile::variable(const std::string& name) const {
    int id = -1;
    return nc_inq_varid(number_, name.c_str(), &id) == NC_NOERR ? id : -1;
}

std::optional<std::vector<std::uint64_t>> NetcdfFile::shape(const std::string& name) const {
    const int id = variable(name);
    int rank = 0;
    if (id < 0 || nc_inq_varndims(number_, id, &rank) != NC_NOERR) return std::nullopt;
    std::vector<int> dimensions(static_cast<std::size_t>(rank));
    if (nc_inq_vardimid(number_, id, dimensions.data()) != NC_NOERR) return std::nullopt;
    std::vector<std::uint64_t> lengths;
    for (const int of_dimension : dimensions) {
        std::size_t length = 0;
        if (nc_inq_dimlen(number_, of_dimension, &length) != NC_NOERR) return std::nullopt;
        lengths.push_back(length);
    }
    return lengths;
}

template <class T>
bool NetcdfFile::read(const std::string& name, std::span<const std::uint64_t> start,
                      std::span<const std::uint64_t> count, T* values) const {
    const int id = variable(name);
    nc_type type = NC_NAT;
    if (id < 0 || nc_inq_vartype(number_, id, &type) != NC_NOERR || (type == NC_CHAR) != std::is_same_v<T, char>)
        return false;
    const std::vector<std::size_t> first(start.begin(), start.end()), size(count.begin(), count.end());
    return get(number_, id, first.data(), size.data(), values) == NC_NOERR;
}

template <class T>
std::optional<std::vector<T>> NetcdfFile::read(const std::string& name) const {
    const auto dimensions = shape(name);
    if (!dimensions) return std::nullopt;
    const auto size = number_of_values(*dimensions);
    if (!size) return std::nullopt;
    std::vector<T> values(*size);
    const std::vector<std::uint64_t> start(dimensions->size(), 0);
    if (!values.empty() && !read(name, std::span(start), std::span(*dimensions), values.data())) return std::nullopt;
    return values;
}

std::vector<std::string> NetcdfFile::texts(const std::string& name) const {
    const auto dimensions = shape(name);
    if (!dimensions || dimensions->size() != 2) return {};
    const auto [rows, letters] = std::pair((*dimensions)[0], (*dimensions)[1]);
    if (rows == 0 || letters == 0 || rows > most_text / letters) return std::vector<std::string>(rows > most_text ? 0 : rows);
    const auto all = read<char>(name);
    if (!all) return {};
    std::vector<std::string> texts;
    for (std::uint64_t row = 0; row < rows; ++row) {
        std::string& text = texts.emplace_back(all->data() + row * letters, letters);
        text.resize(std::min(text.find('\0'), text.size()));
        text.resize(text.find_last_not_of(' ') + 1);
    }
    return texts;
}

std::optional<std::string> NetcdfFile::text_attribute(const std::string& owner, const char* name) const {
    const int id = owner.empty() ? every_attribute : variable(owner);
    nc_type type = NC_NAT;
    std::size_t length = 0;
    if ((id < 0 && !owner.empty()) || nc_inq_att(number_, id, name, &type, &length) != NC_NOERR || type != NC_CHAR ||
        length > most_text)
        return std::nullopt;
    std::string text(length, '\0');
    if (nc_get_att_text(number_, id, name, text.data()) != NC_NOERR) return std::nullopt;
    text.resize(std::min(text.find('\0'), text.size()));
    return text;
}

std::optional<double> NetcdfFile::number_attribute(const std::string& owner, const char* name) const {
    const int id = owner.empty() ? every_attribute : variable(owner);
    nc_type type = NC_NAT;
    std::size_t length = 0;
    double value = 0;
    if ((id < 0 && !owner.empty()) || nc_inq_att(number_, id, name, &type, &length) != NC_NOERR || type == NC_CHAR ||
        length != 1 || nc_get_att_double(number_, id, name, &value) != NC_NOERR)
        return std::nullopt;
    return value;
}

#define ISOTET_READ_AS(type)                                                                                           \
    template bool NetcdfFile::read(const std::string&, std::span<const std::uint64_t>, std::span<const std::uint64_t>, \
                                   type*) const;                                                                       \
    template std::optional<std::vector<type>> NetcdfFile::read(const std::string&) const;
ISOTET_READ_AS(std::int32_t)
ISOTET_READ_AS(std::int64_t)
ISOTET_READ_AS(float)
ISOTET_READ_AS(double)
#undef ISOTET_READ_AS

} // namespace isotet::io::confined
