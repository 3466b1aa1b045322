// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where an array of a surface is made: in blocks, or in memory of the caller (SurfaceSink).
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <new>
#include <string_view>
#include <utility>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/surface.hpp>

#include "base/shared_buffer.hpp"

namespace isotet::core {

/// Of one array. What it refers to must outlive it.
class ArraySlot {
public:
    /// In blocks.
    ArraySlot() = default;
    /// In memory of `sink`, unless null.
    ArraySlot(SurfaceSink* sink, std::size_t surface, SurfaceArray array, std::string_view field = {})
        : sink_(sink), surface_(surface), array_(array), field_(field) {}

    /// Errors   throws std::bad_alloc; what the sink throws
    template <class T>
    SharedBuffer<T> make(std::size_t tuples, std::size_t components) const {
        if (!sink_ || tuples * components == 0) return SharedBuffer<T>(tuples * components);
        std::shared_ptr<void> given = sink_->take({surface_, array_, field_, scalar_type_of<T>(), tuples, components});
        if (!given) throw std::bad_alloc();
        return {std::static_pointer_cast<T>(std::move(given)), tuples * components};
    }

private:
    SurfaceSink* sink_ = nullptr;
    std::size_t surface_ = 0;
    SurfaceArray array_ = SurfaceArray::positions;
    std::string_view field_;
};

/// The slots of a call's surfaces. `field`: the place among the point fields, or among the cell fields.
using ArraySlots = std::function<ArraySlot(std::size_t surface, SurfaceArray array, std::size_t field)>;

inline ArraySlot slot_of(const ArraySlots& slots, std::size_t surface, SurfaceArray array, std::size_t field = 0) {
    return slots ? slots(surface, array, field) : ArraySlot();
}

/// Remembers what another sink gave, so that what was made elsewhere can be brought there.
class ISOTET_API RememberingSink final : public SurfaceSink {
public:
    /// `sink`   not null
    explicit RememberingSink(std::shared_ptr<SurfaceSink> sink) : sink_(std::move(sink)) {}

    std::shared_ptr<void> take(const Wanted& wanted) override;

    /// From now on the first surface of a request has this number.
    void begin_at(std::size_t first) { first_ = first; }

    /// Copies the arrays that are not in memory of the sink.
    /// Errors   as ArraySlot::make()
    void bring(Surface& surface, std::size_t number);

private:
    bool gave(const Array& array) const;

    std::shared_ptr<SurfaceSink> sink_;
    std::size_t first_ = 0;
    std::vector<std::weak_ptr<const void>> given_; ///< not by address: memory that was given back may come again
};

} // namespace isotet::core
