// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "output_names.hpp"

#include <string_view>
#include <utility>

#include "number_format.hpp"

namespace isotet::cli {

namespace {

constexpr std::string_view value_mark = "{value}";
constexpr std::string_view time_mark = "{time}";

} // namespace

OutputNames::OutputNames(std::string pattern)
    : pattern_(std::move(pattern)),
      by_value_(pattern_.find(value_mark) != std::string::npos),
      by_time_(pattern_.find(time_mark) != std::string::npos) {}

std::string OutputNames::name(double value, std::optional<double> time) const {
    std::string name;
    for (std::string_view rest = pattern_; !rest.empty();) {
        if (rest.starts_with(value_mark)) {
            name += shortest(value);
            rest.remove_prefix(value_mark.size());
        } else if (time && rest.starts_with(time_mark)) {
            name += shortest(*time);
            rest.remove_prefix(time_mark.size());
        } else {
            name += rest.front();
            rest.remove_prefix(1);
        }
    }
    return name;
}

} // namespace isotet::cli
