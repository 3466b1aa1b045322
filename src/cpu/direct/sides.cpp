// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The flags of all points at one isovalue, and what is told of ties when the pass over the cells is done.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "base/workers.hpp"
#include "cpu/at_level.hpp"
#include "cpu/direct/points.hpp"

namespace isotet::cpu::direct {

namespace {

/// The value that the field's type has nearest to the isovalue, where that is another one.
std::optional<double> nearest_value(const Array& values, double isovalue) {
    const double nearest = snap(values, isovalue);
    return nearest == isovalue ? std::nullopt : std::optional(nearest);
}

/// The flags of a range of points from the values of the field, T as the user has them.
template <class Real, class T>
class SideFinder {
public:
    SideFinder(const StoredField& field, const core::StoredIsovalue<Real>& stored, std::optional<double> nearest,
               Ties ties, Watch watch)
        : storage_(field.storage),
          stored_(stored),
          lower_(static_cast<Number>(field.statistics.lower)),
          upper_(static_cast<Number>(field.statistics.upper)),
          tied_flags_(ties == Ties::merge ? side::watched | side::tied : side::watched),
          near_flag_(nearest ? side::watched : 0),
          deciding_flag_(watch == Watch::deciding ? side::watched : 0),
          as_they_are_(field.storage.offset == 0 && field.storage.scale == 1 && !field.may_flush()) {
        if (nearest) stored_nearest_ = core::store_value<Real>(*nearest, storage_);
    }

    SidesFound find(const T* values, std::size_t count, std::uint8_t* flags) const {
        // Infinities compare as +-2^91 would; so nothing else is changed by storing such a field.
        return as_they_are_ ? find(values, count, flags, [](T value) { return static_cast<Real>(value); })
                            : find(values, count, flags, [&](T value) {
                                  return core::store_value<Real>(static_cast<double>(value), storage_);
                              });
    }

private:
    using Number = std::conditional_t<std::is_same_v<T, float>, float, double>;

    template <class Store>
    SidesFound find(const T* values, std::size_t count, std::uint8_t* flags, const Store& store) const {
        // Flags are bytes, which might be anything: what is read again and again stands in variables of its own.
        const Real level = stored_.value, tied_value = stored_.tied, stored_nearest = stored_nearest_;
        const Number lower = lower_, upper = upper_, offset = static_cast<Number>(storage_.offset);
        const std::uint8_t tied_flags = tied_flags_, near_flag = near_flag_, deciding_flag = deciding_flag_;
        std::uint8_t any_tied = 0, any_near = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const auto value = static_cast<Number>(values[i]);
            const Real s = store(values[i]);
            const bool no_data = value != value, tied = s == tied_value;
            const bool deciding = no_data | (value == lower) | (value == upper) | (std::abs(value) == infinity) |
                                  ((s == 0) & (value != offset));
            const auto if_tied = static_cast<std::uint8_t>(tied ? tied_flags : 0);
            const auto if_near = static_cast<std::uint8_t>(s == stored_nearest ? near_flag : 0);
            flags[i] = static_cast<std::uint8_t>((s >= level ? side::above : 0) | (no_data ? side::no_data : 0) |
                                                 if_tied | if_near | (deciding ? deciding_flag : 0));
            any_tied |= if_tied;
            any_near |= if_near;
        }
        return {any_tied != 0, any_near != 0, {}};
    }

    static constexpr Number infinity = std::numeric_limits<Number>::infinity();

    core::Storage storage_;
    core::StoredIsovalue<Real> stored_;
    Real stored_nearest_ = 0;
    Number lower_, upper_;
    std::uint8_t tied_flags_, near_flag_, deciding_flag_;
    bool as_they_are_;
};

/// Points at which a field has one of the values that decide on its storage.
void watch_field(const Array& values, const StoredField& field, Sides& sides) {
    if (field.storage.unchanged && field.storage.scale == 1) return; // whatever the used points are
    const std::size_t components = values.components();
    values.visit([&](auto typed) {
        core::worker_each(values.tuples(), side_grain, [&](std::size_t point) {
            bool deciding = false;
            for (std::size_t k = 0; k < components; ++k) {
                const auto value = static_cast<double>(typed[point * components + k]);
                const double magnitude = std::abs(value - field.storage.offset);
                deciding |= value == field.statistics.lower || value == field.statistics.upper ||
                            (magnitude > 0 && magnitude < core::tiny);
            }
            if (deciding) sides.flags()[point] |= side::watched;
        });
    });
}

/// Calls f(x, y, z) for every point of the grid, as doubles, and ORs what comes back into its flags.
template <class F>
void add_flags(const Array& points, Sides& sides, const F& f) {
    points.visit([&](auto coordinates) {
        core::worker_each(points.tuples(), side_grain, [&](std::size_t point) {
            const auto at = [&](std::size_t axis) { return static_cast<double>(coordinates[3 * point + axis]); };
            sides.flags()[point] |= f(core::Point{at(0), at(1), at(2)});
        });
    });
}

} // namespace

