// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "numbers/exact.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace isotet::core {

namespace {

/// A number as a sum of doubles, smallest first, that do not overlap.
class Expansion {
public:
    Expansion() = default;
    explicit Expansion(double a) : parts_{a} {}

    static Expansion difference(double a, double b) {
        const double x = a - b;
        const double b_virtual = a - x;
        const double a_virtual = x + b_virtual;
        return Expansion(std::vector<double>{(a - a_virtual) + (b_virtual - b), x});
    }

    Expansion operator+(const Expansion& other) const {
        Expansion sum = *this;
        for (const double part : other.parts_) sum.grow(part);
        return sum;
    }
    Expansion operator-(const Expansion& other) const {
        Expansion sum = *this;
        for (const double part : other.parts_) sum.grow(-part);
        return sum;
    }
    Expansion operator*(const Expansion& other) const {
        Expansion product;
        for (const double a : parts_)
            for (const double b : other.parts_) {
                const double x = a * b;
                product.grow(std::fma(a, b, -x));
                product.grow(x);
            }
        return product;
    }
    int sign() const {
        for (auto part = parts_.rbegin(); part != parts_.rend(); ++part)
            if (*part != 0) return *part > 0 ? 1 : -1;
        return 0;
    }

private:
    explicit Expansion(std::vector<double> parts) : parts_(std::move(parts)) {}

    /// Adds one double (Grow-Expansion), dropping parts that became zero.
    void grow(double b) {
        double carry = b;
        std::size_t kept = 0;
        for (const double part : parts_) {
            const double x = carry + part;
            const double part_virtual = x - carry;
            const double carry_virtual = x - part_virtual;
            const double rest = (carry - carry_virtual) + (part - part_virtual);
            if (rest != 0) parts_[kept++] = rest;
            carry = x;
        }
        parts_.resize(kept);
        if (carry != 0) parts_.push_back(carry);
    }

    std::vector<double> parts_;
};

struct Difference {
    Expansion x, y, z;
    Difference(const Point& a, const Point& b)
        : x(Expansion::difference(a[0], b[0])),
          y(Expansion::difference(a[1], b[1])),
          z(Expansion::difference(a[2], b[2])) {}
};

/// Brings the largest coordinate near 1, so that products of small coordinates do not underflow.
template <std::size_t N>
std::array<Point, N> scaled(std::array<Point, N> points) {
    double largest = 0;
    for (const Point& p : points)
        for (const double x : p) largest = std::max(largest, std::abs(x));
    if (largest == 0) return points;
    const int exponent = std::ilogb(largest);
    for (Point& p : points)
        for (double& x : p) x = std::scalbn(x, -exponent);
    return points;
}

} // namespace

int exact_orientation_sign(const Point& a, const Point& b, const Point& c, const Point& d) {
    const auto p = scaled<4>({a, b, c, d});
    const Difference u(p[1], p[0]), v(p[2], p[0]), w(p[3], p[0]);
    const Expansion sum = u.x * (v.y * w.z - v.z * w.y) + u.y * (v.z * w.x - v.x * w.z) + u.z * (v.x * w.y - v.y * w.x);
    return sum.sign();
}

bool is_collinear(const Point& a, const Point& b, const Point& c) {
    const auto p = scaled<3>({a, b, c});
    const Difference u(p[1], p[0]), v(p[2], p[0]);
    return (u.x * v.y - u.y * v.x).sign() == 0 && (u.y * v.z - u.z * v.y).sign() == 0 &&
           (u.z * v.x - u.x * v.z).sign() == 0;
}

} // namespace isotet::core
