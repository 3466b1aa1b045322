// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "cpu/spectrum.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "base/parallel.hpp"

namespace isotet::cpu {

namespace {

/// Finds the first isovalue above a value: a table leads near it.
class IsovalueFinder {
public:
    explicit IsovalueFinder(std::span<const double> isovalues)
        : isovalues_(isovalues), lower_(isovalues.front()), first_(2 * isovalues.size() + 2) {
        const double range = isovalues.back() - lower_;
        const double scale = static_cast<double>(2 * isovalues.size()) / range;
        if (std::isfinite(scale)) scale_ = scale;
        // cell_of() never falls, so that isovalues in lower cells are below a value. A table of how many these are:
        for (const double isovalue : isovalues) ++first_[cell_of(isovalue) + 1];
        for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
    }

    std::size_t first_above(double value) const {
        std::size_t i = first_[cell_of(value)];
        while (i < isovalues_.size() && isovalues_[i] <= value) ++i;
        return i;
    }

private:
    std::size_t cell_of(double value) const {
        const double cell = (value - lower_) * scale_;
        return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(first_.size() - 2)));
    }

    std::span<const double> isovalues_;
    double lower_, scale_ = 0;
    std::vector<std::size_t> first_;
};

/// Of a block of cells. `whole[i]`: volume of the tets that are below from isovalue i on, but not at i - 1.
struct SpectrumSums {
    std::vector<double> area, below, whole;
    double volume = 0;
    std::uint64_t tets = 0, no_data_tets = 0;

    explicit SpectrumSums(std::size_t isovalues) : area(isovalues), below(isovalues), whole(isovalues + 1) {}
};

/// Six times the volume, and the length of six volumes times the gradient.
struct TetMeasures {
    double six_volumes, slope;
};

TetMeasures measures_of(const std::array<core::Point, 4>& p, const std::array<double, 4>& values) {
    std::array<core::Point, 3> e;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t axis = 0; axis < 3; ++axis) e[k][axis] = p[k + 1][axis] - p[0][axis];
    const auto cross = [](const core::Point& a, const core::Point& b) {
        return core::Point{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const core::Point n0 = cross(e[1], e[2]), n1 = cross(e[2], e[0]), n2 = cross(e[0], e[1]);
    double squares = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double g = (values[1] - values[0]) * n0[axis] + (values[2] - values[0]) * n1[axis] +
                         (values[3] - values[0]) * n2[axis];
        squares += g * g;
    }
    return {std::abs(e[0][0] * n0[0] + e[0][1] * n0[1] + e[0][2] * n0[2]), std::sqrt(squares)};
}

void sort_four(std::array<double, 4>& v) {
    const auto order = [&v](std::size_t a, std::size_t b) {
        const double low = std::min(v[a], v[b]), high = std::max(v[a], v[b]);
        v[a] = low;
        v[b] = high;
    };
    order(0, 1);
    order(2, 3);
    order(0, 2);
    order(1, 3);
    order(1, 2);
}

/// What all cells have in common.
struct SpectrumField {
    core::PointReader points;
    std::span<const double> values, isovalues;
};

class SpectrumAdder {
public:
    SpectrumAdder(const SpectrumField& field, const IsovalueFinder& finder, SpectrumSums& sums)
        : field_(field), finder_(finder), sums_(sums) {}

    void add(const core::Tet& corners) {
        std::array<double, 4> values;
        for (std::size_t k = 0; k < 4; ++k) values[k] = field_.values[corners[k]];
        if (std::isnan(values[0] + values[1] + values[2] + values[3])) {
            ++sums_.no_data_tets;
            return;
        }
        std::array<core::Point, 4> places;
        for (std::size_t k = 0; k < 4; ++k) places[k] = field_.points[corners[k]];
        const TetMeasures measures = measures_of(places, values);
        const double volume = measures.six_volumes / 6;
        ++sums_.tets;
        sums_.volume += volume;
        sort_four(values);
        sums_.whole[add_cuts(values, volume, measures.slope)] += volume;
    }

private:
    /// The density of a tet's volume over the values is a quadratic B-spline whose knots are the values at the corners;
    /// times the gradient's length that is the area. All terms are positive: nothing cancels. Returns the first isovalue
    /// above all corners.
    std::size_t add_cuts(const std::array<double, 4>& v, double volume, double slope) {
        const std::span<const double> t = field_.isovalues;
        const std::size_t count = t.size();
        std::size_t i = finder_.first_above(v[0]);
        if (i == count || t[i] > v[3]) return i;
        const double from_0[] = {1 / (v[1] - v[0]), 1 / (v[2] - v[0]), 1 / (v[3] - v[0])};
        const double from_3[] = {1 / (v[3] - v[1]), 1 / (v[3] - v[2])};
        const double from_1 = 1 / (v[2] - v[1]), height = slope / 2 * from_0[2];
        for (; i < count && t[i] <= v[1]; ++i) {
            const double u = t[i] - v[0], base = (u * from_0[0]) * (u * from_0[1]);
            sums_.area[i] += height * base;
            sums_.below[i] += volume * base * (u * from_0[2]);
        }
        for (; i < count && t[i] <= v[2]; ++i) {
            const double a = (t[i] - v[0]) * from_0[1], b = (t[i] - v[0]) * from_0[2];
            const double c = (t[i] - v[1]) * from_1, d = (t[i] - v[1]) * from_3[0];
            const double rest_a = (v[2] - t[i]) * from_0[1], rest_d = (v[3] - t[i]) * from_3[0];
            sums_.area[i] += height * (a * ((v[2] - t[i]) * from_1) + rest_d * c);
            sums_.below[i] += volume * (a * b + rest_a * b * c + (v[3] - t[i]) * from_0[2] * c * d);
        }
        for (; i < count && t[i] <= v[3]; ++i) {
            const double w = v[3] - t[i], base = (w * from_3[0]) * (w * from_3[1]);
            sums_.area[i] += height * base;
            sums_.below[i] += volume * (1 - base * (w * from_0[2]));
        }
        return i;
    }

