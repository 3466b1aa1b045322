// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Gocad TSurf (.ts): VRTX, PVRTX, ATOM, PATOM, TRGL; properties, no-data values, several objects and faces.
#include <array>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "io/files/pace.hpp"
#include "io/files/scalars.hpp"
#include "io/pieces/number_map.hpp"
#include "io/surfaces/surface_parts.hpp"

namespace isotet::io {
namespace {

constexpr std::size_t max_property_components = 1U << 16U;
// Values that are not there, for each byte of the file: else a small file could fill any memory.
constexpr std::uint64_t max_absent = 8;

struct PointProperty {
    std::string name;
    std::size_t components = 1;
    bool has_no_data = false;
    double no_data = 0;
    std::vector<double> values;
};

/// One object of the file, between "GOCAD TSurf" and END.
class ObjectReader {
public:
    ObjectReader(TextScanner& scanner, Pace& pace)
        : scanner_(scanner), pace_(pace), absent_left_((scanner.position() + scanner.left()) * max_absent) {}

    Result<Surface> read() {
        for (;;) {
            if (scanner_.at_end()) return invalid_data("the file ends before END");
            const auto keyword = scanner_.word_of_line();
            if (keyword == "END") break;
            if (auto line = read_line(keyword); !line) return line.error();
            scanner_.next_line();
            if (!pace_.goes_on(scanner_.position())) return Pace::cancelled();
        }
        scanner_.next_line();
        return finish();
    }

private:
    Result<void> read_line(std::string_view keyword) {
        if (keyword == "VRTX" || keyword == "PVRTX") return read_vertex(keyword);
        if (keyword == "ATOM" || keyword == "PATOM") return read_atom(keyword);
        if (keyword == "TRGL") return read_triangle();
        if (keyword == "PROPERTIES") return read_properties();
        if (keyword == "ESIZES") return read_sizes();
        if (keyword == "NO_DATA_VALUES") return read_no_data();
        if (keyword == "ZPOSITIVE") z_sign_ = scanner_.word_of_line() == "Depth" ? -1 : 1;
        return {};
    }

    Result<void> read_properties() {
        if (numbers_.size() > 0)
            return invalid_data(fmt::format("{}: properties are announced after the first vertex", scanner_.where()));
        properties_.clear();
        while (!scanner_.at_line_end()) {
            const auto name = scanner_.quoted_of_line();
            if (name.empty()) return invalid_data(fmt::format("{}: a property without a name", scanner_.where()));
            properties_.emplace_back().name = name;
        }
        return {};
    }

    Result<void> read_sizes() {
        if (numbers_.size() > 0)
            return invalid_data(fmt::format("{}: sizes of properties after the first vertex", scanner_.where()));
        for (auto& property : properties_) {
            if (!scanner_.number_of_line(property.components) || property.components == 0 ||
                property.components > max_property_components) {
                return invalid_data(
                    fmt::format("{}: not the size of a property, 1 to {}", scanner_.where(), max_property_components));
            }
        }
        return {};
    }

    Result<void> read_no_data() {
        for (auto& property : properties_) {
            property.has_no_data = scanner_.number_of_line(property.no_data);
            if (!property.has_no_data && !scanner_.at_line_end())
                return invalid_data(fmt::format("{}: not a number", scanner_.where()));
        }
        return {};
    }

    Result<void> read_number_of_vertex() {
        std::int64_t number = 0;
        if (!scanner_.number_of_line(number))
            return invalid_data(fmt::format("{}: not the number of a vertex", scanner_.where()));
        numbers_.add(number);
        return {};
    }

    /// Vertices without values between others get no data.
    Result<void> pad_values(std::uint64_t vertices) {
        for (auto& property : properties_) {
            const std::uint64_t wanted = vertices * property.components, there = property.values.size();
            if (wanted <= there) continue;
            if (wanted - there > absent_left_)
                return invalid_data(fmt::format("{}: too many vertices have no values", scanner_.where()));
            absent_left_ -= wanted - there;
            property.values.resize(static_cast<std::size_t>(wanted), std::numeric_limits<double>::quiet_NaN());
        }
        return {};
    }

    /// A line may end early: the rest is no data.
    Result<void> read_values() {
        if (auto padded = pad_values(numbers_.size() - 1); !padded) return padded;
        has_values_ = true;
        for (auto& property : properties_) {
            for (std::size_t i = 0; i < property.components && !scanner_.at_line_end(); ++i) {
                double value = 0;
                if (!scanner_.number_of_line(value)) {
                    return invalid_data(
                        fmt::format("{}: not a value of property {}", scanner_.where(), in_quotes(property.name)));
                }
                const bool none = property.has_no_data && value == property.no_data;
                property.values.push_back(none ? std::numeric_limits<double>::quiet_NaN() : value);
            }
        }
        return pad_values(numbers_.size());
    }

