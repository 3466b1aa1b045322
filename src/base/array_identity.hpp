// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>

#include <isotet/array.hpp>

namespace isotet::core {

/// Tells an array that was seen before by its memory and its owner. A borrowed array has no owner: its memory may be
/// used again, so it is never known.
class ArrayIdentity {
public:
    explicit ArrayIdentity(const Array& array)
        : owner_(array.owner()),
          data_(array.data()),
          tuples_(array.tuples()),
          components_(array.components()),
          type_(array.type()) {}

    /// The owner is gone, or there was none.
    bool expired() const noexcept { return owner_.expired(); }
    bool is_empty() const noexcept { return tuples_ == 0; }
    bool is(const Array& array) const noexcept {
        const std::weak_ptr<const void> owner = array.owner();
        const bool same_owner = !owner_.owner_before(owner) && !owner.owner_before(owner_);
        return same_owner && !expired() && data_ == array.data() && tuples_ == array.tuples() && components_ == array.components() &&
               type_ == array.type();
    }

private:
    std::weak_ptr<const void> owner_;
    const void* data_;
    std::size_t tuples_, components_;
    ScalarType type_;
};

} // namespace isotet::core
