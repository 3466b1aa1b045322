// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// netCDF classic: its header tells where each variable begins and how large it is, so the length that the file must
// have is known. (The library itself returns zeros beyond the end.) Format: NetCDF Classic Format Specification,
// Unidata.
#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/core.h>

#include "io/confined/length_check.hpp"
#include "io/pieces/loaded.hpp"
#include "io/confined/mapped_file.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::uint64_t enough = std::uint64_t(1) << 60;

/// Walks through the header; big-endian; after the first thing that does not fit it only fails.
class HeaderWalk {
public:
    HeaderWalk(std::string_view bytes, int version) : bytes_(bytes), version_(version) {}

    std::uint64_t big_endian(unsigned size) {
        if (bytes_.size() - at_ < size) return fail();
        std::uint64_t value = 0;
        for (unsigned i = 0; i < size; ++i) value = value << 8 | static_cast<unsigned char>(bytes_[at_++]);
        return value;
    }
    std::uint64_t count() { return big_endian(version_ == 5 ? 8 : 4); }
    std::uint64_t place() { return big_endian(version_ == 1 ? 4 : 8); }
    std::uint64_t tag() { return big_endian(4); }
    void skip(std::uint64_t size) {
        if (size > bytes_.size() - at_) fail();
        else at_ += size;
    }
    void skip_padded(std::uint64_t size) { skip(size > enough ? enough : (size + 3) / 4 * 4); }
    std::uint64_t fail() {
        good_ = false;
        at_ = bytes_.size();
        return 0;
    }
    bool good() const { return good_; }
    /// More elements than bytes are left cannot be.
    bool plausible(std::uint64_t elements) {
        if (elements > bytes_.size() - at_) fail();
        return good_;
    }

private:
    std::string_view bytes_;
    int version_;
    std::size_t at_ = 4;
    bool good_ = true;
};

std::uint64_t size_of_type(std::uint64_t type) {
    constexpr std::uint64_t sizes[] = {0, 1, 1, 2, 4, 4,
                                       8, 1, 2, 4, 8, 8}; // byte char short int float double ubyte ...
    return type < std::size(sizes) ? sizes[type] : 0;
}

void skip_attributes(HeaderWalk& walk) {
    walk.tag();
    const std::uint64_t attributes = walk.count();
    for (std::uint64_t i = 0; i < attributes && walk.plausible(attributes - i); ++i) {
        walk.skip_padded(walk.count()); // name
        const std::uint64_t size = size_of_type(walk.tag());
        const std::uint64_t values = walk.count();
        if (size == 0 || values > enough / 8) walk.fail();
        else walk.skip_padded(size * values);
    }
}

struct Variable {
    bool record = false;
    std::uint64_t size = 0; ///< bytes; of a record variable: in one record
    std::uint64_t begin = 0;
};

std::optional<Variable> walk_variable(HeaderWalk& walk, const std::vector<std::uint64_t>& dimensions) {
    Variable variable;
    walk.skip_padded(walk.count()); // name
    const std::uint64_t rank = walk.count();
    std::uint64_t elements = 1;
    for (std::uint64_t i = 0; i < rank && walk.plausible(rank - i); ++i) {
        const std::uint64_t dimension = walk.count();
        if (dimension >= dimensions.size()) return std::nullopt;
        const std::uint64_t length = dimensions[dimension];
        if (length == 0 && i == 0) variable.record = true; // the unlimited dimension has length 0
        else if (length != 0 && elements > enough / length) return std::nullopt;
        else elements *= length;
    }
    skip_attributes(walk);
    const std::uint64_t size = size_of_type(walk.tag());
    walk.count(); // vsize: not reliable for large variables
    variable.begin = walk.place();
    if (!walk.good() || size == 0 || variable.begin > enough || elements > enough / 8) return std::nullopt;
    variable.size = elements * size;
    return variable;
}

/// Bytes that the file must have; nothing when the header is broken.
std::optional<std::uint64_t> needed_length(std::string_view bytes, int version) {
    HeaderWalk walk(bytes, version);
    const std::uint64_t records = walk.count();
    const bool streaming = records == (version == 5 ? ~std::uint64_t(0) : 0xFFFFFFFFu);
    walk.tag();
    std::vector<std::uint64_t> dimensions;
    const std::uint64_t dimension_count = walk.count();
    for (std::uint64_t i = 0; i < dimension_count && walk.plausible(dimension_count - i); ++i) {
        walk.skip_padded(walk.count());
        dimensions.push_back(walk.count());
    }
    skip_attributes(walk);
    walk.tag();
    std::vector<Variable> variables;
    const std::uint64_t variable_count = walk.count();
    for (std::uint64_t i = 0; i < variable_count && walk.plausible(variable_count - i); ++i) {
        const auto variable = walk_variable(walk, dimensions);
        if (!variable) return std::nullopt;
        variables.push_back(*variable);
    }
    if (!walk.good()) return std::nullopt;

    const auto record_variables =
        std::count_if(variables.begin(), variables.end(), [](const Variable& v) { return v.record; });
    std::uint64_t record_size = 0; // a lone record variable is not padded
    for (const Variable& variable : variables)
        if (variable.record) record_size += record_variables == 1 ? variable.size : (variable.size + 3) / 4 * 4;
    std::uint64_t needed = 0;
    for (const Variable& variable : variables) {
        std::uint64_t end = variable.begin + variable.size;
        if (variable.record && (records == 0 || streaming)) continue;
        if (variable.record) {
            if (record_size != 0 && records - 1 > enough / record_size) return std::nullopt;
            end += (records - 1) * record_size;
        }
        needed = std::max(needed, end);
    }
    return needed;
}

} // namespace

Result<void> check_netcdf_length(const std::string& path) {
    auto file = MappedFile::open(path);
    if (!file) return file.error();
    const std::string_view bytes = file->text();
    if (bytes.size() < 4 || !bytes.starts_with("CDF")) return {};
    const int version = bytes[3];
    if (version != 1 && version != 2 && version != 5) return {};
    const auto needed = needed_length(bytes, version);
    if (!needed) return broken(path, "its netCDF header is broken or cut short");
    if (*needed > bytes.size())
        return broken(path, fmt::format("the file has {} bytes, but its header needs {}: it is cut short", bytes.size(),
                                        *needed));
    return {};
}

} // namespace isotet::io::confined
