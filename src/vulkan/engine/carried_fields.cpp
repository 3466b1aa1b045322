// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/engine/carried_fields.hpp"

#include <algorithm>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "numbers/storage.hpp"
#include "packed/field_storage.hpp"

namespace isotet::vulkan {

namespace {

constexpr std::size_t chunk_values = std::size_t{1} << 22;
constexpr std::size_t grain = 1 << 14;

/// Stores the values of packed points [begin, end).
void store(const Array& values, const core::Packed& packed, const core::Storage& storage, std::size_t begin,
           std::size_t end, float* out) {
    const std::size_t components = values.components();
    values.visit([&](auto typed) {
        core::parallel_each(end - begin, grain, [&](std::size_t i) {
            const std::size_t user = packed.user_point(begin + i);
            for (std::size_t k = 0; k < components; ++k)
                out[i * components + k] =
                    core::store_value<float>(static_cast<double>(typed[user * components + k]), storage);
        });
    });
}

Result<CarriedField> upload(Context& context, const core::Packed& packed, const Field& carried) {
    const Array& values = carried.values;
    CarriedField field;
    field.components = static_cast<std::uint32_t>(values.components());
    field.storage = core::choose_storage(carried, packed);
    const std::uint64_t point_bytes = sizeof(float) * values.components();
    auto taken = context.memory().take(packed.points() * point_bytes, Where::device, "carried field");
    if (!taken) return std::move(taken).error();
    field.values = *std::move(taken);
    const std::size_t chunk = std::max<std::size_t>(1, chunk_values / values.components());
    core::Buffer<float> stored(std::min(chunk, packed.points()) * values.components());
    for (std::size_t begin = 0; begin < packed.points(); begin += chunk) {
        const std::size_t end = std::min(begin + chunk, packed.points());
        store(values, packed, field.storage, begin, end, stored.data());
        const std::span bytes = std::as_bytes(std::span(stored.data(), (end - begin) * values.components()));
        if (auto ok = context.staging().upload(field.values, begin * point_bytes, bytes); !ok) return ok.error();
    }
    return field;
}

} // namespace

Result<std::shared_ptr<const CarriedField>> CarriedFields::get(Context& context, const core::Packed& packed,
                                                               const Field& field) {
    const Array& values = field.values;
    std::erase_if(entries_, [](const Entry& entry) { return entry.array.expired(); });
    for (const Entry& entry : entries_)
        if (entry.array.is(values)) return entry.field;
    auto uploaded = upload(context, packed, field);
    if (!uploaded) return std::move(uploaded).error();
    auto shared = std::make_shared<const CarriedField>(*std::move(uploaded));
    if (const core::ArrayIdentity array(values); !array.expired()) entries_.push_back({array, shared});
    return shared;
}

} // namespace isotet::vulkan
