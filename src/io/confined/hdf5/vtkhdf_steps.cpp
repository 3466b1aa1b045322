// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/hdf5/vtkhdf_steps.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "io/confined/hdf5/hdf5_array.hpp"
#include "io/files/time_values.hpp"

namespace isotet::io::confined {

Array as_coordinates(Array points) {
    if (is_floating(points.type())) return points;
    std::vector<double> places(points.size());
    points.visit([&](auto from) {
        std::ranges::transform(from, places.begin(), [](auto x) { return static_cast<double>(x); });
    });
    return Array::own(std::move(places), points.components());
}

HdfSteps steps_of(const std::string& path, const std::string& root) {
    constexpr std::int64_t most = 1 << 24;
    const auto groups = groups_of(path, root);
    if (std::ranges::find(groups, "Steps") == groups.end()) return {};
    HdfSteps steps;
    if (const auto values = read_hdf5_array(path, root + "/Steps/Values", {}, Depth::arrays)) {
        steps.times = time_values(values->values);
        return steps;
    }
    const std::int64_t count = integer_attribute(path, root + "/Steps", "NSteps").value_or(0);
    if (count > 0 && count <= most) {
        steps.times.resize(static_cast<std::size_t>(count));
        std::iota(steps.times.begin(), steps.times.end(), 0.0);
    }
    steps.missing = LeftOut{"array", "Steps/Values",
                            steps.times.empty() ? "it cannot be read, and the file is read as one without steps"
                                                : "it cannot be read: the numbers of the steps were taken, from 0"};
    return steps;
}

} // namespace isotet::io::confined
