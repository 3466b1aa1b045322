// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include <isotet/frame.hpp>
#include <isotet/pieces.hpp>

#include "arrays.hpp"
#include "call.hpp"
#include "parts.hpp"

namespace isotet::python {

using namespace nb::literals;

namespace {

static_assert(std::is_trivially_copyable_v<Survey>);

/// Member by member: what lies between them is 0, so that equal surveys have equal bytes.
nb::bytes bytes_of(const Survey& survey) {
    Survey out;
    std::memset(static_cast<void*>(&out), 0, sizeof out);
    out.lower = survey.lower;
    out.upper = survey.upper;
    out.upright = survey.upright;
    out.points = survey.points;
    out.field_count = survey.field_count;
    for (std::size_t i = 0; i < Survey::max_fields; ++i) {
        const FieldSurvey& field = survey.fields[i];
        out.fields[i].name = field.name;
        out.fields[i].type = field.type;
        out.fields[i].lower = field.lower;
        out.fields[i].upper = field.upper;
        out.fields[i].smallest = field.smallest;
        out.fields[i].largest = field.largest;
    }
    return nb::bytes(&out, sizeof out);
}

Survey survey_of(const nb::bytes& bytes) {
    if (bytes.size() != sizeof(Survey))
        throw nb::value_error(("a survey has " + std::to_string(bytes.size()) + " bytes, but must have " +
                               std::to_string(sizeof(Survey)) + ", as Grid.survey() gives them")
                                  .c_str());
    Survey out;
    std::memcpy(&out, bytes.data(), sizeof out);
    return out;
}

Frame frame_of(const std::vector<nb::bytes>& surveys) {
    std::vector<Survey> pieces;
    for (const nb::bytes& survey : surveys) pieces.push_back(survey_of(survey));
    const Result<Frame> frame = make_frame(pieces);
    if (!frame) raise(frame.error());
    return *frame;
}

} // namespace

void add_pieces(nb::module_& module) {
    nb::class_<Frame>(module, "Frame")
        .def("survey", [](const Frame& self) { return bytes_of(self.whole); })
        .def("range", [](const Frame& self, const std::string& field) {
            const FieldSurvey* const found = self.find(field);
            if (!found) throw nb::key_error(("the frame does not know the field '" + field + "'").c_str());
            return std::pair(found->lower, found->upper);
        });

    module.def("make_frame", &frame_of, "surveys"_a);

    module.def(
        "survey",
        [](const Grid& grid, const PointField& field, const FieldsIn& fields, bool split_cells,
           const CallOptions& how) {
            const ContourInput input{grid, field, fields_in(fields), {}};
            return bytes_of(call(how, [&](const Run& run) { return survey_piece(input, {split_cells}, run); }));
        },
        "grid"_a, "field"_a, "fields"_a, "split_cells"_a, "call"_a);

    module.def(
        "take_piece",
        [](const Grid& grid, std::uint64_t piece, std::uint64_t pieces, const CallOptions& how) {
            return call(how, [&](const Run& run) { return take_piece(grid, {piece, pieces}, run); });
        },
        "grid"_a, "piece"_a, "pieces"_a, "call"_a);

    module.def(
        "leave_out_cells",
        [](const Grid& grid, const ArrayIn& marks, std::uint64_t bits, const CallOptions& how) {
            const Array array = array_in(marks);
            return call(how, [&](const Run& run) { return leave_out_cells(grid, array, bits, run); });
        },
        "grid"_a, "marks"_a, "bits"_a, "call"_a);

    module.def(
        "number_points",
        [](const ArrayIn& points, const CallOptions& how) {
            const Array array = array_in(points);
            return array_out(call(how, [&](const Run& run) { return number_points_by_coordinates(array, run); }));
        },
        "points"_a, "call"_a);
}

} // namespace isotet::python