    Result<void> read_vertex(std::string_view keyword) {
        if (auto number = read_number_of_vertex(); !number) return number;
        for (int axis = 0; axis < 3; ++axis) {
            double value = 0;
            if (!scanner_.number_of_line(value))
                return invalid_data(fmt::format("{}: not a coordinate", scanner_.where()));
            positions_.push_back(axis == 2 ? z_sign_ * value : value);
        }
        return keyword == "PVRTX" ? read_values() : Result<void>();
    }

    /// An atom is a vertex of its own at the place of an earlier one.
    Result<void> read_atom(std::string_view keyword) {
        if (auto number = read_number_of_vertex(); !number) return number;
        std::int64_t place = 0;
        if (!scanner_.number_of_line(place))
            return invalid_data(fmt::format("{}: not the number of a vertex", scanner_.where()));
        atoms_.push_back({numbers_.size() - 1, place});
        positions_.insert(positions_.end(), 3, 0.0);
        return keyword == "PATOM" ? read_values() : Result<void>();
    }

    Result<void> read_triangle() {
        for (int i = 0; i < 3; ++i) {
            std::int64_t number = 0;
            if (!scanner_.number_of_line(number))
                return invalid_data(fmt::format("{}: not the number of a vertex", scanner_.where()));
            corners_.push_back(number);
        }
        return {};
    }

    Result<Surface> finish() {
        if (auto closed = numbers_.close("vertex"); !closed) return closed.error();
        for (const auto& [atom, number] : atoms_) {
            const auto place = numbers_.find(number);
            if (place == NumberMap::none || place >= atom)
                return invalid_data(fmt::format("an atom is at vertex {}, which is not there before it", number));
            for (std::size_t axis = 0; axis < 3; ++axis) positions_[3 * atom + axis] = positions_[3 * place + axis];
        }
        SurfaceParts parts;
        for (std::size_t i = 0; i < corners_.size(); i += 3) {
            std::array<std::uint64_t, 3> corners{};
            for (std::size_t k = 0; k < 3; ++k) {
                corners[k] = numbers_.find(corners_[i + k]);
                if (corners[k] == NumberMap::none) {
                    return invalid_data(
                        fmt::format("triangle {} has vertex {}, which is not there", i / 3, corners_[i + k]));
                }
            }
            parts.cells.add_polygon(corners);
        }
        parts.positions = Array::own(std::move(positions_), 3);
        if (!has_values_) properties_.clear();
        if (auto padded = pad_values(numbers_.size()); !padded) return padded.error();
        for (auto& property : properties_) {
            parts.point_data.push_back({property.name, Array::own(std::move(property.values), property.components)});
        }
        return assemble(std::move(parts));
    }

    struct Atom {
        std::uint64_t vertex;
        std::int64_t place;
    };

    TextScanner& scanner_;
    Pace& pace_;
    double z_sign_ = 1;
    NumberMap numbers_;
    std::vector<double> positions_;
    std::vector<std::int64_t> corners_;
    std::vector<Atom> atoms_;
    std::vector<PointProperty> properties_;
    bool has_values_ = false;   ///< some vertex has
    std::uint64_t absent_left_; ///< how many values may still be missing
};

} // namespace

Result<Surface> parse_ts(std::string_view content, const Progress& progress) {
    TextScanner scanner(content, '#');
    Pace pace(progress, content.size());
    std::vector<Surface> surfaces;
    while (!scanner.at_end()) {
        const auto first = scanner.word_of_line();
        const auto kind = scanner.word_of_line();
        if (first != "GOCAD" || kind != "TSurf") {
            return invalid_data(fmt::format("before {}: {} {} stands where GOCAD TSurf was expected", scanner.where(),
                                            in_quotes(first), in_quotes(kind)));
        }
        scanner.next_line();
        auto surface = ObjectReader(scanner, pace).read();
        if (!surface) return surface;
        surfaces.push_back(std::move(*surface));
    }
    if (surfaces.empty()) return invalid_data("the file holds no GOCAD TSurf");
    if (surfaces.size() == 1) return std::move(surfaces.front());
    return join(surfaces, {});
}

} // namespace isotet::io
