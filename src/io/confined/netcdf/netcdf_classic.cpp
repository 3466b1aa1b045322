// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// netCDF classic: a header that tells where each variable begins and how large it is, then the variables, big-endian. Source:
// NetCDF Classic Format Specification, Unidata.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <map>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "base/buffer.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "io/confined/netcdf/netcdf_file.hpp"
#include "io/files/byte_source.hpp"
#include "io/files/escape.hpp"
#include "io/files/first_error.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::uint64_t enough = std::uint64_t(1) << 60;

enum class NetcdfType : std::uint8_t {
    none,
    int8,
    letters,
    int16,
    int32,
    float32,
    float64,
    uint8,
    uint16,
    uint32,
    int64,
    uint64
};

NetcdfType type_of_tag(std::uint64_t tag) {
    return tag <= static_cast<std::uint64_t>(NetcdfType::uint64) ? static_cast<NetcdfType>(tag) : NetcdfType::none;
}

std::uint64_t size_of_type(NetcdfType type) {
    constexpr std::uint64_t sizes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    return sizes[static_cast<std::size_t>(type)];
}

/// Nothing: it holds no numbers.
std::optional<ScalarType> number_type_of(NetcdfType type) {
    switch (type) {
    case NetcdfType::int8: return ScalarType::int8;
    case NetcdfType::int16: return ScalarType::int16;
    case NetcdfType::int32: return ScalarType::int32;
    case NetcdfType::float32: return ScalarType::float32;
    case NetcdfType::float64: return ScalarType::float64;
    case NetcdfType::uint8: return ScalarType::uint8;
    case NetcdfType::uint16: return ScalarType::uint16;
    case NetcdfType::uint32: return ScalarType::uint32;
    case NetcdfType::int64: return ScalarType::int64;
    case NetcdfType::uint64: return ScalarType::uint64;
    case NetcdfType::none:
    case NetcdfType::letters: break;
    }
    return std::nullopt;
}

template <class T>
T big_endian_value(const char* bytes) {
    std::array<char, sizeof(T)> own{};
    std::memcpy(own.data(), bytes, sizeof(T));
    if constexpr (std::endian::native == std::endian::little) std::ranges::reverse(own);
    return std::bit_cast<T>(own);
}

struct NetcdfAttribute {
    NetcdfType type = NetcdfType::none;
    std::string bytes;
};
using NetcdfAttributes = std::map<std::string, NetcdfAttribute, std::less<>>;

struct NetcdfVariable {
    std::vector<std::uint64_t> dimensions; ///< the first one of a record variable is the number of records
    bool is_record = false;
    NetcdfType type = NetcdfType::none;
    std::uint64_t row = 0; ///< bytes of one place of the first dimension
    std::uint64_t begin = 0;
    std::uint64_t stride = 0; ///< bytes from one place of the first dimension to the next
    NetcdfAttributes attributes;
};

struct NetcdfHeader {
    std::uint64_t records = 0;
    std::uint64_t records_cut_off = 0; ///< not in `records`
    std::string record_dimension;
    std::map<std::string, std::uint64_t, std::less<>> dimensions;
    std::map<std::string, NetcdfVariable, std::less<>> variables;
    NetcdfAttributes attributes;
};

/// Walks through the header; after the first thing that does not fit it only fails.
class NetcdfHeaderWalk {
public:
    /// `bytes`      from the beginning of the file on
    /// `file_size`   of all of it
    NetcdfHeaderWalk(std::string_view bytes, int version, std::uint64_t file_size)
        : bytes_(bytes), version_(version), file_size_(file_size) {}

