// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <isotet/export.hpp>
#include <isotet/pack.hpp>
#include <isotet/surface.hpp>

namespace isotet {

/// A box along the axes; empty while lower > upper.
struct ISOTET_API Box {
    std::array<double, 3> lower{1, 1, 1}, upper{-1, -1, -1};

    bool empty() const noexcept { return !(lower[0] <= upper[0]); }
    void add(const std::array<double, 3>& point) noexcept;
    void add(const Box& other) noexcept;
};

/// The box of all points that packed tets use, or of all vertices of a surface that are finite.
/// Cost   one pass
ISOTET_API Box bounds_of(const PackedGrid& packed);
ISOTET_API Box bounds_of(const Surface& surface);

/// From where one looks: obliquely from the front, the right and above; or from the end of an axis. z is up, except
/// that from +z and -z y is.
enum class View : std::uint8_t { iso, plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };

/// "iso", "+x", "-x" and so on, and back.
ISOTET_API std::string_view name_of(View view) noexcept;
ISOTET_API std::optional<View> parse_view(std::string_view name) noexcept;

enum class Projection : std::uint8_t { perspective, parallel };

/// A camera: what is in the middle of the picture, from which direction it is seen, and how much of it.
///
/// `direction`   from the target to the eye, unit
/// `up`          unit, at right angles to `direction`
/// `distance`    of the eye from the target
/// `angle`       of view, in degrees, from the lower to the upper edge of a perspective picture
/// `height`      of what a parallel picture shows
struct ISOTET_API Camera {
    Projection projection = Projection::perspective;
    std::array<double, 3> target{};
    std::array<double, 3> direction{0, 0, 1};
    std::array<double, 3> up{0, 1, 0};
    double distance = 1;
    double angle = 25;
    double height = 1;

    /// Sees all of a box as large as possible.
    ///
    /// `aspect`   width of the picture / its height
    /// `margin`   part of the picture that is left free on each side, below 0.5
    void fit(const Box& box, double aspect, double margin = 0.04);

    /// The same of all vertices of a surface that are finite: closer than their box, which has corners where nothing
    /// is.
    /// Cost   one pass
    void fit(const Surface& surface, double aspect, double margin = 0.04);

    /// The same for all cameras that orbit(azimuth, 0) leads to: at one distance, as small as lets each of them see
    /// all. A camera that has gone around and fits again keeps its distance, as long as it looks up or down by less
    /// than 45 degrees; the axis that it goes around is in the middle of the picture.
    /// Cost   as fit()
    void fit_orbit(const Box& box, double aspect, double margin = 0.04);
    void fit_orbit(const Surface& surface, double aspect, double margin = 0.04);

    /// Goes around the target: `azimuth` degrees to the right about the axis of the world that is nearest to `up`, then
    /// `elevation` degrees upwards, as far as just below the pole.
    void orbit(double azimuth, double elevation);

    /// Shows things `factor` times as large.
    void zoom(double factor);
};

/// An axis of the world that points upwards in a picture.
enum class UpAxis : std::uint8_t { plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };

/// A camera with the direction of a view; fit() does the rest.
ISOTET_API Camera camera_of(View view, Projection projection = Projection::perspective);

/// The same with another axis upwards; along that axis itself the view keeps its own.
ISOTET_API Camera camera_of(View view, UpAxis up, Projection projection = Projection::perspective);

/// The view that shows most of what lies in a box: along the axis that is under a twentieth of both others, iso where none
/// is. `box` is not empty.
ISOTET_API View best_view_of(const Box& box) noexcept;

/// A camera that looks from the front (-y where z is up, +z where y is, -y where x is), `azimuth` degrees to the right
/// of it and `elevation` degrees above, -90 to 90.
ISOTET_API Camera camera_of(double azimuth, double elevation, UpAxis up = UpAxis::plus_z,
                            Projection projection = Projection::perspective);

/// All of a camera in one word, "perspective:TARGET:DIRECTION:UP:DISTANCE:ANGLE" or "parallel:TARGET:DIRECTION:UP:HEIGHT",
/// vectors as three numbers separated by commas; and back. Numbers are the shortest that are read back as they were.
ISOTET_API std::string to_text(const Camera& camera);
ISOTET_API std::optional<Camera> parse_camera(std::string_view text);

} // namespace isotet
