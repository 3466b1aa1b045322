// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Point fields of the user's grid on the device, by packed point: so that surfaces carry them there.
#pragma once

#include <cstdint>
#include <list>
#include <memory>

#include <isotet/array.hpp>
#include <isotet/result.hpp>

#include "base/array_identity.hpp"
#include "packed/packed.hpp"
#include "vulkan/context.hpp"

namespace isotet::vulkan {

struct CarriedField {
    Buffer values; ///< float x components for each packed point
    std::uint32_t components = 1;
    core::Storage storage;
};

/// Fields are told apart by their memory and its owner, and stay on the device while the owner lives; those of borrowed
/// arrays, whose memory may be used again, are uploaded each time.
class CarriedFields {
public:
    /// The field, uploaded unless it is there.
    ///
    /// Cost       4 bytes a point and component over the bus
    /// Errors     out_of_memory; machine
    Result<std::shared_ptr<const CarriedField>> get(Context& context, const core::Packed& packed, const Field& field);

    /// Frees what is not in use.
    void clear() { entries_.clear(); }

private:
    struct Entry {
        core::ArrayIdentity array;
        std::shared_ptr<const CarriedField> field;
    };
    std::list<Entry> entries_;
};

} // namespace isotet::vulkan
