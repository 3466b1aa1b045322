// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "arrays.hpp"

#include <cstdint>
#include <memory>
#include <optional>

namespace isotet::python {

namespace {

std::optional<ScalarType> integer_type(unsigned bits, bool is_signed) {
    switch (bits) {
    case 8: return is_signed ? ScalarType::int8 : ScalarType::uint8;
    case 16: return is_signed ? ScalarType::int16 : ScalarType::uint16;
    case 32: return is_signed ? ScalarType::int32 : ScalarType::uint32;
    case 64: return is_signed ? ScalarType::int64 : ScalarType::uint64;
    default: return std::nullopt;
    }
}

ScalarType type_of(const ArrayIn& array) {
    const auto type = array.dtype();
    std::optional<ScalarType> found;
    if (type.lanes == 1) {
        switch (static_cast<nb::dlpack::dtype_code>(type.code)) {
        case nb::dlpack::dtype_code::Int: found = integer_type(type.bits, true); break;
        case nb::dlpack::dtype_code::UInt: found = integer_type(type.bits, false); break;
        case nb::dlpack::dtype_code::Float:
            if (type.bits == 32) found = ScalarType::float32;
            if (type.bits == 64) found = ScalarType::float64;
            break;
        default: break;
        }
    }
    if (!found) throw nb::type_error("an array has a type that is no integer, float32 or float64");
    return *found;
}

/// Arrays may be let go of by any thread, and after the interpreter has ended.
struct Release {
    void operator()(const ArrayIn* array) const {
        if (!nb::is_alive()) return;
        const nb::gil_scoped_acquire held;
        delete array;
    }
};

} // namespace

Array array_in(const ArrayIn& array) {
    const std::size_t components = array.ndim() == 2 ? array.shape(1) : 1;
    const std::size_t tuples = array.ndim() == 0 ? 1 : array.shape(0);
    if (components == 0) throw nb::value_error("an array has rows of 0 components");
    const ScalarType type = type_of(array);
    std::shared_ptr<const void> owner(new ArrayIn(array), Release());
    return {type, array.data(), tuples, components, std::move(owner)};
}

Array renewed(const Array& array) {
    const std::shared_ptr<const void> owner = array.owner().lock();
    if (!std::get_deleter<Release>(owner)) return array;
    return {array.type(), array.data(), array.tuples(), array.components(),
            std::make_shared<const std::shared_ptr<const void>>(owner)};
}

std::vector<Field> fields_in(const FieldsIn& fields) {
    std::vector<Field> out;
    out.reserve(fields.size());
    for (const auto& [name, values] : fields) out.push_back({name, array_in(values)});
    return out;
}

nb::object array_out(const Array& array) {
    auto kept = std::make_unique<Array>(array);
    const nb::capsule owner(kept.get(), [](void* memory) noexcept { delete static_cast<Array*>(memory); });
    kept.release();
    const std::size_t shape[2] = {array.tuples(), array.components()};
    const std::size_t dimensions = array.components() == 1 ? 1 : 2;
    return array.visit([&]<class T>(std::span<const T> values) -> nb::object {
        static const T nothing{}; // an empty array has an address, too
        return nb::cast(
            nb::ndarray<nb::numpy, const T>(values.empty() ? &nothing : values.data(), dimensions, shape, owner));
    });
}

nb::dict fields_out(const std::vector<Field>& fields) {
    nb::dict out;
    for (const Field& field : fields) out[field.name.c_str()] = array_out(field.values);
    return out;
}

} // namespace isotet::python
