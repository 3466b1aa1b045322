// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Charts as SVG: lines over two logarithmic axes.
#pragma once

#include <string>
#include <vector>

namespace isotet::cli {

struct ChartPoint {
    double x = 0, y = 0; ///< both positive; others are left out
};

struct ChartLine {
    std::string name;
    std::vector<ChartPoint> points; ///< by x
    bool dashed = false;            ///< not measured here
};

struct Chart {
    std::string title, subtitle, x_title, y_title;
    std::vector<ChartLine> lines;

    /// Whole decades on both axes, a colour and a name at the end of each line. The same text for the same chart.
    std::string svg() const;
};

} // namespace isotet::cli
