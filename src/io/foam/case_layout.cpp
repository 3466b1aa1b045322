// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/foam/case_layout.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/core.h>

#include "io/pieces/loaded.hpp"

namespace isotet::io::foam {

namespace {

std::optional<double> time_of_folder(const std::string& name) {
    double time = 0;
    const auto [rest, error] = std::from_chars(name.data(), name.data() + name.size(), time);
    const bool whole = error == std::errc{} && rest == name.data() + name.size() && std::isfinite(time);
    return whole ? std::optional(time) : std::nullopt;
}

std::vector<std::pair<double, std::string>> times_in(const CaseFiles& files, const std::string& prefix) {
    std::vector<std::pair<double, std::string>> times;
    for (const std::string& name : files.list(prefix).folders)
        if (const auto time = time_of_folder(name)) times.emplace_back(*time, name);
    std::ranges::sort(times);
    // "0" and "0.0": the first.
    const auto again = std::ranges::unique(times, {}, [](const auto& time) { return time.first; });
    times.erase(again.begin(), again.end());
    return times;
}

bool has_mesh(const CaseFiles& files, const std::string& folder) {
    return files.has(folder + "polyMesh/faces") || files.has(folder + "polyMesh/points");
}

std::vector<std::string> regions_in(const CaseFiles& files, const std::string& prefix,
                                    const std::vector<std::pair<double, std::string>>& times) {
    std::vector<std::string> folders{"constant/"};
    if (!times.empty()) folders.push_back(times.front().second + "/"); // a mesh that was made later
    if (times.size() > 1) folders.push_back(times.back().second + "/");
    std::vector<std::string> regions;
    const auto add = [&](const std::string& region) {
        if (std::ranges::find(regions, region) == regions.end()) regions.push_back(region);
    };
    for (const std::string& folder : folders) {
        if (has_mesh(files, prefix + folder)) add("");
        for (const std::string& name : files.list(prefix + folder).folders)
            if (has_mesh(files, prefix + folder + name + "/")) add(name);
    }
    std::ranges::stable_partition(regions, [](const std::string& region) { return region.empty(); });
    return regions;
}

std::string processor_folder(std::size_t number) { return fmt::format("processor{}/", number); }

/// How many folders processor0, processor1 and so on there are, without a gap.
Result<std::size_t> processors_in(const CaseFiles& files) {
    if (const std::size_t count = files.unlisted_processors(); count > 0) return count;
    std::vector<std::size_t> numbers;
    for (const std::string& name : files.list("").folders) {
        constexpr std::string_view begin = "processor";
        if (!name.starts_with(begin) || name.size() == begin.size()) continue;
        std::size_t number = 0;
        const auto [rest, error] = std::from_chars(name.data() + begin.size(), name.data() + name.size(), number);
        if (error == std::errc{} && rest == name.data() + name.size()) numbers.push_back(number);
    }
    std::ranges::sort(numbers);
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (numbers[i] != i)
            return broken(files.path_of(fmt::format("processor{}", i)),
                          fmt::format("is not there, but processor{} is", numbers[i]));
    return numbers.size();
}

} // namespace

Result<CaseLayout> layout_of(const CaseFiles& files) {
    auto processors = processors_in(files);
    if (!processors) return processors.error();
    CaseLayout layout;
    layout.prefixes = {""};
    layout.times = times_in(files, "");
    layout.regions = regions_in(files, "", layout.times);
    if (*processors > 0) {
        auto times = times_in(files, processor_folder(0));
        const bool later = !times.empty() && (layout.times.empty() || times.back().first > layout.times.back().first);
        auto regions = regions_in(files, processor_folder(0), times);
        if ((layout.regions.empty() || later) && !regions.empty()) {
            layout = {{}, std::move(times), std::move(regions), {}};
            for (std::size_t i = 0; i < *processors; ++i) layout.prefixes.push_back(processor_folder(i));
        } else {
            layout.notes.push_back(
                fmt::format("{} processor folders were not read: the case's own folder is as complete", *processors));
        }
    }
    if (layout.regions.empty())
        return broken(files.path_of("constant/polyMesh/points"),
                      "is not there: a case has its mesh in constant/polyMesh");
    return layout;
}

Result<MeshPlace> mesh_place(const CaseFiles& files, const CaseLayout& layout, const std::string& prefix,
                             const std::string& region, std::size_t step) {
    const std::string inside = (region.empty() ? "" : region + "/") + "polyMesh";
    const auto find = [&](const char* file) {
        for (std::size_t t = std::min(step + 1, layout.times.size()); t > 0; --t) {
            std::string folder = prefix + layout.times[t - 1].second + "/" + inside;
            if (files.has(folder + file)) return folder;
        }
        return prefix + "constant/" + inside;
    };
    return MeshPlace{find("/points"), find("/faces")};
}

} // namespace isotet::io::foam
