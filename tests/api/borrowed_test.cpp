// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A packed grid reads no borrowed memory after packing, and keeps no array that it does not need. The address sanitizer
// watches the memory that is given back here.
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

Grid lone_tet() { return tet_grid({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}); }

/// Packed from memory that is gone.
template <class T>
PackedGrid pack_borrowed(const std::vector<T>& values) {
    const auto lent = std::make_unique<std::vector<T>>(values);
    return pack(lone_tet(), {"value", Array::borrow(std::span<const T>(*lent)), false, {}}).value();
}

constexpr double nearly_one = 1 + 0x1p-40; // rounds to 1 in float32

TEST(BorrowedField, IsNotReadAfterPacking) {
    const ExtractReport tied = extract(pack_borrowed<double>({1, nearly_one, -50, 50}), 1).value().report;
    EXPECT_EQ(tied.tied_points, 2u);
    EXPECT_FALSE(tied.false_ties.has_value());
    const ExtractReport untied = extract(pack_borrowed<double>({1, nearly_one, -50, 50}), 2).value().report;
    EXPECT_EQ(untied.tied_points, 0u);
    EXPECT_FALSE(untied.near_tie);
}

TEST(BorrowedField, IsNotReadAfterItWasSet) {
    PackedGrid packed = pack(lone_tet(), field_of<double>({1, nearly_one, -50, 50})).value();
    EXPECT_EQ(extract(packed, 1).value().report.false_ties, 1u);
    {
        const std::vector<double> lent{2, 2 * nearly_one, -50, 50};
        packed = packed.with_field({"lent", Array::borrow(std::span<const double>(lent)), false, {}}).value();
    }
    const ExtractReport report = extract(packed, 2).value().report;
    EXPECT_EQ(report.tied_points, 2u);
    EXPECT_FALSE(report.false_ties.has_value());
}

TEST(BorrowedField, NeedNotBeReadWhereItsValuesAreStoredUnchanged) {
    const PackedGrid packed = pack_borrowed<float>({0.7f, 0, 0, 1});
    EXPECT_TRUE(extract(packed, 0.7).value().report.near_tie);
    EXPECT_EQ(extract(packed, 0.7f).value().report.false_ties, 0u);
    EXPECT_EQ(extract(packed, 1e-30).value().report.false_ties, 2u);
    EXPECT_EQ(extract(pack_borrowed<std::int16_t>({1, 2, 3, 4}), 2).value().report.false_ties, 0u);
    const PackedGrid tiny = pack_borrowed<float>({1e-40f, 2e-40f, 3e-40f, 4e-40f}); // stored times a power of two
    EXPECT_EQ(extract(tiny, 2e-40f).value().report.tied_points, 1u);
    EXPECT_EQ(extract(tiny, 2e-40f).value().report.false_ties, 0u);
}

/// Whether a packed grid keeps the array of its field.
template <class T>
bool keeps(std::vector<T> values) {
    PointField field = field_of(std::move(values));
    const std::weak_ptr<const void> owner = field.values.owner();
    const PackedGrid packed = pack(lone_tet(), field).value();
    field = {};
    return !owner.expired();
}

TEST(PackedGrid, KeepsTheFieldOnlyWhereItsValuesWereChanged) {
    EXPECT_FALSE(keeps<float>({1, 2, 3, 4}));
    EXPECT_FALSE(keeps<std::int32_t>({1, 2, 3, 4}));
    EXPECT_TRUE(keeps<std::int32_t>({1, 2, 3, 1 << 24}));
    EXPECT_TRUE(keeps<float>({1, 2, 3, 1e-40f})); // flushed
    EXPECT_TRUE(keeps<double>({1, 2, 3, 4}));
}

} // namespace
} // namespace isotet::test
