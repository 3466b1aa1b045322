// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/isovalues.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/core.h>

#include "api/spectrum_source.hpp"
#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/system/memory.hpp"

namespace isotet {

namespace {

constexpr double volume_tolerance = 1e-12; // of the volume

/// Where the volume below passes a target: below it at `lower`, not at `upper`.
class ShareBracket {
public:
    ShareBracket(double target, double volume, const ValueRange& range)
        : target_(target), volume_(volume), lower_(range.lower), upper_(range.upper), below_upper_(volume) {
        if (target <= 0) finish(range.lower);
        else if (target >= volume || !(range.lower < range.upper)) finish(range.upper);
    }

    bool done() const { return done_; }
    double isovalue() const { return isovalue_; }

    /// Where to look next. At first evenly, then ever closer to where a line between both ends has the target: the error of
    /// that is of the order of the square of the bracket.
    void add_places(std::vector<double>& places) const {
        if (done_) return;
        constexpr int even = 64, halvings = 30;
        const double length = upper_ - lower_;
        const auto add = [&](double place) {
            if (place > lower_ && place < upper_) places.push_back(place);
        };
        places.push_back(upper_);
        add(std::midpoint(lower_, upper_));
        if (!looked_)
            for (int k = 1; k < even; ++k) add(lower_ + length * k / even);
        const double near = lower_ + length * ((target_ - below_lower_) / (below_upper_ - below_lower_));
        add(near);
        for (int k = 1; looked_ && k <= halvings; ++k) {
            add(near - std::ldexp(length, -k));
            add(near + std::ldexp(length, -k));
        }
    }

    /// `spectrum`   at places in ascending order, those of add_places() among them
    void narrow(const ContourSpectrum& spectrum) {
        if (done_) return;
        looked_ = true;
        for (std::size_t i = 0; i < spectrum.isovalues.size(); ++i) {
            const double place = spectrum.isovalues[i], below = spectrum.volume_below[i];
            if (place <= lower_) continue;
            if (place > upper_) break;
            if (below < target_) {
                lower_ = place;
                below_lower_ = below;
            } else {
                upper_ = place;
                below_upper_ = below;
                break;
            }
        }
        if (lower_ == upper_) finish(upper_); // tets that have the largest value
        else if (below_upper_ - below_lower_ <= volume_tolerance * volume_) finish(upper_);
        else if (std::nextafter(lower_, upper_) >= upper_) finish(lower_); // tets of this value
    }

private:
    void finish(double isovalue) {
        isovalue_ = isovalue;
        done_ = true;
    }

    double target_, volume_, lower_, upper_, below_lower_ = 0, below_upper_;
    double isovalue_ = 0;
    bool looked_ = false, done_ = false;
};

/// `source`   an error where the grid is broken
Result<std::vector<double>> isovalues_of_volume(Result<api::SpectrumSource> source, const PointField& field,
                                                const std::vector<double>& percents, const Progress& progress) {
    if (!source) return source.error();
    const ValueRange range = source->range();
    if (!(range.lower <= range.upper))
        return invalid_data(fmt::format("field '{}' has no finite value: no volume lies below any", field.name));
    const auto whole = source->at(std::vector<double>{range.upper}, api::SpectrumBy::cpu, progress);
    if (!whole) return whole.error();
    if (!(whole->volume > 0))
        return invalid_data(fmt::format("the tets where field '{}' has values have no volume", field.name));
    std::vector<ShareBracket> brackets;
    for (const double percent : percents) brackets.emplace_back(whole->volume * (percent / 100), whole->volume, range);
    for (;;) {
        std::vector<double> places;
        for (const ShareBracket& bracket : brackets) bracket.add_places(places);
        if (places.empty()) break;
        std::ranges::sort(places);
        places.erase(std::ranges::unique(places).begin(), places.end());
        const auto spectrum = source->at(places, api::SpectrumBy::cpu, progress);
        if (!spectrum) return spectrum.error();
        for (ShareBracket& bracket : brackets) bracket.narrow(*spectrum);
    }
    std::vector<double> isovalues;
    for (const ShareBracket& bracket : brackets) isovalues.push_back(bracket.isovalue());
    return isovalues;
}

Result<std::vector<double>> isovalues_of_points(const PointField& field, const std::vector<double>& percents,
                                                const Progress& progress) {
    if (field.values.components() != 1)
        return invalid_argument(fmt::format("field '{}' has {} components, but percentiles are of one", field.name,
                                            field.values.components()));
    if (auto fits = core::require_memory("percentiles", field.values.tuples() * sizeof(double)); !fits)
        return fits.error();
    std::vector<double> values;
    values.reserve(field.values.tuples());
    field.values.visit([&](auto scalars) {
        for (const auto scalar : scalars)
            if (const auto value = static_cast<double>(scalar); std::isfinite(value)) values.push_back(value);
    });
    if (values.empty())
        return invalid_data(fmt::format("field '{}' has no finite value: it has no percentiles", field.name));
    const auto count = static_cast<double>(values.size());
    std::vector<double> isovalues;
    for (const double percent : percents) {
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "looking for percentiles was cancelled"};
        const double rank = std::clamp(std::ceil(percent * count / 100), 1.0, count);
        const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank) - 1;
        std::nth_element(values.begin(), place, values.end());
        isovalues.push_back(*place);
    }
    return isovalues;
}

Result<void> check_percents(std::span<const IsovalueShare> shares) {
    for (const IsovalueShare& share : shares)
        if (!(share.percent >= 0 && share.percent <= 100))
            return invalid_argument(fmt::format("a share is {} %, but must be from 0 to 100 %", share.percent));
    return {};
}

/// `open`   gives the cells as a SpectrumSource, where they are needed
template <class Open>
Result<std::vector<double>> isovalues_of_shares(const Open& open, const PointField& field,
                                                std::span<const IsovalueShare> shares, const Run& run) {
    return core::carry_out("measuring", run, [&](const Progress& progress) -> Result<std::vector<double>> {
        if (auto ok = check_percents(shares); !ok) return ok.error();
        std::vector<double> isovalues(shares.size());
        for (const IsovalueShare::Of of : {IsovalueShare::Of::volume, IsovalueShare::Of::points}) {
            std::vector<std::size_t> places;
            std::vector<double> percents;
            for (std::size_t i = 0; i < shares.size(); ++i) {
                if (shares[i].of != of) continue;
                places.push_back(i);
                percents.push_back(shares[i].percent);
            }
            if (places.empty()) continue;
            const auto found = of == IsovalueShare::Of::volume
                                   ? isovalues_of_volume(open(progress), field, percents, progress)
                                   : isovalues_of_points(field, percents, progress);
            if (!found) return found.error();
            for (std::size_t k = 0; k < places.size(); ++k) isovalues[places[k]] = (*found)[k];
        }
        return isovalues;
    });
}

} // namespace

Result<std::vector<double>> isovalues_at(const Grid& grid, const PointField& field,
                                         std::span<const IsovalueShare> shares, const Run& run) {
    const auto open = [&](const Progress& progress) { return api::SpectrumSource::open(grid, field, {}, progress); };
    return isovalues_of_shares(open, field, shares, run);
}

Result<std::vector<double>> isovalues_at(const Array& points, const CellsInTurn& cells, const PointField& field,
                                         std::span<const IsovalueShare> shares, const Run& run) {
    const auto open = [&](const Progress&) { return api::SpectrumSource::open(points, cells, field); };
    return isovalues_of_shares(open, field, shares, run);
}

} // namespace isotet