template <class Real>
SidesFound find_sides(const ops::DirectInput& input, const PointSurvey& survey, double isovalue,
                      const core::StoredIsovalue<Real>& stored, Ties ties, Watch watch, Sides& sides) {
    const Array& values = input.field.values;
    SidesFound all;
    all.stretches.resize((values.tuples() + side_grain - 1) / side_grain);
    std::atomic<bool> tied{false}, near{false};
    values.visit([&]<class T>(std::span<const T> typed) {
        const SideFinder<Real, T> finder(survey.field, stored, nearest_value(values, isovalue), ties, watch);
        core::worker_each(all.stretches.size(), 1, [&](std::size_t stretch) {
            const std::size_t begin = stretch * side_grain, end = std::min(typed.size(), begin + side_grain);
            SidesFound found;
            at_level([&] { found = finder.find(typed.data() + begin, end - begin, sides.flags().data() + begin); });
            all.stretches[stretch] = found.tied || found.near;
            if (found.tied) tied.store(true, std::memory_order_relaxed);
            if (found.near) near.store(true, std::memory_order_relaxed);
        });
    });
    all.tied = tied;
    all.near = near;
    if (watch == Watch::deciding) {
        for (std::size_t i = 0; i < survey.carried.size(); ++i)
            watch_field(input.carried[i].values, survey.carried[i], sides);
        watch_field(values, survey.field, sides);
        if (survey.rounds_coordinates)
            add_flags(input.grid.points, sides, [&](const core::Point& p) {
                bool deciding = false;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    deciding |= p[axis] == survey.lower[axis] || p[axis] == survey.upper[axis];
                return deciding ? side::watched : std::uint8_t{0};
            });
    }
    if (survey.has_unsound)
        add_flags(input.grid.points, sides,
                  [](const core::Point& p) { return is_sound(p) ? std::uint8_t{0} : side::unsound; });
    return all;
}

template SidesFound find_sides<float>(const ops::DirectInput&, const PointSurvey&, double,
                                      const core::StoredIsovalue<float>&, Ties, Watch, Sides&);
template SidesFound find_sides<double>(const ops::DirectInput&, const PointSurvey&, double,
                                       const core::StoredIsovalue<double>&, Ties, Watch, Sides&);

template <class Real>
void report_ties(const ops::DirectInput& input, const PointSurvey& survey, double isovalue,
                 const core::StoredIsovalue<Real>& stored, const SidesFound& found, const Sides& sides,
                 ops::DirectSurface& surface) {
    surface.isovalue_stored = core::restore_value(stored.sum(), survey.field.storage);
    if (!found.tied && !found.near) return;
    const Array& values = input.field.values;
    const auto nearest = nearest_value(values, isovalue);
    std::atomic<std::uint64_t> tied{0}, exact{0};
    std::atomic<bool> near{false};
    values.visit([&](auto typed) {
        const auto look_at = [&](std::size_t point) {
            if (sides.is_unseen(point)) return;
            if (core::store_value<Real>(static_cast<double>(typed[point]), survey.field.storage) == stored.tied) {
                tied.fetch_add(1, std::memory_order_relaxed);
                if (core::equals_exactly(typed[point], isovalue)) exact.fetch_add(1, std::memory_order_relaxed);
            }
            if (nearest && core::equals_exactly(typed[point], *nearest)) near.store(true, std::memory_order_relaxed);
        };
        core::worker_each(found.stretches.size(), 1, [&](std::size_t stretch) {
            const std::size_t begin = stretch * side_grain, end = std::min(typed.size(), begin + side_grain);
            for (std::size_t point = begin; point < end && found.stretches[stretch]; ++point) look_at(point);
        });
    });
    surface.raw.tied_points = tied;
    surface.false_ties = tied - exact;
    surface.near_tie = tied == 0 && near;
}

template void report_ties<float>(const ops::DirectInput&, const PointSurvey&, double,
                                 const core::StoredIsovalue<float>&, const SidesFound&, const Sides&,
                                 ops::DirectSurface&);
template void report_ties<double>(const ops::DirectInput&, const PointSurvey&, double,
                                  const core::StoredIsovalue<double>&, const SidesFound&, const Sides&,
                                  ops::DirectSurface&);

} // namespace isotet::cpu::direct
