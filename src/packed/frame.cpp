// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "packed/frame.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/errors.hpp"

namespace isotet {

namespace {

/// FNV-1a.
std::uint64_t hash_of_name(std::string_view name) {
    std::uint64_t hash = 0xcbf29ce484222325U;
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
    return hash;
}

} // namespace

namespace core {

std::uint64_t name_in_survey(std::string_view name) { return hash_of_name(name); }

Storage storage_in(const FieldSurvey& field, Precision precision) {
    ValueStatistics statistics;
    statistics.lower = field.lower;
    statistics.upper = field.upper;
    Storage storage = choose_offset(field.type, statistics, precision);
    if (storage.offset == 0) {
        choose_scale(storage, field.smallest, field.largest);
        return storage;
    }
    // Values and offset are within an eighth of each other, so they differ by multiples of the last place of a number
    // half as large as the largest.
    const double largest = std::max(std::abs(field.upper - storage.offset), std::abs(field.lower - storage.offset));
    const double smallest = std::scalbn(1.0, std::ilogb(field.largest) - 54);
    choose_scale(storage, smallest, largest);
    return storage;
}

std::array<double, 3> origin_in(const Survey& whole) {
    std::array<double, 3> origin{};
    for (std::size_t axis = 0; axis < 3 && whole.lower[axis] <= whole.upper[axis]; ++axis)
        origin[axis] = rounded_to_float(whole.lower[axis] + (whole.upper[axis] - whole.lower[axis]) / 2);
    return origin;
}

Result<const FieldSurvey*> find_in_frame(const std::optional<Frame>& frame, std::string_view name, ScalarType type) {
    const FieldSurvey* const none = nullptr;
    if (!frame) return none;
    const FieldSurvey* const found = frame->find(name);
    if (!found)
        return invalid_argument(
            fmt::format("the frame does not know the field '{}', but pieces need a frame with it", name));
    if (found->type != type)
        return invalid_argument(
            fmt::format("field '{}' is {}, but the frame has it as {}", name, name_of(type), name_of(found->type)));
    return found;
}

Result<void> check_range(const FieldSurvey& framed, std::string_view name, const ValueStatistics& statistics) {
    if (!(statistics.lower <= statistics.upper)) return {};
    if (framed.lower <= statistics.lower && statistics.upper <= framed.upper) return {};
    return invalid_argument(fmt::format("field '{}' has values from {} to {}, but the frame is for {} to {}", name,
                                        statistics.lower, statistics.upper, framed.lower, framed.upper));
}

Result<void> check_point_type(const Frame& frame, ScalarType type) {
    if (frame.whole.points == type) return {};
    return invalid_argument(
        fmt::format("the points are {}, but the frame is for {}", name_of(type), name_of(frame.whole.points)));
}

Result<void> check_bounds(const Frame& frame, const std::array<double, 3>& lower, const std::array<double, 3>& upper) {
    const Survey& whole = frame.whole;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (lower[axis] <= upper[axis] && !(whole.lower[axis] <= lower[axis] && upper[axis] <= whole.upper[axis]))
            return invalid_argument(fmt::format("the points reach from {} {} to {}, but the frame is for {} to {}",
                                                "xyz"[axis], lower[axis], upper[axis], whole.lower[axis],
                                                whole.upper[axis]));
    return {};
}

} // namespace core

const FieldSurvey* Frame::find(std::string_view name) const noexcept {
    const std::uint64_t hash = hash_of_name(name);
    for (std::size_t i = 0; i < whole.field_count && i < Survey::max_fields; ++i)
        if (whole.fields[i].name == hash) return &whole.fields[i];
    return nullptr;
}

Result<Survey> merge(const Survey& a, const Survey& b) {
    if (a.field_count == 0) return b;
    if (b.field_count == 0) return a;
    if (a.field_count != b.field_count)
        return invalid_argument(fmt::format("one piece was surveyed with {} fields, another with {}, but pieces must "
                                            "be surveyed with the same fields",
                                            a.field_count, b.field_count));
    if (a.field_count > Survey::max_fields)
        return invalid_argument(
            fmt::format("a survey claims to have {} fields, but there can be {}", a.field_count, Survey::max_fields));
    if (a.points != b.points)
        return invalid_argument(fmt::format("points are {} in one piece and {} in another, but must be of one type",
                                            name_of(a.points), name_of(b.points)));
    Survey out = a;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out.lower[axis] = std::min(a.lower[axis], b.lower[axis]);
        out.upper[axis] = std::max(a.upper[axis], b.upper[axis]);
    }
    out.upright += b.upright;
    for (std::size_t i = 0; i < a.field_count; ++i) {
        FieldSurvey& field = out.fields[i];
        const FieldSurvey& other = b.fields[i];
        if (field.name != other.name)
            return invalid_argument(fmt::format("field {} of the surveys is not the same in all pieces", i));
        if (field.type != other.type)
            return invalid_argument(fmt::format("field {} of the surveys is {} in one piece and {} in another", i,
                                                name_of(field.type), name_of(other.type)));
        field.lower = std::min(field.lower, other.lower);
        field.upper = std::max(field.upper, other.upper);
        field.smallest = std::min(field.smallest, other.smallest);
        field.largest = std::max(field.largest, other.largest);
    }
    return out;
}

Result<Frame> make_frame(std::span<const Survey> pieces) {
    Survey whole;
    for (const Survey& piece : pieces) {
        auto merged = merge(whole, piece);
        if (!merged) return merged.error();
        whole = *merged;
    }
    if (whole.field_count == 0)
        return invalid_argument(
            fmt::format("a frame needs the survey of a piece, but all of {} are empty", pieces.size()));
    return Frame{whole};
}

} // namespace isotet
