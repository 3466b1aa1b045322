// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTK's contour filters as a contestant of the race, on arrays that VTK borrows. Needs VTK's filters only. C++17.
//
// Commands: open FOLDER THREADS int32|int64; contour METHOD ISOVALUE; tree ISOVALUE (a fresh span space: building it
// and one surface). METHOD: unmerged, merged, merged_normals, merged_attributes, span_space of vtkContour3DLinearGrid;
// contour_grid, which is vtkContourGrid.
// The last surface is given back before the clock starts, and the filter holds none of its results.
#include <map>
#include <stdexcept>
#include <string>

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkContour3DLinearGrid.h>
#include <vtkContourGrid.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>
#include <vtkSmartPointer.h>
#include <vtkSpanSpace.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVersion.h>

#include "bench/arrays.hpp"
#include "bench/protocol.hpp"

namespace {

using isotet::bench::Arrays;
using isotet::bench::Reals;
using isotet::bench::Reply;
using isotet::bench::Stopwatch;
using isotet::bench::Words;

template <class Array, class Value>
vtkSmartPointer<Array> borrow(std::vector<Value>& values, int components) {
    auto array = vtkSmartPointer<Array>::New();
    array->SetNumberOfComponents(components);
    array->SetArray(values.data(), static_cast<vtkIdType>(values.size()), 1);
    return array;
}

vtkSmartPointer<vtkDataArray> borrow_reals(Reals& reals, int components) {
    if (auto* singles = std::get_if<std::vector<float>>(&reals)) return borrow<vtkFloatArray>(*singles, components);
    return borrow<vtkDoubleArray>(std::get<std::vector<double>>(reals), components);
}

template <class Array>
vtkSmartPointer<Array> offsets_of(const Arrays& arrays) {
    const auto cells = static_cast<vtkIdType>(arrays.cell_count());
    auto offsets = vtkSmartPointer<Array>::New();
    offsets->SetNumberOfValues(cells + 1);
    const auto size = arrays.uniform() ? static_cast<vtkIdType>(isotet::bench::corners_of_type(arrays.types[0])) : 0;
    for (vtkIdType cell = 0; cell <= cells; ++cell) {
        const auto offset = arrays.uniform() ? size * cell : arrays.offsets[static_cast<std::size_t>(cell)];
        offsets->SetValue(cell, static_cast<typename Array::ValueType>(offset));
    }
    return offsets;
}

class Rival {
public:
    Reply answer(const Words& words) {
        using isotet::bench::number;
        using isotet::bench::word;
        const std::string& command = words[0];
        if (command == "open") return open(word(words, 1), isotet::bench::whole_number(words, 2), word(words, 3));
        if (command == "contour") return contour(word(words, 1), number(words, 2));
        if (command == "tree") {
            span_space_ = new_filter("span_space");
            return run(span_space_, number(words, 1));
        }
        throw std::invalid_argument("no such command: '" + command + "'");
    }

private:
    Reply open(const std::string& folder, int threads, const std::string& ids) {
        filters_.clear();
        span_space_ = nullptr;
        arrays_ = isotet::bench::read_arrays(folder);
        vtkSMPTools::Initialize(threads);

        const std::uint64_t cell_count = arrays_.cell_count(), corners = arrays_.corners.size();
        vtkNew<vtkCellArray> cells;
        if (ids == "int32") {
            cells->SetData(offsets_of<vtkTypeInt32Array>(arrays_), borrow<vtkTypeInt32Array>(arrays_.corners, 1));
        } else {
            const auto offsets = offsets_of<vtkTypeInt64Array>(arrays_);
            wide_corners_.assign(arrays_.corners.begin(), arrays_.corners.end());
            arrays_.corners = {};
            cells->SetData(offsets, borrow<vtkTypeInt64Array>(wide_corners_, 1));
        }
        vtkNew<vtkPoints> points;
        points->SetData(borrow_reals(arrays_.points, 3));
        const auto field = borrow_reals(arrays_.field, 1);
        field->SetName("field");
        grid_ = vtkSmartPointer<vtkUnstructuredGrid>::New();
        grid_->SetPoints(points);
        if (arrays_.uniform()) {
            grid_->SetCells(arrays_.types[0], cells);
        } else {
            const auto types = borrow<vtkUnsignedCharArray>(arrays_.types, 1);
            grid_->SetCells(types, cells);
        }
        grid_->GetPointData()->SetScalars(field);

        must_read_ = corners * (ids == "int32" ? 4 : 8) + arrays_.types.size() + isotet::bench::bytes(arrays_.field);
        return Reply()
            .text("version", vtkVersion::GetVTKVersion())
            .text("backend", vtkSMPTools::GetBackend())
            .count("threads", static_cast<std::uint64_t>(vtkSMPTools::GetEstimatedNumberOfThreads()))
            .count("cells", cell_count);
    }

    vtkSmartPointer<vtkContour3DLinearGrid> new_filter(const std::string& method) {
        auto filter = vtkSmartPointer<vtkContour3DLinearGrid>::New();
        filter->SetInputData(grid_);
        if (method != "unmerged") filter->MergePointsOn();
        if (method == "merged_normals") filter->ComputeNormalsOn();
        else if (method == "merged_attributes") filter->InterpolateAttributesOn();
        else if (method == "span_space") {
            vtkNew<vtkSpanSpace> tree;
            filter->UseScalarTreeOn();
            filter->SetScalarTree(tree);
        } else if (method != "unmerged" && method != "merged") {
            throw std::invalid_argument("no such method: '" + method + "'");
        }
        return filter;
    }

    Reply contour(const std::string& method, double isovalue) {
        if (method == "contour_grid") {
            vtkNew<vtkContourGrid> filter;
            filter->SetInputData(grid_);
            filter->ComputeScalarsOff();
            filter->ComputeNormalsOff();
            return run(filter.Get(), isovalue);
        }
        if (method == "span_space") {
            if (!span_space_) throw std::invalid_argument("span_space needs the command tree first");
            return run(span_space_, isovalue);
        }
        auto& filter = filters_[method];
        if (!filter) filter = new_filter(method);
        return run(filter, isovalue);
    }

    template <class Filter>
    Reply run(Filter&& filter, double isovalue) {
        if (vtkDataObject* last = filter->GetOutputDataObject(0)) last->Initialize();
        filter->SetValue(0, isovalue);
        filter->Modified();
        const Stopwatch watch;
        filter->Update();
        const double seconds = watch.seconds();

        auto* surface = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
        if (!surface) throw std::runtime_error("the filter made no vtkPolyData");
        const Reply reply = Reply()
                                .number("seconds", seconds)
                                .count("vertices", static_cast<std::uint64_t>(surface->GetNumberOfPoints()))
                                .count("triangles", static_cast<std::uint64_t>(surface->GetNumberOfPolys()))
                                .count("must_move", must_read_ + std::uint64_t{1024} * surface->GetActualMemorySize());
        surface->Initialize();
        return reply;
    }

    Arrays arrays_;
    std::vector<vtkTypeInt64> wide_corners_;
    vtkSmartPointer<vtkUnstructuredGrid> grid_;
    std::map<std::string, vtkSmartPointer<vtkContour3DLinearGrid>> filters_;
    vtkSmartPointer<vtkContour3DLinearGrid> span_space_;
    std::uint64_t must_read_ = 0;
};

} // namespace

int main() {
    Rival rival;
    return isotet::bench::serve([&](const Words& words) { return rival.answer(words); });
}
