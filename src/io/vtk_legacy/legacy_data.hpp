// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// POINT_DATA, CELL_DATA, FIELD and METADATA of legacy VTK files.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <isotet/result.hpp>

#include "io/vtk_legacy/legacy_values.hpp"
#include "io/vtk_legacy/legacy_vtk.hpp"

namespace isotet::io {

/// Puts what it reads into a LegacyFile. What is wrong with one array is written down there, and reading goes on at the
/// next section: in ascii files at the next line that begins one; in binary ones where the size of the array tells, else
/// the rest of the file is not read.
class LegacyData {
public:
    LegacyData(LegacyValues& values, const LegacyWants& wants, LegacyFile& file)
        : values_(values), scanner_(values.scanner()), wants_(wants), file_(file) {}

    /// True for the keywords that read() knows, in lower case.
    static bool is_section(std::string_view keyword);

    /// Behind the keyword.
    ///
    /// Errors   of the source; cancelled; invalid_data where points or cells would be lost
    Result<void> read(const std::string& keyword);

    /// Where a word stands that begins no section.
    Result<void> read_unknown(const std::string& keyword);

    /// What was read last has so many components, which METADATA may name.
    void expect_names(std::uint64_t components) {
        names_ = components;
        last_is_found_ = false;
    }

    /// Announces the arrays, leaves out those that do not fit the grid or have no name; of two of one name the last counts.
    void finish();

private:
    enum class Data : std::uint8_t { none, points, cells };

    /// What a file says before the values of an array.
    struct Header {
        std::string name, type; ///< the type in lower case
        std::uint64_t components = 1, tuples = 0;
        bool normals = false, colors = false;
        std::uint64_t left_in_field = 0; ///< so many arrays of a FIELD are still to come
    };
    struct Found {
        Association association;
        Attribute attribute;
        bool wanted;
        ScalarType type;
        std::uint64_t components, tuples;
        std::optional<ValuesInFile> in_file = {};
    };

    Result<void> read_section(const std::string& keyword);
    Result<void> start_data(Data data);
    Result<void> read_scalars();
    Result<void> read_named(std::uint64_t components, bool normals);
    Result<void> read_lookup_table();
    Result<void> read_color_scalars();
    Result<void> read_texture_coordinates();
    Result<void> read_field();
    Result<bool> read_array_of_field(std::uint64_t left);
    Result<void> read_array(const Header& header);
    Result<void> skip_strings(const Header& header);
    Result<void> skip_unknown_type(const Header& header);
    void read_metadata();
    void order_as_named(std::span<const std::string> names);
    void skip_information();

    std::vector<std::string> words_of_line(std::size_t most);
    std::string read_name(std::size_t behind);
    std::size_t words_behind_name();
    bool begins_section();
    bool begins_array();
    bool goes_on(std::size_t position, std::uint64_t left_in_field);
    bool seek_next(std::uint64_t left_in_field);
    bool has_geometry() const;

    Association association() const { return data_ == Data::cells ? Association::cell : Association::point; }
    bool may_stay(const std::string& name, const LegacyType& type, const Header& header) const;
    bool may_go_on(const Error& error) const;
    void leave_out_array(const Header& header, std::string reason);
    Result<void> go_on_behind(std::uint64_t left_in_field, const Error& error);
    Result<void> lose(const std::string& word, std::uint64_t left_in_field, const Error& error);

    LegacyValues& values_;
    SourceScanner& scanner_;
    const LegacyWants& wants_;
    LegacyFile& file_;
    Data data_ = Data::none;
    std::uint64_t tuples_ = 0, names_ = 0;
    std::size_t faults_ = 0;
    bool unread_ = false; ///< the rest of the file
    std::vector<Found> found_;
    bool last_is_found_ = false;                               ///< METADATA is of the last one
    std::vector<std::pair<Association, std::string>> scalars_; ///< names of SCALARS
};

} // namespace isotet::io
