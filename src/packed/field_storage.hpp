// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Looking at a field's values at the points that tets use, to choose how they are stored, and storing them.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/progress.hpp>

#include "base/array_identity.hpp"
#include "numbers/storage.hpp"
#include "packed/packed.hpp"

namespace isotet::core {

struct FieldStorage {
    Storage storage;
    ValueStatistics statistics;
    std::uint64_t flushed = 0; ///< stored values that are 0 though the values are not
};

/// Chooses offset and scale for a field of one component, one value for each of the user's points, and stores its
/// values at the packed points in `out`. When cancelled, what comes back means nothing.
/// `chosen`   null, or how the field is stored
/// Cost   parallel; one pass over the packed points, one more for an offset, one more for a scale
template <class Real>
FieldStorage store_field_values(const Array& values, const Packed& packed, const Progress& progress, Real* out,
                                const Storage* chosen = nullptr);

/// Storage of fields that were looked at before: so that a field carried onto many surfaces is looked at once. Arrays
/// are told apart by their memory and its owner; borrowed ones, whose memory may be used again, are not remembered.
class StorageCache {
public:
    std::optional<Storage> find(const Array& values) const;
    void add(const Array& values, const Storage& storage);

private:
    struct Entry {
        ArrayIdentity array;
        Storage storage;
    };
    mutable std::mutex mutex_;
    std::vector<Entry> entries_;
};

/// Offset and scale for a field with any number of components (one pair for all of them); from the packed grid's cache
/// where it can be.
/// Cost   parallel; one pass over the values at packed points, one more for an offset
ISOTET_API Storage choose_storage(const Array& values, const Packed& packed);

/// By the frame of the packed grid, where it has one that knows the field and holds its values; else as above.
ISOTET_API Storage choose_storage(const Field& field, const Packed& packed);

} // namespace isotet::core
