// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "arrays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <span>
#include <unordered_map>

#include <vtkAbstractArray.h>
#include <vtkType.h>

namespace isotet_vtk {

namespace {

isotet::ScalarType integer(int bytes, bool is_signed) {
    using enum isotet::ScalarType;
    switch (bytes) {
    case 1: return is_signed ? int8 : uint8;
    case 2: return is_signed ? int16 : uint16;
    case 4: return is_signed ? int32 : uint32;
    default: return is_signed ? int64 : uint64;
    }
}

int vtk_type(isotet::ScalarType type) {
    switch (type) {
    case isotet::ScalarType::int8: return VTK_TYPE_INT8;
    case isotet::ScalarType::uint8: return VTK_TYPE_UINT8;
    case isotet::ScalarType::int16: return VTK_TYPE_INT16;
    case isotet::ScalarType::uint16: return VTK_TYPE_UINT16;
    case isotet::ScalarType::int32: return VTK_TYPE_INT32;
    case isotet::ScalarType::uint32: return VTK_TYPE_UINT32;
    case isotet::ScalarType::int64: return VTK_TYPE_INT64;
    case isotet::ScalarType::uint64: return VTK_TYPE_UINT64;
    case isotet::ScalarType::float32: return VTK_TYPE_FLOAT32;
    case isotet::ScalarType::float64: break;
    }
    return VTK_TYPE_FLOAT64;
}

/// Memory that arrays of VTK were given. VTK frees by a function of the address alone.
struct Lent {
    std::mutex mutex;
    std::unordered_multimap<void*, isotet::Array> owners;
};

/// Never destroyed: arrays of VTK may outlive all statics.
Lent& lent() {
    static Lent& all = *new Lent;
    return all;
}

void give_back(void* memory) {
    isotet::Array last; // freed outside the lock
    Lent& all = lent();
    const std::lock_guard lock(all.mutex);
    if (const auto found = all.owners.find(memory); found != all.owners.end()) {
        last = std::move(found->second);
        all.owners.erase(found);
    }
}

} // namespace

std::optional<isotet::ScalarType> scalar_type(vtkDataArray* array) {
    switch (array->GetDataType()) {
    case VTK_FLOAT: return isotet::ScalarType::float32;
    case VTK_DOUBLE: return isotet::ScalarType::float64;
    case VTK_UNSIGNED_CHAR:
    case VTK_UNSIGNED_SHORT:
    case VTK_UNSIGNED_INT:
    case VTK_UNSIGNED_LONG:
    case VTK_UNSIGNED_LONG_LONG: return integer(array->GetDataTypeSize(), false);
    case VTK_CHAR:
    case VTK_SIGNED_CHAR:
    case VTK_SHORT:
    case VTK_INT:
    case VTK_LONG:
    case VTK_LONG_LONG:
    case VTK_ID_TYPE: return integer(array->GetDataTypeSize(), true);
    default: return std::nullopt;
    }
}

const isotet::Array& SharedArray::of(vtkDataArray* array) {
    const vtkMTimeType time = array ? array->GetMTime() : 0;
    changed_ = time != time_ || !array != !owner_; // VTK gives no time twice
    if (!changed_) {
        if (owner_ && !owner_->array) owner_->array = array;
        return array_;
    }
    time_ = time;
    array_ = {};
    owner_.reset();
    if (!array) return array_;
    vtkSmartPointer<vtkDataArray> plain = array;
    if (!scalar_type(array) || !array->HasStandardMemoryLayout()) {
        plain = vtkSmartPointer<vtkDataArray>::Take(
            vtkDataArray::CreateDataArray(scalar_type(array) ? array->GetDataType() : VTK_UNSIGNED_CHAR));
        plain->DeepCopy(array);
    }
    owner_ = std::make_shared<Owner>(Owner{plain});
    array_ = isotet::Array(*scalar_type(plain), plain->GetVoidPointer(0),
                           static_cast<std::size_t>(plain->GetNumberOfTuples()),
                           static_cast<std::size_t>(plain->GetNumberOfComponents()), owner_);
    if (plain != array) time_ = 0; // the copy goes with release(), and must be made again
    return array_;
}

void SharedArray::release() {
    if (owner_) owner_->array = nullptr;
}

void lend(vtkDataArray* array, const isotet::Array& values) {
    array->SetNumberOfComponents(static_cast<int>(values.components()));
    if (values.empty()) {
        array->SetNumberOfTuples(0);
        return;
    }
    void* const memory = const_cast<void*>(values.data());
    {
        Lent& all = lent();
        const std::lock_guard lock(all.mutex);
        all.owners.emplace(memory, values);
    }
    array->SetVoidArray(memory, static_cast<vtkIdType>(values.size()), 0,
                        vtkAbstractArray::VTK_DATA_ARRAY_USER_DEFINED);
    array->SetArrayFreeFunction(&give_back);
}

vtkSmartPointer<vtkDataArray> to_vtk(const isotet::Array& values, const char* name) {
    auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(vtk_type(values.type())));
    array->SetName(name);
    lend(array, values);
    return array;
}

namespace {

template <class T>
void round_into(std::span<const double> from, T* to) {
    constexpr double lowest = static_cast<double>(std::numeric_limits<T>::lowest());
    double highest = static_cast<double>(std::numeric_limits<T>::max());
    if (sizeof(T) == 8) highest = std::nextafter(highest, 0.0); // 2^63 is no integer of 64 bits
    std::ranges::transform(
        from, to, [&](double value) { return static_cast<T>(std::clamp(std::nearbyint(value), lowest, highest)); });
}

} // namespace

vtkSmartPointer<vtkDataArray> rounded_to(int vtk_type, const isotet::Array& values, const char* name) {
    auto out = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(vtk_type));
    out->SetName(name);
    out->SetNumberOfComponents(static_cast<int>(values.components()));
    out->SetNumberOfTuples(static_cast<vtkIdType>(values.tuples()));
    void* const to = out->GetVoidPointer(0);
    switch (vtk_type) { vtkTemplateMacro(round_into(values.as<double>(), static_cast<VTK_TT*>(to))); }
    return out;
}

vtkSmartPointer<vtkDataArray> component_of(vtkDataArray* array, int component, const char* name) {
    auto out = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(array->GetDataType()));
    out->SetName(name);
    out->SetNumberOfTuples(array->GetNumberOfTuples());
    out->CopyComponent(0, array, component);
    return out;
}

} // namespace isotet_vtk
