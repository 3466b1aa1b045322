// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "cpu/field_writer.hpp"

#include "numbers/arithmetic.hpp"

namespace isotet::cpu {

template <class Real>
void write_field(const ops::CarriedField& field, const VertexRun<Real>& vertices, Real* out) {
    const std::size_t components = field.values.components();
    field.values.visit([&](auto values) {
        const auto stored = [&](std::uint64_t point, std::size_t component) {
            return core::store_value<Real>(static_cast<double>(values[point * components + component]), field.storage);
        };
        for (std::size_t i = 0; i < vertices.count; ++i)
            for (std::size_t k = 0; k < components; ++k)
                *out++ = core::interpolate_field(stored(vertices.below[i], k), stored(vertices.above[i], k),
                                                 vertices.weights[i]);
    });
}

template void write_field<float>(const ops::CarriedField&, const VertexRun<float>&, float*);
template void write_field<double>(const ops::CarriedField&, const VertexRun<double>&, double*);

} // namespace isotet::cpu
