// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a value of the field absorbs and emits, as integrals over the field: the mean over a linear segment is exact
// whatever its ends are.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <isotet/scene.hpp>

#include "numbers/storage.hpp"

namespace isotet::render {

/// Optical depth a length, and the same times red, green and blue of linear light.
using Extinction = std::array<double, 4>;

class Transfer {
public:
    static constexpr std::size_t entries = 1024;

    /// A table over the values of the field that are not transparent.
    /// `lower`, `upper`   of the field, finite
    Transfer(const DrawnVolume& volume, double lower, double upper, const core::Storage& storage);

    /// Where a stored value is in the table: its first entry at 0, its last at `entries`. Far outside of both, too.
    float place_of(double stored) const {
        if (log_factor_ == 0) return static_cast<float>(stored * factor_ + shift_);
        return log_place_of(stored);
    }

    /// Nothing from `lower` to `upper`, places or both a little more, absorbs anything.
    bool is_transparent(double lower, double upper) const {
        return row_at(lower - margin)[0] == row_at(upper + margin)[0];
    }

    /// The mean of a segment from place `from` to place `to`.
    Extinction mean(float from, float to) const {
        double u = from, v = to;
        if (std::abs(v - u) < margin) {
            const double middle = 0.5 * (u + v);
            u = middle - 0.5 * margin;
            v = middle + 0.5 * margin;
        }
        const Extinction a = row_at(u), b = row_at(v);
        const double part = 1 / (v - u);
        Extinction out;
        for (std::size_t i = 0; i < 4; ++i) out[i] = (b[i] - a[i]) * part;
        return out;
    }

    /// Integrals up to an entry, and how they go on in it: extinction is linear there.
    struct alignas(64) Row {
        Extinction up_to;
        std::array<float, 4> rise, bend;
    };
    std::span<const Row> rows() const { return rows_; }

private:
    static constexpr double margin = 1.0 / 256; ///< ends nearer to each other are moved apart

    float log_place_of(double stored) const;
    static Row row_between(const Extinction& up_to, const Extinction& mean, const Extinction& begin,
                           const Extinction& end);
    Extinction row_at(double place) const {
        const double at = std::min(std::max(place, 0.0), static_cast<double>(entries));
        const std::size_t below = std::min(static_cast<std::size_t>(at), entries - 1);
        const double part = at - static_cast<double>(below);
        const Row& row = rows_[below];
        Extinction out;
        for (std::size_t i = 0; i < 4; ++i)
            out[i] = row.up_to[i] + (static_cast<double>(row.rise[i]) + static_cast<double>(row.bend[i]) * part) * part;
        return out;
    }

    std::vector<Row> rows_;
    double factor_ = 1, shift_ = 0; ///< from stored values to places; on a logarithmic scale of logarithms
    double log_factor_ = 0;         ///< 0 on a linear scale
    double lowest_ = 0;             ///< on a logarithmic scale: values below count as this
    core::Storage storage_;
};

/// What a length of the opacity lets through, as optical depth; of full opacity, too, it is finite.
double depth_of(double opacity);

} // namespace isotet::render