    /// Nothing where the header is broken, or longer than the bytes.
    std::optional<NetcdfHeader> walk() {
        NetcdfHeader header;
        const std::uint64_t records = count();
        const bool is_streamed = records == (version_ == 5 ? ~std::uint64_t(0) : 0xFFFFFFFFU);
        walk_dimensions(header);
        header.attributes = walk_attributes();
        big_endian(4); // that variables follow
        std::vector<NetcdfVariable*> of_records;
        const std::uint64_t variables = count();
        for (std::uint64_t i = 0; i < variables && plausible(variables - i); ++i) {
            NetcdfVariable& variable = header.variables[name()];
            variable = walk_variable();
            if (variable.is_record) of_records.push_back(&variable);
        }
        if (good_) place_records(header, of_records, is_streamed ? std::nullopt : std::optional(records));
        return good_ ? std::optional(std::move(header)) : std::nullopt;
    }

private:
    std::uint64_t big_endian(unsigned size) {
        if (bytes_.size() - at_ < size) return fail();
        std::uint64_t value = 0;
        for (unsigned i = 0; i < size; ++i) value = value << 8 | static_cast<unsigned char>(bytes_[at_++]);
        return value;
    }
    std::uint64_t count() { return big_endian(version_ == 5 ? 8 : 4); }
    std::uint64_t place() { return big_endian(version_ == 1 ? 4 : 8); }
    std::string_view padded(std::uint64_t size) {
        const std::uint64_t whole = size > enough ? enough : (size + 3) / 4 * 4;
        if (whole > bytes_.size() - at_) {
            fail();
            return {};
        }
        const std::string_view found = bytes_.substr(at_, size);
        at_ += whole;
        return found;
    }
    std::string name() { return std::string(padded(count())); }
    std::uint64_t fail() {
        good_ = false;
        at_ = bytes_.size();
        return 0;
    }
    /// More elements than bytes are left cannot be.
    bool plausible(std::uint64_t elements) {
        if (elements > bytes_.size() - at_) fail();
        return good_;
    }

    void walk_dimensions(NetcdfHeader& header) {
        big_endian(4); // that dimensions follow
        const std::uint64_t dimensions = count();
        for (std::uint64_t i = 0; i < dimensions && plausible(dimensions - i); ++i) {
            const std::string own = name();
            lengths_.push_back(count());
            header.dimensions[own] = lengths_.back();
            if (lengths_.back() == 0) header.record_dimension = own;
        }
    }

    NetcdfAttributes walk_attributes() {
        NetcdfAttributes found;
        big_endian(4); // that attributes follow
        const std::uint64_t attributes = count();
        for (std::uint64_t i = 0; i < attributes && plausible(attributes - i); ++i) {
            const std::string own = name();
            const NetcdfType type = type_of_tag(big_endian(4));
            const std::uint64_t values = count();
            if (type == NetcdfType::none || values > enough / 8) fail();
            else found[own] = {type, std::string(padded(size_of_type(type) * values))};
        }
        return found;
    }

    NetcdfVariable walk_variable() {
        NetcdfVariable variable;
        const std::uint64_t rank = count();
        std::uint64_t elements = 1;
        for (std::uint64_t i = 0; i < rank && plausible(rank - i); ++i) {
            const std::uint64_t dimension = count();
            if (dimension >= lengths_.size()) return fail(), variable;
            const std::uint64_t length = lengths_[dimension];
            variable.dimensions.push_back(length);
            if (i == 0) variable.is_record = length == 0; // the unlimited dimension has length 0
            else if (length != 0 && elements > enough / length) return fail(), variable;
            else elements *= length;
        }
        variable.attributes = walk_attributes();
        variable.type = type_of_tag(big_endian(4));
        count(); // the size of the variable: not reliable for large ones
        variable.begin = place();
        if (variable.type == NetcdfType::none || variable.begin > enough || elements > enough / 8) fail();
        variable.row = variable.stride = elements * size_of_type(variable.type);
        return variable;
    }

    /// Records hold a row of each of their variables, each filled up to 4 bytes unless it is the only one.
    void place_records(NetcdfHeader& header, const std::vector<NetcdfVariable*>& of_records,
                       std::optional<std::uint64_t> records) {
        std::uint64_t size = 0, begin = file_size_;
        for (const NetcdfVariable* variable : of_records) {
            size += of_records.size() == 1 ? variable->row : (variable->row + 3) / 4 * 4;
            begin = std::min(begin, variable->begin);
            if (size > enough) return void(fail());
        }
        header.records = records ? *records : size == 0 ? 0 : (file_size_ - begin) / size;
        if (!header.record_dimension.empty()) header.dimensions[header.record_dimension] = header.records;
        for (NetcdfVariable* variable : of_records) {
            variable->dimensions.front() = header.records;
            variable->stride = size;
        }
    }

