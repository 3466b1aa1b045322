// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "options/command_options.hpp"

#include <charconv>
#include <cmath>
#include <memory>

namespace isotet::cli {

void add_refinement(const Command& command, RefineChoice& refine, bool* asked) {
    const OptionGroup group(command, "Curved cells");
    const auto number = [](const std::string& name, const std::string& text, std::size_t size, const char* rule) {
        double value = 0;
        const char* const end = text.data() + size;
        const auto [stopped, fault] = std::from_chars(text.data(), end, value);
        if (fault != std::errc{} || stopped != end || !std::isfinite(value) || value <= 0)
            refuse_value(name, text, rule);
        return value;
    };
    // Options are taken in this order, whatever the order on the command line.
    const auto given = std::make_shared<bool>(false);
    command.add_value(
        "--tolerance",
        [&refine, number, given, asked](const std::string& text) {
            *given = true;
            if (asked) *asked = true;
            if (text == "nodes") {
                refine.reset();
                return;
            }
            const bool percent = text.ends_with('%');
            const double value = number("--tolerance", text, text.size() - (percent ? 1 : 0),
                                        "a number above 0, one with %, such as 0.1%, or nodes");
            (percent ? refine->relative_tolerance : refine->tolerance) = percent ? value / 100 : value;
        },
        "T|P%|nodes",
        "Quadratic cells: largest error of the field, in its unit or in % of its range, default: 0.1%; nodes splits "
        "cells at their nodes, without a bound: the default for averaged cell fields");
    const auto add_length = [&](const std::string& name, auto set, const char* help) {
        command.add_value(
            name,
            [&refine, number, name, set, asked](const std::string& text) {
                if (asked) *asked = true;
                const double value = number(name, text, text.size(), "a number above 0");
                if (!refine)
                    refuse_value(name, text, "a distance only where cells are refined: not with --tolerance nodes");
                set(*refine, value);
            },
            "D", help);
    };
    add_length(
        "--distance",
        [given](RefineOptions& options, double value) {
            options.distance = value;
            if (!*given) options.relative_tolerance = 0;
        },
        "Quadratic cells: largest distance of the surface from that of the quadratic field, by estimate; in place of "
        "--tolerance, or beside it");
    add_length(
        "--geometry-tolerance", [](RefineOptions& options, double value) { options.geometry_tolerance = value; },
        "Quadratic cells: largest distance of the tets from the curved cells; default: a hundredth of each edge's "
        "length");
}

} // namespace isotet::cli
