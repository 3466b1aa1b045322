// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The files that a command writes: OUT with its placeholders filled in, its format, and whether it can be written.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/read.hpp>
#include <isotet/result.hpp>
#include <isotet/write.hpp>

namespace isotet::jobs {

/// A file of `isotet extract`.
struct OutputKey {
    double value = 0;           ///< isovalue
    std::optional<double> time; ///< there when OutputNames::by_time()
    std::size_t step = 0, steps = 1;
};

/// OUT of `isotet extract`, with {value}, {time} and {step}.
class OutputNames {
public:
    explicit OutputNames(std::string pattern);

    bool none() const noexcept { return pattern_.empty(); }
    bool by_value() const noexcept { return by_value_; }
    bool by_time() const noexcept { return by_time_; }
    bool by_step() const noexcept { return by_time_ || by_number_; } ///< a file for each time step
    bool fixed() const noexcept { return !by_value_ && !by_step(); }
    const std::string& pattern() const noexcept { return pattern_; }

    /// Steps have as many digits as the last one: ParaView takes such names for a series.
    std::string name(const OutputKey& key) const;

    /// OUT without its placeholders and what joins them, in .pvd: "front-{time}.vtp" gives "front.pvd".
    std::string collection() const;

private:
    std::string pattern_;
    bool by_value_, by_time_, by_number_;
};

/// Refuses words in braces that stand for nothing: "OUT, 'x-{val}.vtp', has {val}, but only {value} stands for ...".
Result<void> check_placeholders(const std::string& out, const std::vector<std::string>& known);

/// The format that the ending of `path` names. Errors: invalid_argument with the endings that there are.
enum class Writes { grid, surface };
Result<Format> format_for_writing(const std::string& path, Writes what, Compression compression);

/// The lower-case ending of a name: ".vtp".
std::string ending_of(const std::string& path);

/// Refuses an output that is one of the inputs (the same file, however it is spelled), two outputs that are one file,
/// and an output that cannot be written at all. Empty names and "-" are passed over.
Result<void> check_output_paths(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

/// True when both names lead to the same file, or would once it is there.
bool same_file(const std::string& a, const std::string& b);

} // namespace isotet::jobs
