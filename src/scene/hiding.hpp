// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which of several surfaces hide others.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <isotet/isosurface_scene.hpp>

namespace isotet::scene {

/// Whether surface a covers more than two thirds of what is seen of surface b alone, in the mean of 14 directions. Sheets that
/// lie beside, behind and through each other show enough of themselves.
class Hiding {
public:
    explicit Hiding(std::span<const SurfacePoints> surfaces);

    bool hides(std::size_t a, std::size_t b) const {
        return a != b && 3 * hidden_[a * count_ + b] > 2 * seen_[b];
    }
    bool hides_any(std::size_t a) const {
        for (std::size_t b = 0; b < count_; ++b)
            if (hides(a, b)) return true;
        return false;
    }

private:
    /// From both ends of `view`, a direction.
    void look_along(std::span<const SurfacePoints> surfaces, const std::array<double, 3>& across,
                    const std::array<double, 3>& down, const std::array<double, 3>& view);

    std::size_t count_;
    std::array<double, 3> centre_{};
    double scale_ = 1;                        ///< all points are then within 1 of the centre
    std::vector<std::size_t> hidden_, seen_; ///< points, over all directions
};

} // namespace isotet::scene
