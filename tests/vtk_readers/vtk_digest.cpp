// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vtk_readers/vtk_digest.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <optional>
#include <memory>
#include <algorithm>

#include <fmt/core.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkDataSetReader.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLStructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "io/vtk_xml/columns.hpp"

namespace isotet::test {
namespace {

class Hash {
public:
    void add(const void* data, std::size_t bytes) {
        const auto* const at = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < bytes; ++i) value_ = (value_ ^ at[i]) * 0x100000001B3ULL;
    }
    template <class T>
    void add(T value) {
        add(&value, sizeof value);
    }
    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xCBF29CE484222325ULL;
};

/// The same memory as an array of ours; of bits and other layouts a copy.
Array array_of(vtkDataArray* values) {
    vtkSmartPointer<vtkDataArray> array = values;
    if (!array->HasStandardMemoryLayout() || array->GetDataType() == VTK_BIT) {
        const int type = array->GetDataType() == VTK_BIT ? VTK_UNSIGNED_CHAR : array->GetDataType();
        array.TakeReference(vtkDataArray::CreateDataArray(type));
        array->DeepCopy(values);
    }
    const auto type = [&]() -> std::optional<ScalarType> {
        const bool is_signed = array->GetDataTypeMin() < 0;
        if (array->GetDataType() == VTK_FLOAT) return ScalarType::float32;
        if (array->GetDataType() == VTK_DOUBLE) return ScalarType::float64;
        switch (array->GetDataTypeSize()) {
        case 1: return is_signed ? ScalarType::int8 : ScalarType::uint8;
        case 2: return is_signed ? ScalarType::int16 : ScalarType::uint16;
        case 4: return is_signed ? ScalarType::int32 : ScalarType::uint32;
        case 8: return is_signed ? ScalarType::int64 : ScalarType::uint64;
        default: return std::nullopt;
        }
    }();
    if (!type) return {};
    return Array(*type, array->GetVoidPointer(0), static_cast<std::size_t>(array->GetNumberOfTuples()),
                 static_cast<std::size_t>(std::max(1, array->GetNumberOfComponents())),
                 std::make_shared<vtkSmartPointer<vtkDataArray>>(array));
}

/// Notes that VTK told an error, and prints nothing.
class QuietWindow : public vtkOutputWindow {
public:
    vtkTypeMacro(QuietWindow, vtkOutputWindow) static QuietWindow* New() { VTK_STANDARD_NEW_BODY(QuietWindow); }
    void DisplayText(const char*) override {}
    void DisplayErrorText(const char*) override { has_error = true; }
    void DisplayGenericWarningText(const char* text) override {
        has_error = has_error || std::string_view(text).find("Error") != std::string_view::npos;
    }
    void DisplayWarningText(const char*) override {}
    bool has_error = false;
};

std::string line_of(std::string_view kind, std::string_view name, const Array& array) {
    Hash hash;
    hash.add(array.data(), array.bytes());
    return fmt::format("{} {}: {} x {} {} {:x}", kind, name, array.tuples(), array.components(), name_of(array.type()),
                       hash.value());
}

std::string places_line(std::size_t count, const Hash& hash) {
    return fmt::format("{} points {:x}", count, hash.value());
}
std::string cells_line(std::size_t count, const Hash& hash) {
    return fmt::format("{} cells {:x}", count, hash.value());
}

void add_cell(Hash& hash, int type, const std::vector<std::int64_t>& corners) {
    hash.add(type);
    for (const std::int64_t corner : corners) hash.add(corner);
}

template <class Reader>
vtkSmartPointer<vtkDataSet> output_of(const std::string& path) {
    vtkNew<Reader> reader;
    reader->SetFileName(path.c_str());
    if constexpr (std::is_same_v<Reader, vtkDataSetReader>) {
        reader->ReadAllScalarsOn();
        reader->ReadAllVectorsOn();
        reader->ReadAllNormalsOn();
        reader->ReadAllTensorsOn();
        reader->ReadAllColorScalarsOn();
        reader->ReadAllTCoordsOn();
        reader->ReadAllFieldsOn();
        reader->Update();
        return reader->GetOutput();
    } else {
        reader->Update();
        return reader->GetOutputAsDataSet();
    }
}

} // namespace

