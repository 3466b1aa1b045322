// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/touched_region.hpp"

#include <isotet/fields.hpp>

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "jobs/refuse.hpp"

namespace isotet::jobs {

namespace {

/// "3" or "3:5", into the bounds of a region.
bool read_bounds(std::string_view text, Region& region) {
    const char* const end = text.data() + text.size();
    const auto [colon, first] = std::from_chars(text.data(), end, region.lower);
    region.upper = region.lower;
    if (first != std::errc{} || colon == end) return first == std::errc{};
    if (*colon != ':') return false;
    const auto [rest, second] = std::from_chars(colon + 1, end, region.upper);
    return second == std::errc{} && rest == end && region.lower <= region.upper;
}

Error no_such_region(const std::string& name, const GridSource& source) {
    std::vector<std::string> names;
    for (const RegionName& region : source.info().regions) names.push_back(region.name);
    const std::string named = names.empty() ? "names none" : "names " + quoted_list(nearest_first(name, names));
    const std::vector<std::string> fields = source.names(Association::cell);
    return refusal("`keep` touching got '{}': the file {} and has {}; 'boundary' and FIELD=VALUE of a cell field are "
                   "regions, too",
                   name, named, fields.empty() ? "no cell field" : "the cell fields " + quoted_list(fields));
}

} // namespace

Result<std::optional<Region>> find_touched(const ExtractJob& job, const GridSource& source) {
    if (!job.keep || job.keep->kind != PartChoice::Kind::touching) return std::optional<Region>{};
    const std::string& name = job.keep->region;
    if (name == "boundary") return job.solid ? std::optional<Region>{{"boundary", 1, 1}} : std::nullopt;
    const auto& named = source.info().regions;
    if (const auto region = std::ranges::find(named, name, &RegionName::name); region != named.end()) {
        const auto number = static_cast<double>(region->number);
        return std::optional<Region>{{region->field, number, number}};
    }
    const std::size_t equals = name.rfind('=');
    const std::vector<std::string> fields = source.names(Association::cell);
    if (equals == std::string::npos || std::ranges::find(fields, name.substr(0, equals)) == fields.end())
        return no_such_region(name, source);
    Region region{name.substr(0, equals), 0, 0};
    if (!read_bounds(std::string_view(name).substr(equals + 1), region))
        return refusal("`keep` touching got '{}', but takes a number or two that ascend, A:B, behind the '='", name);
    return std::optional<Region>{region};
}

} // namespace isotet::jobs