    std::string_view bytes_;
    int version_;
    std::uint64_t file_size_;
    std::size_t at_ = 4;
    bool good_ = true;
    std::vector<std::uint64_t> lengths_;
};

/// Bytes that the file must have; nothing where it is more than a file can have.
std::optional<std::uint64_t> needed_length(const NetcdfHeader& header) {
    std::uint64_t needed = 0;
    for (const auto& [name, variable] : header.variables) {
        const std::uint64_t rows = variable.dimensions.empty() ? 1 : variable.dimensions.front();
        if (rows == 0) continue;
        if (variable.stride != 0 && rows - 1 > enough / variable.stride) return std::nullopt;
        needed = std::max(needed, variable.begin + (rows - 1) * variable.stride + variable.row);
    }
    return needed;
}

/// Drops the last records where a file of so many bytes ends before them, unless it has no whole one.
void drop_records_cut_off(NetcdfHeader& header, std::uint64_t file_size) {
    std::uint64_t whole = header.records;
    for (const auto& [name, variable] : header.variables) {
        if (!variable.is_record || variable.stride == 0) continue;
        const std::uint64_t first_end = variable.begin + variable.row;
        whole = std::min(whole, first_end > file_size ? 0 : (file_size - first_end) / variable.stride + 1);
    }
    if (whole == 0 || whole == header.records) return;
    header.records_cut_off = header.records - whole;
    header.records = header.dimensions[header.record_dimension] = whole;
    for (auto& [name, variable] : header.variables)
        if (variable.is_record) variable.dimensions.front() = whole;
}

class NetcdfClassic final : public NetcdfFile {
public:
    NetcdfClassic(std::string path, ByteSource file, NetcdfHeader header)
        : path_(std::move(path)), file_(std::move(file)), header_(std::move(header)) {}

    std::optional<std::uint64_t> dimension(const std::string& name) const override {
        const auto found = header_.dimensions.find(name);
        return found == header_.dimensions.end() ? std::nullopt : std::optional(found->second);
    }
    std::optional<std::vector<std::uint64_t>> shape(const std::string& name) const override {
        const NetcdfVariable* const found = variable(name);
        if (!found || !number_type_of(found->type)) return std::nullopt;
        return found->dimensions;
    }
    Result<Array> rows(const std::string& name, std::uint64_t first, std::uint64_t count) const override;
    std::vector<std::string> texts(const std::string& name) const override {
        const NetcdfVariable* const found = variable(name);
        if (!found || found->type != NetcdfType::letters || found->dimensions.size() != 2 || found->is_record)
            return {};
        std::string letters(found->dimensions[0] * found->row, '\0');
        if (!file_.read(found->begin, std::as_writable_bytes(std::span(letters)))) return {};
        return rows_of_letters(letters.data(), found->dimensions[0], found->dimensions[1]);
    }
    std::optional<std::string> text_attribute(const std::string& name, const char* attribute) const override {
        const NetcdfAttribute* const found = this->attribute(name, attribute);
        if (!found || found->type != NetcdfType::letters) return std::nullopt;
        return found->bytes.substr(0, found->bytes.find('\0'));
    }
    std::optional<double> number_attribute(const std::string& name, const char* attribute) const override {
        const NetcdfAttribute* const found = this->attribute(name, attribute);
        const auto type = found ? number_type_of(found->type) : std::nullopt;
        if (!type || found->bytes.size() != size_of(*type)) return std::nullopt;
        return Array(*type, nullptr, 0, 1, nullptr).visit([&]<class T>(std::span<const T>) {
            return std::optional(static_cast<double>(big_endian_value<T>(found->bytes.data())));
        });
    }

