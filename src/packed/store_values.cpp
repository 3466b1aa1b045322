// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "packed/set_field.hpp"

#include <algorithm>
#include <optional>

#include "packed/field_storage.hpp"
#include "packed/frame.hpp"

namespace isotet::core {

template <class Real>
Result<void> store_values(const PointField& field, Packed& packed, const Progress& progress) {
    const auto framed = find_in_frame(packed.frame, field.name, field.values.type());
    if (!framed) return framed.error();
    std::optional<Storage> in_frame;
    if (*framed) in_frame = storage_in(**framed, packed.single() ? Precision::float32 : Precision::float64);
    Values<Real>& reals = packed.as<Real>();
    reals.values = SharedBuffer<Real>(packed.points());
    reals.ranges = SharedBuffer<Range<Real>>(packed.clusters());
    packed.group_ranges = SharedBuffer<GroupRange>(packed.groups());
    packed.has_no_data = SharedBuffer<std::uint8_t>(packed.clusters());
    std::fill(packed.has_no_data.begin(), packed.has_no_data.end(), std::uint8_t{0});
    const FieldStorage stored =
        store_field_values(field.values, packed, progress, reals.values.data(), in_frame ? &*in_frame : nullptr);
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "storing the field was cancelled"};
    if (*framed)
        if (auto ok = check_range(**framed, field.name, stored.statistics); !ok) return ok;

    const Storage& chosen = stored.storage;
    const ValueStatistics& statistics = stored.statistics;
    packed.storage = chosen;
    // Borrowed memory may be gone.
    const bool is_kept = !(chosen.unchanged && stored.flushed == 0) && !field.values.owner().expired();
    packed.field = is_kept ? field.values : Array(field.values.type(), nullptr, 0, 1, nullptr);
    FieldReport& report = packed.field_report;
    report = {};
    report.name = field.name;
    report.lower = statistics.lower;
    report.upper = statistics.upper;
    report.no_data = statistics.no_data;
    report.infinite = statistics.infinite;
    report.flushed = stored.flushed;
    report.offset = chosen.offset;
    report.scale = chosen.scale;
    report.unchanged = chosen.unchanged;
    return {};
}

template Result<void> store_values<float>(const PointField&, Packed&, const Progress&);
template Result<void> store_values<double>(const PointField&, Packed&, const Progress&);

} // namespace isotet::core
