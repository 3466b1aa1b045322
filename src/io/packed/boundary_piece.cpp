// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/packed/boundary_piece.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "io/files/crc32c.hpp"
#include "io/packed/checks.hpp"
#include "packed/user_value.hpp"

namespace isotet::io {

using core::Packed;

namespace {

template <class T>
void append_numbers(std::vector<std::byte>& out, std::span<const T> numbers) {
    const auto bytes = std::as_bytes(numbers);
    out.insert(out.end(), bytes.begin(), bytes.end());
}

/// `components` numbers of each point.
template <class Real>
void append_of_points(std::vector<std::byte>& out, const core::SharedBuffer<Real>& numbers, std::size_t components,
                      const std::vector<std::uint64_t>& points) {
    for (const std::uint64_t p : points)
        append_numbers(out, std::span<const Real>(numbers.data() + components * p, components));
}

/// Takes numbers off the front of bytes.
template <class T>
std::vector<T> take_numbers(std::span<const std::byte>& bytes, std::size_t count) {
    std::vector<T> numbers(count);
    if (count > 0) std::memcpy(numbers.data(), bytes.data(), count * sizeof(T));
    bytes = bytes.subspan(count * sizeof(T));
    return numbers;
}

Error broken_boundary(const std::string& what) { return invalid_data("the boundary is broken: " + what); }

Result<std::vector<std::byte>> read_summed(const PackedSource& source, std::uint64_t offset, std::uint64_t bytes,
                                           std::uint32_t checksum) {
    std::vector<std::byte> piece(bytes);
    if (auto ok = source.read(offset, piece); !ok) return ok.error();
    if (crc32c(piece) != checksum) return source.in_file(broken_boundary("its checksum differs"));
    return piece;
}

Result<void> check_numbers(const PackedDirectory& d, const std::vector<std::uint64_t>& points,
                           const std::vector<std::uint32_t>& triangles) {
    const bool ascending = std::ranges::adjacent_find(points, std::greater_equal<>()) == points.end();
    if (!ascending || (!points.empty() && points.back() >= d.count(Unit::points)))
        return broken_boundary(
            fmt::format("its points do not ascend, or one has a number that the grid of {} packed points "
                        "has not",
                        d.count(Unit::points)));
    const auto largest = std::ranges::max_element(triangles);
    if (largest != triangles.end() && *largest >= points.size())
        return broken_boundary(fmt::format("a corner is point {}, but it has {}", *largest, points.size()));
    return {};
}

template <class Real>
Result<void> check_positions_of(const std::vector<Real>& stored) {
    if (std::ranges::any_of(stored, [](Real x) { return !(std::abs(x) <= largest_position); }))
        return broken_boundary("a coordinate is not finite, or larger than is stored");
    return {};
}

} // namespace

std::vector<std::byte> encode_boundary(const Packed& packed, const core::PackedBoundary& boundary) {
    std::vector<std::byte> out;
    if (packed.points() > std::numeric_limits<std::uint32_t>::max())
        append_numbers<std::uint64_t>(out, boundary.points);
    else append_numbers<std::uint32_t>(out, std::vector<std::uint32_t>(boundary.points.begin(), boundary.points.end()));
    std::visit([&](const auto& reals) { append_of_points(out, reals.positions, 3, boundary.points); }, packed.reals);
    append_numbers<std::uint32_t>(out, boundary.triangles.as<std::uint32_t>());
    return out;
}

std::vector<std::byte> encode_boundary_positions(const Packed& packed, const std::vector<std::uint64_t>& points) {
    std::vector<std::byte> out;
    std::visit([&](const auto& reals) { append_of_points(out, reals.positions, 3, points); }, packed.reals);
    return out;
}

std::vector<std::byte> encode_boundary_values(const Packed& packed, const std::vector<std::uint64_t>& points) {
    std::vector<std::byte> out;
    std::visit([&](const auto& reals) { append_of_points(out, reals.values, 1, points); }, packed.reals);
    return out;
}

namespace {

/// Takes the positions of the boundary's points.
Result<void> decode_positions(std::span<const std::byte>& bytes, const PackedDirectory& d, StoredBoundary& boundary) {
    const std::size_t count = 3 * d.boundary->points;
    if (d.precision == Precision::float32) boundary.positions = take_numbers<float>(bytes, count);
    else boundary.positions = take_numbers<double>(bytes, count);
    return std::visit([](const auto& stored) { return check_positions_of(stored); }, boundary.positions);
}

} // namespace

Result<StoredBoundary> read_boundary(const PackedSource& source, std::uint32_t step) {
    const PackedDirectory& d = source.directory;
    const BoundaryEntry& entry = *d.boundary;
    const auto piece = read_summed(source, entry.offset, d.boundary_bytes(), entry.checksum);
    if (!piece) return piece.error();
    std::span<const std::byte> left = *piece;
    StoredBoundary boundary;
    if (d.wide_packed_points()) boundary.points = take_numbers<std::uint64_t>(left, entry.points);
    else {
        const auto narrow = take_numbers<std::uint32_t>(left, entry.points);
        boundary.points.assign(narrow.begin(), narrow.end());
    }
    boundary.origin = d.origin;
    if (auto ok = decode_positions(left, d, boundary); !ok) return source.in_file(ok.error());
    auto triangles = take_numbers<std::uint32_t>(left, 3 * entry.triangles);
    if (auto ok = check_numbers(d, boundary.points, triangles); !ok) return source.in_file(ok.error());
    boundary.triangles = Array::own(std::move(triangles), 3);
    const PointsEntry* const moved = d.points_at(step);
    if (!moved) return boundary;
    const auto bytes =
        read_summed(source, moved->boundary_offset, 3 * entry.points * d.real_bytes(), moved->boundary_checksum);
    if (!bytes) return bytes.error();
    std::span<const std::byte> moved_bytes = *bytes;
    boundary.origin = moved->origin;
    if (auto ok = decode_positions(moved_bytes, d, boundary); !ok) return source.in_file(ok.error());
    return boundary;
}

Surface surface_of(StoredBoundary boundary, ScalarType type) {
    Surface surface;
    surface.triangles = std::move(boundary.triangles);
    surface.positions = std::visit(
        [&](auto& stored) {
            if (type == ScalarType::float32) return Array::own(std::move(stored), 3);
            std::vector<double> out(stored.size());
            for (std::size_t i = 0; i < out.size(); ++i)
                out[i] = static_cast<double>(stored[i]) + boundary.origin[i % 3];
            return Array::own(std::move(out), 3);
        },
        boundary.positions);
    return surface;
}

template <class Real>
Result<std::vector<Real>> read_boundary_values(const PackedSource& source, const FieldEntry& field) {
    const PackedDirectory& d = source.directory;
    const std::uint64_t points = d.boundary->points;
    const auto piece = read_summed(source, field.boundary_offset, points * sizeof(Real), field.boundary_checksum);
    if (!piece) return piece.error();
    std::span<const std::byte> left = *piece;
    std::vector<Real> values = take_numbers<Real>(left, points);
    const auto is_stored = [](Real x) { return core::is_nan(x) || std::abs(x) <= core::stored_infinity; };
    if (!std::ranges::all_of(values, is_stored))
        return source.in_file(broken_boundary("a value is larger than is stored"));
    return values;
}

template <class Real>
Array user_values(const std::vector<Real>& stored, ScalarType type, const core::Storage& storage) {
    return Array(type, nullptr, 0, 1, nullptr).visit([&]<class T>(std::span<const T>) {
        std::vector<T> out(stored.size());
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = core::user_value<T>(static_cast<double>(stored[i]), storage);
        return Array::own(std::move(out));
    });
}

template Result<std::vector<float>> read_boundary_values(const PackedSource&, const FieldEntry&);
template Result<std::vector<double>> read_boundary_values(const PackedSource&, const FieldEntry&);
template Array user_values(const std::vector<float>&, ScalarType, const core::Storage&);
template Array user_values(const std::vector<double>&, ScalarType, const core::Storage&);

} // namespace isotet::io