    std::uint64_t records_cut_off() const override { return header_.records_cut_off; }

private:
    const NetcdfVariable* variable(const std::string& name) const {
        const auto found = header_.variables.find(name);
        return found == header_.variables.end() ? nullptr : &found->second;
    }
    const NetcdfAttribute* attribute(const std::string& name, const char* attribute) const {
        const NetcdfVariable* const owner = variable(name);
        if (!name.empty() && !owner) return nullptr;
        const NetcdfAttributes& all = owner ? owner->attributes : header_.attributes;
        const auto found = all.find(attribute);
        return found == all.end() ? nullptr : &found->second;
    }

    std::string path_;
    ByteSource file_;
    NetcdfHeader header_;
};

Result<Array> NetcdfClassic::rows(const std::string& name, std::uint64_t first, std::uint64_t count) const {
    constexpr std::size_t at_once = std::size_t{1} << 16;
    const NetcdfVariable* const found = variable(name);
    const auto type = found ? number_type_of(found->type) : std::nullopt;
    if (!type || found->dimensions.empty() || first > found->dimensions[0] || count > found->dimensions[0] - first)
        return broken(path_,
                      fmt::format("the variable \"{}\" is not there, or has not all that is wanted", escaped(name)));
    const std::uint64_t bytes = count * found->row, row = found->row / size_of(*type);
    if (auto room = core::require_memory("reading a variable", bytes); !room) return room.error();
    const bool together = found->stride == found->row; // no other variables between the rows
    return Array(*type, nullptr, 0, 1, nullptr).visit([&]<class T>(std::span<const T>) -> Result<Array> {
        core::Buffer<T> values(count * row);
        FirstError failed;
        core::parallel_ranges(values.size(), at_once, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin, more = 0; i < end && !failed; i += more) {
                more = together ? end - i : std::min<std::size_t>(end - i, row - i % row);
                const std::span<T> part(values.data() + i, more);
                const std::uint64_t place = found->begin + (first + i / row) * found->stride + i % row * sizeof(T);
                if (auto read = file_.read(place, std::as_writable_bytes(part)); !read) failed.add(begin, read.error());
                for (T& value : part) value = big_endian_value<T>(reinterpret_cast<const char*>(&value));
            }
        });
        if (auto done = failed.result(); !done) return in_file(path_, done.error());
        return std::move(values).to_array();
    });
}

/// Reads so much of the file as the header takes; nothing where it is broken.
Result<std::optional<NetcdfHeader>> read_netcdf_header(const ByteSource& file) {
    constexpr std::size_t most = std::size_t{64} << 20;
    Scratch scratch;
    for (std::size_t size = std::size_t{1} << 16;; size *= 8) {
        const auto bytes = file.view(0, std::min(size, file.size()), scratch);
        if (!bytes) return bytes.error();
        const int version = bytes->size() < 4 || !bytes->starts_with("CDF") ? 0 : (*bytes)[3];
        if (version != 1 && version != 2 && version != 5) return Error{ErrorCode::invalid_data, "it is no netCDF file"};
        auto header = NetcdfHeaderWalk(*bytes, version, file.size()).walk();
        if (header || size >= std::min(most, file.size())) return header;
    }
}

} // namespace

Result<std::unique_ptr<NetcdfFile>> open_netcdf_classic(const std::string& path, ByteSource file) {
    auto header = read_netcdf_header(file);
    if (!header) return in_file(path, header.error());
    if (*header) drop_records_cut_off(**header, file.size());
    const auto needed = *header ? needed_length(**header) : std::nullopt;
    if (!needed) return broken(path, "its netCDF header is broken or cut short");
    if (*needed > file.size())
        return broken(
            path, fmt::format("the file has {} bytes, but its header needs {}: it is cut short", file.size(), *needed));
    return std::unique_ptr<NetcdfFile>(std::make_unique<NetcdfClassic>(path, std::move(file), **std::move(header)));
}

} // namespace isotet::io::confined