std::vector<std::string> digest(const Grid& grid) {
    std::vector<std::string> lines;
    Hash places, cells;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) places.add(grid.points.at(i, axis));
    lines.push_back(places_line(grid.points.tuples(), places));
    const std::size_t count = grid.cells.count();
    const std::size_t uniform = count == 0 ? 0 : grid.cells.connectivity.size() / count;
    for (std::size_t cell = 0; cell < count; ++cell) {
        const bool listed = !grid.cells.offsets.empty();
        const auto begin = listed ? static_cast<std::size_t>(grid.cells.offsets.at(cell)) : cell * uniform,
                   end = listed ? static_cast<std::size_t>(grid.cells.offsets.at(cell + 1)) : begin + uniform;
        std::vector<std::int64_t> corners;
        grid.cells.connectivity.visit([&](auto all) {
            for (std::size_t i = begin; i < end; ++i) corners.push_back(static_cast<std::int64_t>(all[i]));
        });
        add_cell(cells,
                 listed ? static_cast<int>(grid.cells.types.at(cell)) : static_cast<int>(grid.cells.uniform_type),
                 corners);
    }
    lines.push_back(cells_line(count, cells));
    for (const Field& field : grid.point_fields) lines.push_back(line_of("point field", field.name, field.values));
    for (const Field& field : grid.cell_fields) lines.push_back(line_of("cell field", field.name, field.values));
    return lines;
}

std::vector<std::string> digest(vtkDataSet* data) {
    std::vector<std::string> lines;
    Hash places, cells;
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
        double place[3];
        data->GetPoint(i, place);
        places.add(place, sizeof place);
    }
    lines.push_back(places_line(static_cast<std::size_t>(data->GetNumberOfPoints()), places));
    std::size_t count = 0;
    const bool unstructured = vtkUnstructuredGrid::SafeDownCast(data) != nullptr;
    vtkNew<vtkIdList> ids;
    for (vtkIdType cell = 0; cell < data->GetNumberOfCells(); ++cell) {
        int type = data->GetCellType(cell);
        if (unstructured) vtkUnstructuredGrid::SafeDownCast(data)->GetCells()->GetCellAtId(cell, ids);
        else data->GetCellPoints(cell, ids);
        std::vector<std::int64_t> corners(ids->begin(), ids->end());
        if (!unstructured && type == 11) { // a voxel of an image is read as a hexahedron
            type = 12;
            std::swap(corners[2], corners[3]);
            std::swap(corners[6], corners[7]);
        }
        if (!unstructured && type != 12) continue;
        ++count;
        add_cell(cells, type, corners);
    }
    lines.push_back(cells_line(count, cells));
    const auto add_fields = [&](vtkDataSetAttributes* attributes, std::string_view kind) {
        for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
            if (vtkDataArray* values = attributes->GetArray(i))
                if (values->GetName() && !io::vtk_xml::is_ghost_array(values->GetName()))
                    lines.push_back(line_of(kind, values->GetName(), array_of(values)));
    };
    add_fields(data->GetPointData(), "point field");
    if (unstructured || count > 0) add_fields(data->GetCellData(), "cell field");
    return lines;
}

std::vector<std::string> read_with_vtk(const std::string& path) {
    const vtkNew<QuietWindow> window;
    vtkOutputWindow::SetInstance(window);
    vtkSmartPointer<vtkDataSet> data;
    if (path.ends_with(".vtu")) data = output_of<vtkXMLUnstructuredGridReader>(path);
    else if (path.ends_with(".vti")) data = output_of<vtkXMLImageDataReader>(path);
    else if (path.ends_with(".vtr")) data = output_of<vtkXMLRectilinearGridReader>(path);
    else if (path.ends_with(".vts")) data = output_of<vtkXMLStructuredGridReader>(path);
    else data = output_of<vtkDataSetReader>(path);
    if (window->has_error || !data) return {};
    return digest(data);
}

std::vector<std::string> read_with_vtk_apart(const std::string& path) {
    int ends[2];
    if (::pipe(ends) != 0) return {};
    const pid_t child = ::fork();
    if (child == 0) {
        const rlimit no_core{0, 0}, memory{std::uint64_t{8} << 30, std::uint64_t{8} << 30};
        ::setrlimit(RLIMIT_CORE, &no_core);
        ::setrlimit(RLIMIT_AS, &memory);
        ::alarm(20);
        if (!::freopen("/dev/null", "w", stderr)) ::_exit(1);
        std::string text;
        try {
            for (const std::string& line : read_with_vtk(path)) text += line + '\n';
        } catch (...) { // the memory that it may take
            ::_exit(1);
        }
        const bool written = ::write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size());
        ::_exit(written ? 0 : 1);
    }
    ::close(ends[1]);
    std::string text;
    for (char buffer[4096];;) {
        const ssize_t count = ::read(ends[0], buffer, sizeof buffer);
        if (count <= 0) break;
        text.append(buffer, static_cast<std::size_t>(count));
    }
    ::close(ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return {};
    std::vector<std::string> lines;
    for (std::size_t begin = 0, end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
        lines.push_back(text.substr(begin, end - begin));
    return lines;
}

} // namespace isotet::test
