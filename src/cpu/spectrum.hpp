// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <isotet/progress.hpp>

#include "ops/spectrum.hpp"

namespace isotet::cpu {

/// As ops/spectrum.hpp. Parts of the sums are those of blocks of cells, which only the numbers of cells and isovalues
/// decide. Where progress.cancelled() afterwards, the numbers mean nothing.
ops::Spectrum contour_spectrum(const ops::SpectrumInput& input, const Progress& progress);

/// The same, byte for byte, of cells that go by in their order.
class SpectrumPass {
public:
    /// `values`, `isovalues`   as ops::SpectrumInput has them; borrowed
    /// `cells`                 how many will go by
    SpectrumPass(const core::PointReader& points, std::span<const double> values, std::span<const double> isovalues,
                 std::size_t cells);
    SpectrumPass(const SpectrumPass&) = delete;
    SpectrumPass& operator=(const SpectrumPass&) = delete;
    ~SpectrumPass();

    /// The next cells, checked; `first`: how many came before.
    void add(const core::CellReader& cells, std::size_t first, const Progress& progress);
    /// When all were added.
    ops::Spectrum finish() const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace isotet::cpu
