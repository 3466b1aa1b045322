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
vtkSmartPointer<Array> offsets_of_tets(vtkIdType tets) {
    auto offsets = vtkSmartPointer<Array>::New();
    offsets->SetNumberOfValues(tets + 1);
    for (vtkIdType tet = 0; tet <= tets; ++tet) offsets->SetValue(tet, static_cast<typename Array::ValueType>(4 * tet));
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

        const auto tets = static_cast<vtkIdType>(arrays_.tet_count());
        vtkNew<vtkCellArray> cells;
        if (ids == "int32") {
            cells->SetData(offsets_of_tets<vtkTypeInt32Array>(tets), borrow<vtkTypeInt32Array>(arrays_.tets, 1));
        } else {
            wide_tets_.assign(arrays_.tets.begin(), arrays_.tets.end());
            arrays_.tets = {};
            cells->SetData(offsets_of_tets<vtkTypeInt64Array>(tets), borrow<vtkTypeInt64Array>(wide_tets_, 1));
        }
        vtkNew<vtkPoints> points;
        points->SetData(borrow_reals(arrays_.points, 3));
        const auto field = borrow_reals(arrays_.field, 1);
        field->SetName("field");
        grid_ = vtkSmartPointer<vtkUnstructuredGrid>::New();
        grid_->SetPoints(points);
        grid_->SetCells(VTK_TETRA, cells);
        grid_->GetPointData()->SetScalars(field);

        must_read_ =
            static_cast<std::uint64_t>(tets) * (ids == "int32" ? 16 : 32) + isotet::bench::bytes(arrays_.field);
        return Reply()
            .text("version", vtkVersion::GetVTKVersion())
            .text("backend", vtkSMPTools::GetBackend())
            .count("threads", static_cast<std::uint64_t>(vtkSMPTools::GetEstimatedNumberOfThreads()))
            .count("tets", static_cast<std::uint64_t>(tets));
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
    std::vector<vtkTypeInt64> wide_tets_;
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
