// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Numbers have 4 bytes, in either order:
//   mark, then points cells point_values cell_values model_values corners
//   number material corners type              for each cell
//   point...                                  of all cells, from 1
//   x...  y...  z...
//   where there are point values:
//     names, units                            1024 letters each, with dots between
//     arrays, components...                   as many places as values
//     lowest values..., highest values...
//     values of each array, point by point
//     a number for each value
//   the same for cells, and something like it for the model, which is passed over
#include "io/ucd/read_binary_ucd.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "io/files/pace.hpp"
#include "io/reader.hpp"
#include "io/ucd/ucd_elements.hpp"

namespace isotet::io::ucd {
namespace {

constexpr std::uint64_t head_bytes = 1 + 6 * 4, label_bytes = 2 * 1024;

class BinaryReader {
public:
    BinaryReader(std::string_view bytes, const ReadOptions& options, const Progress& progress, Depth depth)
        : bytes_(bytes), options_(options), pace_(progress, bytes.size()), depth_(depth) {}

    Result<ReadResult> run() {
        result_.info.format = "ucd";
        if (!header() || !cells()) return *problem_;
        points();
        if (point_values_ > 0 && !values(Association::point, points_, point_values_)) return *problem_;
        if (cell_values_ > 0 && !values(Association::cell, cells_, cell_values_)) return *problem_;
        if (auto step = choose_step(result_.info, options_); !step) return step.error();
        return std::move(result_);
    }

private:
    bool fail(std::string_view what) {
        if (!problem_) problem_ = invalid_data(fmt::format("the binary UCD file {}", what));
        return false;
    }
    /// Four bytes, which are there: the length was checked.
    template <class Number>
    Number next() {
        std::array<char, 4> own{};
        std::memcpy(own.data(), bytes_.data() + at_, own.size());
        if (order_ != std::endian::native) std::ranges::reverse(own);
        at_ += own.size();
        return std::bit_cast<Number>(own);
    }
    std::uint64_t announced_bytes() const {
        const auto of_values = [](std::uint64_t values, std::uint64_t each) {
            return values == 0 ? 0 : label_bytes + 4 + values * each;
        };
        return head_bytes + 16 * cells_ + 4 * corners_ + 12 * points_ + of_values(point_values_, 16 + 4 * points_) +
               of_values(cell_values_, 16 + 4 * cells_) + of_values(model_values_, 20);
    }
    bool header() {
        if (bytes_.size() < head_bytes) return fail("ends in its header");
        std::array<std::uint64_t, 2> lengths{};
        for (std::size_t i = 0; i < 2; ++i) {
            order_ = i == 0 ? std::endian::big : std::endian::little;
            at_ = 1;
            for (std::uint64_t* count : {&points_, &cells_, &point_values_, &cell_values_, &model_values_, &corners_})
                *count = next<std::uint32_t>();
            constexpr std::uint64_t most = std::uint64_t{1} << 24; // so that no product overflows
            const bool plausible = point_values_ <= most && cell_values_ <= most && model_values_ <= most;
            lengths[i] = plausible ? announced_bytes() : ~std::uint64_t{0};
            if (lengths[i] == bytes_.size()) return true;
        }
        return fail(
            fmt::format("has {} bytes, but its header announces {}", bytes_.size(), std::min(lengths[0], lengths[1])));
    }
    bool cells() {
        if (points_ > std::numeric_limits<std::int32_t>::max()) return fail("has more points than 31 bits number");
        std::vector<std::int32_t> connectivity(corners_), materials(cells_);
        std::vector<std::int64_t> offsets(cells_ + 1);
        std::vector<std::uint8_t> types(cells_);
        std::vector<std::uint32_t> kinds(cells_);
        std::uint64_t all = 0;
        for (std::uint64_t i = 0; i < cells_; ++i) {
            if (!goes_on()) return false;
            next<std::uint32_t>(); // its number
            materials[i] = next<std::int32_t>();
            const auto corners = next<std::uint32_t>();
            kinds[i] = next<std::uint32_t>();
            if (kinds[i] >= elements.size() || corners != static_cast<std::uint32_t>(elements[kinds[i]].corners))
                return fail(fmt::format("has cell {} of type {} with {} corners, which is none of UCD's", i, kinds[i],
                                        corners));
            types[i] = elements[kinds[i]].type;
            offsets[i + 1] = static_cast<std::int64_t>(all += corners);
        }
        if (all != corners_) return fail(fmt::format("announces {} corners, but its cells have {}", corners_, all));
        for (std::uint64_t i = 0; i < cells_; ++i) {
            const Element& element = elements[kinds[i]];
            std::array<std::int32_t, 8> read{};
            for (int c = 0; c < element.corners; ++c) {
                const auto point = next<std::uint32_t>();
                if (point < 1 || point > points_)
                    return fail(
                        fmt::format("has cell {} with point {}, but the points are 1 to {}", i, point, points_));
                read[static_cast<std::size_t>(c)] = static_cast<std::int32_t>(point - 1);
            }
            for (int c = 0; c < element.corners; ++c)
                connectivity[static_cast<std::size_t>(offsets[i] + c)] =
                    read[static_cast<std::size_t>(element.order[static_cast<std::size_t>(c)])];
        }
        Cells& cells = result_.grid.cells;
        cells.connectivity = Array::own(std::move(connectivity));
        cells.offsets = Array::own(std::move(offsets));
        cells.types = Array::own(std::move(types));
        keep("Material Id", Association::cell, Array::own(std::move(materials)));
        return true;
    }
    void points() {
        std::vector<float> places(3 * points_);
        for (std::uint64_t axis = 0; axis < 3; ++axis)
            for (std::uint64_t i = 0; i < points_; ++i) places[3 * i + axis] = next<float>();
        result_.grid.points = Array::own(std::move(places), 3);
    }
    bool values(Association association, std::uint64_t tuples, std::uint64_t stated) {
        std::string_view labels = bytes_.substr(at_, label_bytes / 2);
        labels = labels.substr(0, labels.find('\0'));
        at_ += label_bytes;
        const std::uint64_t arrays = next<std::uint32_t>();
        if (arrays > stated) return fail(fmt::format("has {} arrays of {} values", arrays, stated));
        std::vector<std::uint64_t> components(stated);
        for (std::uint64_t& count : components) count = next<std::uint32_t>();
        components.resize(arrays);
        std::uint64_t sum = 0;
        for (const std::uint64_t count : components) {
            sum += count;
            if (count < 1 || sum > stated) break;
        }
        if (sum != stated || std::ranges::find(components, 0u) != components.end())
            return fail(fmt::format("has arrays of {} values, but {} are announced", sum, stated));
        at_ += 2 * 4 * stated; // ranges
        std::vector<std::string> names;
        for (const std::uint64_t count : components) {
            const std::size_t end = std::min(labels.find('.'), labels.size());
            const std::string name(labels.substr(0, end));
            labels.remove_prefix(std::min(end + 1, labels.size()));
            const bool repeated = std::ranges::find(names, name) != names.end();
            names.push_back(name);
            if (name.empty() || repeated) {
                leave_out(result_.info, {association == Association::point ? "point field" : "cell field", name,
                                         name.empty() ? "it has no name" : "an earlier one has the same name"});
                at_ += 4 * tuples * count;
                continue;
            }
            if (!read_array(name, association, tuples, count)) return false;
        }
        at_ += 4 * stated;
        return true;
    }
    bool read_array(const std::string& name, Association association, std::uint64_t tuples, std::uint64_t components) {
        if (!is_wanted(association, name)) {
            announce(result_.info, {name, association, ScalarType::float32, components});
            at_ += 4 * tuples * components;
            return true;
        }
        std::vector<float> read(tuples * components);
        for (std::uint64_t i = 0; i < read.size(); ++i) {
            if (i % components == 0 && !goes_on()) return false;
            read[i] = next<float>();
        }
        keep(name, association, Array::own(std::move(read), components));
        return true;
    }
    void keep(const std::string& name, Association association, Array values) {
        announce(result_.info, {name, association, values.type(), values.components()});
        if (!is_wanted(association, name)) return;
        Grid& grid = result_.grid;
        (association == Association::point ? grid.point_fields : grid.cell_fields).push_back({name, std::move(values)});
    }
    bool is_wanted(Association association, std::string_view name) const {
        return depth_ == Depth::arrays && wanted(options_, association, name);
    }
    bool goes_on() {
        if (pace_.goes_on(at_)) return true;
        problem_ = Pace::cancelled();
        return false;
    }

    std::string_view bytes_;
    const ReadOptions& options_;
    Pace pace_;
    Depth depth_;
    ReadResult result_;
    std::endian order_ = std::endian::big;
    std::size_t at_ = 0;
    std::uint64_t points_ = 0, cells_ = 0, point_values_ = 0, cell_values_ = 0, model_values_ = 0, corners_ = 0;
    std::optional<Error> problem_;
};

} // namespace

Result<ReadResult> read_binary(std::string_view bytes, const ReadOptions& options, const Progress& progress,
                               Depth depth) {
    return BinaryReader(bytes, options, progress, depth).run();
}

} // namespace isotet::io::ucd
