// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The functions of points whose isosurfaces are slices.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/core.h>

#include <isotet/slice.hpp>

#include "base/errors.hpp"

namespace isotet::core {

using Vector3 = std::array<double, 3>;

inline std::string vector_text(const Vector3& v) { return fmt::format("({}, {}, {})", v[0], v[1], v[2]); }

inline bool is_finite(const Vector3& v) {
    return std::ranges::all_of(v, [](double x) { return std::isfinite(x); });
}

/// The largest component by magnitude.
inline double magnitude_of(const Vector3& v) { return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])}); }

inline Result<void> check_vector(const char* what, const Vector3& direction) {
    constexpr double least = 1e-100, most = 1e100; // products with coordinates neither overflow nor vanish
    const double largest = magnitude_of(direction);
    if (is_finite(direction) && largest >= least && largest <= most) return {};
    return invalid_argument(fmt::format("{} is {}, but its largest component must be from {} to {} in magnitude", what,
                                        vector_text(direction), least, most));
}

inline Result<void> check_place(const char* what, const Vector3& place) {
    if (is_finite(place)) return {};
    return invalid_argument(fmt::format("{} is {}, but must be finite", what, vector_text(place)));
}

inline Result<void> check_radius(double radius) {
    if (std::isfinite(radius) && radius >= 0) return {};
    return invalid_argument(fmt::format("the radius is {}, but must be finite and not negative", radius));
}

class PlaneField {
public:
    explicit PlaneField(const Plane& plane) : plane_(plane) {}

    Result<void> check() const {
        if (!std::isfinite(plane_.offset))
            return invalid_argument(fmt::format("the plane's offset is {}, but must be finite", plane_.offset));
        return check_vector("the plane's normal", plane_.normal);
    }
    std::string name() const {
        const Vector3& n = plane_.normal;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (n[(axis + 1) % 3] != 0 || n[(axis + 2) % 3] != 0 || std::abs(n[axis]) != 1) continue;
            return std::string(n[axis] < 0 ? "-" : "") + "xyz"[axis];
        }
        return "height along " + vector_text(n);
    }
    double operator()(const Vector3& p) const {
        return plane_.normal[0] * p[0] + plane_.normal[1] * p[1] + plane_.normal[2] * p[2];
    }

private:
    const Plane& plane_;
};

class SphereField {
public:
    explicit SphereField(const Sphere& sphere) : sphere_(sphere) {}

    Result<void> check() const {
        if (auto ok = check_place("the sphere's centre", sphere_.centre); !ok) return ok;
        return check_radius(sphere_.radius);
    }
    std::string name() const { return "distance from " + vector_text(sphere_.centre); }
    double operator()(const Vector3& p) const {
        const double x = p[0] - sphere_.centre[0], y = p[1] - sphere_.centre[1], z = p[2] - sphere_.centre[2];
        return std::sqrt(x * x + y * y + z * z);
    }

private:
    const Sphere& sphere_;
};

class CylinderField {
public:
    explicit CylinderField(const Cylinder& cylinder) : cylinder_(cylinder) {
        int exponent = 0;
        std::frexp(magnitude_of(cylinder.axis), &exponent);
        for (std::size_t k = 0; k < 3; ++k) axis_[k] = std::ldexp(cylinder.axis[k], -exponent);
        length_ = std::sqrt(axis_[0] * axis_[0] + axis_[1] * axis_[1] + axis_[2] * axis_[2]);
    }

    Result<void> check() const {
        if (auto ok = check_vector("the cylinder's axis", cylinder_.axis); !ok) return ok;
        if (auto ok = check_place("the point on the cylinder's axis", cylinder_.point); !ok) return ok;
        return check_radius(cylinder_.radius);
    }
    std::string name() const {
        return fmt::format("distance from the line along {} through {}", vector_text(cylinder_.axis),
                           vector_text(cylinder_.point));
    }
    double operator()(const Vector3& p) const {
        const double x = p[0] - cylinder_.point[0], y = p[1] - cylinder_.point[1], z = p[2] - cylinder_.point[2];
        const double u = y * axis_[2] - z * axis_[1], v = z * axis_[0] - x * axis_[2], w = x * axis_[1] - y * axis_[0];
        return std::sqrt(u * u + v * v + w * w) / length_;
    }

private:
    const Cylinder& cylinder_;
    Vector3 axis_{};
    double length_ = 1;
};

inline PlaneField function_of(const Plane& plane) { return PlaneField(plane); }
inline SphereField function_of(const Sphere& sphere) { return SphereField(sphere); }
inline CylinderField function_of(const Cylinder& cylinder) { return CylinderField(cylinder); }

} // namespace isotet::core
