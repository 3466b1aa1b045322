// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "option_values.hpp"

#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "number_format.hpp"

namespace isotet::cli {

namespace {

double finite_number(const std::string& names, std::string_view text) {
    const std::optional<double> value = parse_number(text);
    if (!value || !std::isfinite(*value)) throw wrong_value(names, text, "a finite number");
    return *value;
}

} // namespace

CLI::ValidationError wrong_value(const std::string& names, std::string_view given, std::string_view rule) {
    const std::string name = names.substr(names.rfind(',') + 1); // npos + 1 is 0
    return CLI::ValidationError(fmt::format("{} got '{}', but it takes {}", name, given, rule));
}

CLI::Option* add_text(CLI::App& app, const std::string& names, std::string& target, const std::string& type,
                      const std::string& description) {
    return app.add_option(names, target, description)->type_name(type);
}

CLI::Option* add_file(CLI::App& app, const std::string& names, std::string& target, const std::string& type,
                      const std::string& description) {
    return app
        .add_option_function<std::string>(
            names,
            [&target, names](const std::string& name) {
                if (name.empty()) throw wrong_value(names, name, "the name of a file");
                target = name;
            },
            description)
        ->type_name(type);
}

CLI::Option* add_number(CLI::App& app, const std::string& names, std::function<void(double)> set,
                        const std::string& type, const std::string& description) {
    return app
        .add_option_function<std::string>(
            names, [set = std::move(set), names](const std::string& text) { set(finite_number(names, text)); },
            description)
        ->type_name(type);
}

CLI::Option* add_count(CLI::App& app, const std::string& names, CountLimits limits,
                       std::function<void(std::uint64_t)> set, const std::string& type,
                       const std::string& description) {
    return app
        .add_option_function<std::string>(
            names,
            [set = std::move(set), names, limits](const std::string& text) {
                const std::optional<std::uint64_t> value = parse_count(text);
                if (!value || *value < limits.lowest || *value > limits.highest) {
                    const std::string upwards =
                        limits.highest == UINT64_MAX ? "on" : fmt::format("to {}", limits.highest);
                    throw wrong_value(names, text, fmt::format("a whole number from {} {}", limits.lowest, upwards));
                }
                set(*value);
            },
            description)
        ->type_name(type);
}

CLI::Option* add_numbers(CLI::App& app, const std::string& names, std::vector<double>& target, const std::string& type,
                         const std::string& description) {
    return app
        .add_option_function<std::vector<std::string>>(
            names,
            [&target, names](const std::vector<std::string>& lists) {
                for (const std::string& list : lists) {
                    for (std::size_t begin = 0; begin <= list.size();) {
                        const std::size_t end = std::min(list.find(',', begin), list.size());
                        target.push_back(finite_number(names, std::string_view(list).substr(begin, end - begin)));
                        begin = end + 1;
                    }
                }
            },
            description)
        ->type_name(type)
        ->allow_extra_args(false);
}

} // namespace isotet::cli