    const SpectrumField& field_;
    const IsovalueFinder& finder_;
    SpectrumSums& sums_;
};

/// Enough blocks for any number of threads and for cancelling, of at most 25 MB together.
std::size_t block_count(std::size_t cells, std::size_t isovalues) {
    constexpr std::size_t cells_per_block = std::size_t{1} << 14, max_blocks = 1024, max_sums = std::size_t{1} << 20;
    const std::size_t most = std::max<std::size_t>(1, std::min(max_blocks, max_sums / isovalues));
    return std::clamp<std::size_t>(cells / cells_per_block, 1, most);
}

ops::Spectrum total_of(const std::vector<SpectrumSums>& blocks, std::size_t count) {
    ops::Spectrum out{std::vector<double>(count), std::vector<double>(count), 0, 0, 0};
    for (const SpectrumSums& block : blocks) {
        out.volume += block.volume;
        out.tets += block.tets;
        out.no_data_tets += block.no_data_tets;
        double whole = 0;
        for (std::size_t i = 0; i < block.area.size(); ++i) {
            whole += block.whole[i];
            out.area[i] += block.area[i];
            out.volume_below[i] += block.below[i] + whole;
        }
    }
    double most = 0; // rounding must not let it fall
    for (double& volume : out.volume_below) most = volume = std::min(std::max(volume, most), out.volume);
    return out;
}

} // namespace

struct SpectrumPass::Data {
    SpectrumField field;
    std::size_t cells;
    IsovalueFinder finder;
    std::vector<SpectrumSums> blocks;
};

SpectrumPass::SpectrumPass(const core::PointReader& points, std::span<const double> values,
                           std::span<const double> isovalues, std::size_t cells)
    : data_(new Data{{points, values, isovalues}, cells, IsovalueFinder(isovalues), {}}) {
    data_->blocks.assign(block_count(cells, isovalues.size()), SpectrumSums(isovalues.size()));
}

SpectrumPass::~SpectrumPass() = default;

void SpectrumPass::add(const core::CellReader& cells, std::size_t first, const Progress& progress) {
    const std::size_t blocks = data_->blocks.size(), last = first + cells.count();
    const auto begin_of = [&](std::size_t block) { return data_->cells * block / blocks; };
    std::size_t begin = 0, end = blocks; // the blocks that these cells are in
    while (begin + 1 < blocks && begin_of(begin + 1) <= first) ++begin;
    while (end > begin + 1 && begin_of(end - 1) >= last) --end;
    std::atomic<std::size_t> done{begin};
    core::parallel_pieces(end - begin, 1, progress, [&](std::size_t from, std::size_t to) {
        for (std::size_t block = begin + from; block < begin + to; ++block) {
            SpectrumAdder adder(data_->field, data_->finder, data_->blocks[block]);
            cells.for_cells(std::max(begin_of(block), first) - first, std::min(begin_of(block + 1), last) - first,
                            [&](std::size_t, const core::CellTets& tets) {
                                for (const core::Tet& tet : tets) adder.add(tet);
                            });
            progress("measure", static_cast<double>(++done) / static_cast<double>(blocks));
        }
    });
}

ops::Spectrum SpectrumPass::finish() const { return total_of(data_->blocks, data_->field.isovalues.size()); }

ops::Spectrum contour_spectrum(const ops::SpectrumInput& input, const Progress& progress) {
    SpectrumPass pass(input.points, input.values, input.isovalues, input.cells.count());
    pass.add(input.cells, 0, progress);
    return pass.finish();
}

} // namespace isotet::cpu
