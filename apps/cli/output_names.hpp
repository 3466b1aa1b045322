// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The files that `isotet extract` writes: OUT with its {value} and {time} filled in.
#pragma once

#include <optional>
#include <string>

#include <isotet/result.hpp>

namespace isotet::cli {

class OutputNames {
public:
    explicit OutputNames(std::string pattern);

    bool none() const noexcept { return pattern_.empty(); }
    bool by_value() const noexcept { return by_value_; }
    bool by_time() const noexcept { return by_time_; }
    const std::string& pattern() const noexcept { return pattern_; }

    /// The name of one file; `time` is there when by_time().
    std::string name(double value, std::optional<double> time) const;

private:
    std::string pattern_;
    bool by_value_, by_time_;
};

} // namespace isotet::cli
