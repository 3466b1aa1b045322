// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Looking at a field's values at the points that tets use, to choose how they are stored.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include <isotet/array.hpp>

#include "core/packed.hpp"
#include "core/storage.hpp"

namespace isotet::core {

struct FieldStorage {
    Storage storage;
    ValueStatistics statistics;
};

/// Offset and scale for a field with any number of components (one pair for all of them), one tuple for each of the
/// user's points. Parallel; two passes over the values at packed points.
FieldStorage survey_field(const Array& values, const Packed& packed);

/// Storage of fields that were looked at before: so that a field carried onto many surfaces is looked at once. Arrays
/// are told apart by their memory and its owner; borrowed ones, whose memory may be used again, are not remembered.
class StorageCache {
public:
    std::optional<Storage> find(const Array& values) const;
    void add(const Array& values, const Storage& storage);

private:
    struct Entry {
        std::weak_ptr<const void> owner;
        const void* data;
        std::size_t tuples, components;
        ScalarType type;
        Storage storage;
    };
    mutable std::mutex mutex_;
    std::vector<Entry> entries_;
};

/// As survey_field(), from the packed grid's cache where it can be.
Storage choose_storage(const Array& values, const Packed& packed);

} // namespace isotet::core
