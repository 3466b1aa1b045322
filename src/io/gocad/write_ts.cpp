// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Gocad TSurf (.ts): one object, point fields as properties, NaN as a no-data value.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include "io/write/write_formats.hpp"
#include "io/write/write_names.hpp"
#include "io/write/write_text.hpp"

namespace isotet::io {
namespace {

/// A property: a point field as float32 or float64, with what stands for NaN.
struct Property {
    std::string name;
    Column column;
    double no_data = -99999;
};

/// The column's scalars of rows [begin, end) as doubles.
std::vector<double> doubles_of(const Column& column, std::size_t begin, std::size_t end) {
    std::vector<std::byte> bytes((end - begin) * column.tuple_bytes());
    column.fill(begin, end, bytes.data());
    const Array array(column.type, bytes.data(), end - begin, column.components, nullptr);
    return array.visit([](auto values) { return std::vector<double>(values.begin(), values.end()); });
}

/// The first of -99999, -999999, ... below every value, so that no value is taken for no data.
double choose_no_data(const Column& column) {
    constexpr std::size_t piece = 65536;
    double lowest = std::numeric_limits<double>::infinity();
    for (std::size_t begin = 0; begin < column.tuples; begin += piece) {
        for (const double value : doubles_of(column, begin, std::min(column.tuples, begin + piece))) {
            if (std::isfinite(value)) lowest = std::min(lowest, value);
        }
    }
    double candidate = -99999;
    while (candidate >= lowest && std::isfinite(candidate * 10)) candidate = candidate * 10 - 9;
    return candidate;
}

std::string properties_header(const std::vector<Property>& properties) {
    if (properties.empty()) return {};
    std::string names = "PROPERTIES", no_data = "NO_DATA_VALUES", sizes = "ESIZES";
    for (const auto& property : properties) {
        names += fmt::format(" \"{}\"", property.name);
        no_data += fmt::format(" {}", property.no_data);
        sizes += fmt::format(" {}", property.column.components);
    }
    return fmt::format("{}\n{}\n{}\n", names, no_data, sizes);
}

} // namespace

Result<WriteReport> write_ts(const SurfaceToWrite& input) {
    const auto& columns = input.columns;
    std::vector<Property> properties;
    Names names;
    for (const auto& field : columns.point_fields) {
        properties.push_back({take_name(gocad_name(field.name), names), field, choose_no_data(field)});
        if (is_floating(field.type)) continue;
        Column& column = properties.back().column;
        column.type = ScalarType::float64;
        column.fill = [&field](std::size_t begin, std::size_t end, std::byte* out) {
            std::ranges::copy(doubles_of(field, begin, end), reinterpret_cast<double*>(out));
        };
    }
    note_left_out(input, "TSurf", {&columns.edges, &columns.cell_fields});
    if (columns.point_normals || columns.cell_normals)
        input.notes.push_back("TSurf holds no normals: they were left out");

    constexpr std::uint64_t line = 40;
    return write_file(
        input.path, input.progress, (columns.positions.tuples + columns.triangles.tuples) * line,
        [&](WriteStream& stream) {
            stream.text("GOCAD TSurf 1\nHEADER {\nname:isosurface\n}\n"
                        "GOCAD_ORIGINAL_COORDINATE_SYSTEM\nNAME Default\nAXIS_NAME \"X\" \"Y\" \"Z\"\nAXIS_UNIT \"m\" "
                        "\"m\" \"m\"\n"
                        "ZPOSITIVE Elevation\nEND_ORIGINAL_COORDINATE_SYSTEM\n");
            stream.text(properties_header(properties));
            stream.text("TFACE\n");
            stream.rows(columns.positions.tuples, [&](std::size_t begin, std::size_t end, std::string& out) {
                const FloatRows positions(columns.positions, begin, end);
                std::vector<std::vector<double>> values;
                for (const auto& property : properties) values.push_back(doubles_of(property.column, begin, end));
                for (std::size_t i = begin; i < end; ++i) {
                    out += properties.empty() ? "VRTX " : "PVRTX ";
                    append_number(out, i + 1);
                    positions.append(out, i);
                    for (std::size_t p = 0; p < properties.size(); ++p) {
                        const auto& property = properties[p];
                        const std::size_t components = property.column.components;
                        for (std::size_t k = 0; k < components; ++k) {
                            const double value = values[p][(i - begin) * components + k];
                            out += ' ';
                            if (std::isnan(value)) append_number(out, property.no_data);
                            else if (property.column.type == ScalarType::float32)
                                append_number(out, static_cast<float>(value));
                            else append_number(out, value);
                        }
                    }
                    out += '\n';
                }
            });
            stream.rows(columns.triangles.tuples, [&](std::size_t begin, std::size_t end, std::string& out) {
                const auto corners = corners_of(input.surface.triangles, begin, end);
                for (std::size_t i = 0; i < corners.size(); ++i) {
                    out += i % 3 == 0 ? "TRGL " : " ";
                    append_number(out, corners[i] + 1);
                    if (i % 3 == 2) out += '\n';
                }
            });
            stream.text("END\n");
        });
}

} // namespace isotet::io
