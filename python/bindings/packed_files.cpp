// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <isotet/packed_file.hpp>

#include "arrays.hpp"
#include "call.hpp"
#include "parts.hpp"

namespace isotet::python {

using namespace nb::literals;

namespace {

nb::list fields_out(const PackedFileInfo& info) {
    nb::list out;
    for (const PackedFieldInfo& field : info.fields) {
        nb::dict one;
        one["name"] = field.report.name;
        one["step"] = field.step;
        one["type"] = std::string(name_of(field.type));
        one["range"] = std::pair(field.report.lower, field.report.upper);
        one["no_data"] = field.report.no_data;
        one["gradients"] = field.gradients;
        out.append(one);
    }
    return out;
}

nb::dict info_out(const PackedFileInfo& info) {
    nb::dict out;
    out["bytes"] = info.file_bytes;
    out["points"] = info.user_points;
    out["cells"] = info.user_cells;
    out["tets"] = info.report.tets;
    out["chunks"] = info.chunks;
    out["source_cells"] = info.source_cells;
    out["bounds"] = std::pair(info.lower, info.upper);
    out["steps"] = info.steps;
    out["times"] = info.times;
    out["fields"] = fields_out(info);
    nb::list cell_fields;
    for (const PackedCellFieldInfo& field : info.cell_fields) {
        nb::dict one;
        one["name"] = field.name;
        one["step"] = field.step;
        one["type"] = std::string(name_of(field.type));
        one["components"] = field.components;
        cell_fields.append(one);
    }
    out["cell_fields"] = cell_fields;
    nb::list moved_points;
    for (const PackedPointsInfo& points : info.moved_points) {
        nb::dict one;
        one["step"] = points.step;
        one["bounds"] = std::pair(points.lower, points.upper);
        moved_points.append(one);
    }
    out["moved_points"] = moved_points;
    return out;
}

nb::dict residency_out(const ResidencyReport& report) {
    nb::dict out;
    out["limit"] = report.limit;
    out["bytes_read"] = report.bytes_read;
    out["reads"] = report.reads;
    out["bytes_in_memory"] = report.bytes;
    out["peak_bytes_in_memory"] = report.peak_bytes;
    return out;
}

} // namespace

void add_packed_files(nb::module_& module) {
    nb::class_<PackedFile>(module, "PackedFile")
        .def_static(
            "open",
            [](const std::string& path, std::uint64_t memory, const CallOptions& how) {
                return call(how, [&](const Run& run) { return PackedFile::open(path, {memory}, run); });
            },
            "path"_a, "memory"_a, "call"_a)
        .def("info", [](const PackedFile& self) { return info_out(self.info()); })
        .def(
            "grid",
            [](const PackedFile& self, std::string_view field, std::size_t step, double fraction,
               const CallOptions& how) {
                return call(how, [&](const Run& run) { return self.interpolated(field, step, fraction, run); });
            },
            "field"_a, "step"_a, "fraction"_a, "call"_a)
        .def(
            "cell_field",
            [](const PackedFile& self, std::string_view name, std::size_t step, const CallOptions& how) {
                return array_out(call(how, [&](const Run& run) { return self.cell_field(name, step, run); }).values);
            },
            "name"_a, "step"_a, "call"_a)
        .def(
            "plane_grid",
            [](const PackedFile& self, const std::array<double, 3>& normal, double offset, std::size_t step,
               const CallOptions& how) {
                return call(how, [&](const Run& run) { return self.sliced(Plane{normal, offset}, step, run); });
            },
            "normal"_a, "offset"_a, "step"_a, "call"_a)
        .def(
            "load",
            [](const PackedFile& self, std::string_view field, std::size_t step, const CallOptions& how) {
                return call(how, [&](const Run& run) { return self.load(field, step, run); });
            },
            "field"_a, "step"_a, "call"_a)
        .def("residency", [](const PackedFile& self) { return residency_out(self.residency()); })
        .def(
            "check",
            [](const PackedFile& self, const CallOptions& how) {
                call(how, [&](const Run& run) { return self.check(run); });
            },
            "call"_a);

    module.def(
        "save_packed",
        [](const PackedGrid& packed, const std::string& path, std::vector<PackedGrid> more_fields,
           std::optional<double> time, const CallOptions& how) {
            SavePackedOptions options;
            options.more_fields = std::move(more_fields);
            options.time = time;
            call(how, [&](const Run& run) { return save_packed(packed, path, options, run); });
        },
        "packed"_a, "path"_a, "more_fields"_a, "time"_a.none(), "call"_a);
}

} // namespace isotet::python
