// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "make/lattice.hpp"

#include "make/random.hpp"

namespace isotet::make {

namespace {

std::vector<float> even_coordinates(std::uint64_t side) {
    std::vector<float> coordinates(side + 1);
    const double n = static_cast<double>(side);
    for (std::uint64_t i = 0; i <= side; ++i) coordinates[i] = static_cast<float>((2 * static_cast<double>(i) - n) / n);
    return coordinates;
}

/// 1 + ratio + ratio^2 + ..., `terms` of them.
double geometric_sum(double ratio, std::uint64_t terms) {
    double sum = 0;
    for (std::uint64_t i = 0; i < terms; ++i) sum = sum * ratio + 1;
    return sum;
}

/// Heights that grow geometrically from the bottom, the first a thousandth of the even spacing.
std::vector<float> graded_coordinates(std::uint64_t side) {
    if (side == 1) return even_coordinates(side);
    const double first = 2.0 / static_cast<double>(side) / 1000;
    double low = 1, high = 2000; // at two layers, the sharpest case, the ratio is 1999
    for (int step = 0; step < 200; ++step) {
        const double middle = (low + high) / 2;
        (first * geometric_sum(middle, side) < 2 ? low : high) = middle;
    }
    std::vector<float> coordinates(side + 1);
    double height = first, z = -1;
    for (std::uint64_t i = 0; i < side; ++i) {
        coordinates[i] = static_cast<float>(z);
        z += height;
        height *= low;
    }
    coordinates[side] = 1;
    return coordinates;
}

} // namespace

namespace {

/// Onto a smooth image of the cube, with bulging faces.
Position bent(const Position& at) {
    const double x = at[0], y = at[1], z = at[2];
    return {static_cast<float>(x + 0.15 * (1 - y * y) * z), static_cast<float>(y + 0.15 * (1 - x * x)),
            static_cast<float>(z - 0.1 * x * y + 0.1 * (1 - x * x) * y)};
}

} // namespace

Lattice::Lattice(const Shape& shape, std::uint64_t side, std::uint64_t seed)
    : side_(side),
      seed_(seed),
      corner_points_((side + 1) * (side + 1) * (side + 1)),
      perturbed_(shape.variant == Variant::perturbed || shape.variant == Variant::shuffled),
      bent_(shape.variant == Variant::bent),
      across_(even_coordinates(side)),
      up_(shape.variant == Variant::layer ? graded_coordinates(side) : across_) {
    for (std::uint64_t k = 0; k < shape.layers.size(); ++k) {
        centres_before_.push_back(centres_per_period_);
        if (!uses_centre(shape.layers[k])) continue;
        centre_layers_.push_back(k);
        ++centres_per_period_;
    }
}

Position Lattice::position(std::uint64_t point) const noexcept {
    if (point < corner_points_) {
        const std::uint64_t m = side_ + 1, i = point % m, j = point / m % m, k = point / (m * m);
        const Position at{across_[i], across_[j], up_[k]};
        if (bent_) return bent(at);
        const bool inner = i > 0 && i < side_ && j > 0 && j < side_ && k > 0 && k < side_;
        return perturbed_ && inner ? moved(at, point) : at;
    }
    const std::uint64_t centre = point - corner_points_, layer = centre / (side_ * side_);
    const std::uint64_t i = centre % side_, j = centre / side_ % side_;
    const std::uint64_t k =
        layer / centres_per_period_ * centres_before_.size() + centre_layers_[layer % centres_per_period_];
    return {(across_[i] + across_[i + 1]) / 2, (across_[j] + across_[j + 1]) / 2, (up_[k] + up_[k + 1]) / 2};
}

// A tet of the Kuhn division is h / sqrt(3) wide at its narrowest, so it stays upright while every corner moves by less
// than half of that, 0.288 h. A fifth leaves room for rounding.
Position Lattice::moved(const Position& at, std::uint64_t point) const noexcept {
    std::array<double, 3> way{};
    std::uint64_t bits = draw(seed_, Stream::position, point);
    do {
        for (double& component : way) component = to_symmetric(bits = mix(bits));
    } while (way[0] * way[0] + way[1] * way[1] + way[2] * way[2] > 1);
    const double reach = 2.0 / static_cast<double>(side_) / 5;
    return {static_cast<float>(at[0] + reach * way[0]), static_cast<float>(at[1] + reach * way[1]),
            static_cast<float>(at[2] + reach * way[2])};
}

std::array<std::uint64_t, 9> Lattice::corners(std::uint64_t i, std::uint64_t j, std::uint64_t k) const noexcept {
    const std::uint64_t m = side_ + 1, row = m, sheet = m * m;
    const std::uint64_t p = i + j * row + k * sheet;
    return {p,
            p + 1,
            p + row,
            p + row + 1,
            p + sheet,
            p + sheet + 1,
            p + sheet + row,
            p + sheet + row + 1,
            corner_points_ + i + side_ * (j + side_ * centres_before(k))};
}

} // namespace isotet::make
