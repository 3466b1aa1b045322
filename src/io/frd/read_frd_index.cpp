// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/frd/read_frd_index.hpp"

#include <algorithm>
#include <array>

#include <fmt/core.h>

#include "base/errors.hpp"

namespace isotet::io::frd {

namespace {

constexpr std::size_t count_column = 24, count_width = 12, form_column = 73;

std::string_view without_spaces(std::string_view text) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    return text;
}

/// "-3" of " -3", "100C" of "  100CL  101": the key of a line and the letter behind it.
std::string_view key_of(std::string_view line) {
    std::size_t begin = 0;
    while (begin < line.size() && begin < 6 && line[begin] == ' ') ++begin;
    std::size_t end = begin;
    if (end < line.size() && line[end] == '-') ++end;
    while (end < line.size() && end < 6 && line[end] >= '0' && line[end] <= '9') ++end;
    if (end > begin && line[begin] != '-' && end < line.size() && line[end] != ' ') ++end;
    return line.substr(begin, end - begin);
}

/// Of an array or a component.
std::string name_in(std::string_view line) {
    return std::string(without_spaces(line.substr(std::min<std::size_t>(5, line.size()), 8)));
}

/// What stands in the columns of the digit; long text where there is none.
Form form_of(std::string_view line) {
    int digit = 1;
    number_at(line, form_column, 2, digit);
    return digit == 0   ? Form::short_text
           : digit == 2 ? Form::binary_float
           : digit == 3 ? Form::binary_double
                        : Form::long_text;
}

bool begins_block(std::string_view key) {
    return key == "1C" || key == "1U" || key == "1P" || key == "2C" || key == "3C" || key == "100C" || key == "9999";
}

/// Behind the records of a text block; begins at the first of them. False: the file ends before. A block without its
/// last line ends where another one begins.
bool skip_text(std::string_view file, std::size_t& at, std::size_t& end) {
    while (at < file.size()) {
        end = at;
        const std::string_view key = key_of(take_line(file, at));
        if (key == "-3") return true;
        if (begins_block(key)) {
            at = end;
            return true;
        }
    }
    end = file.size();
    return false;
}

bool skip_bytes(std::string_view file, std::size_t& at, std::uint64_t records, std::uint64_t bytes) {
    if (records > (file.size() - at) / std::max<std::uint64_t>(bytes, 1)) return false;
    at += static_cast<std::size_t>(records * bytes);
    return true;
}

std::uint64_t real_bytes(Form form) { return form == Form::binary_double ? 8 : 4; }

template <class Number>
Number stored_at(std::string_view file, std::size_t at) {
    Number value{};
    std::copy_n(file.data() + at, sizeof value, reinterpret_cast<char*>(&value));
    return value;
}

/// Elements in a binary block have as many nodes as their type.
bool skip_binary_elements(std::string_view file, std::size_t& at, std::uint64_t count) {
    constexpr std::size_t head = 16;
    for (std::uint64_t i = 0; i < count; ++i) {
        if (file.size() - at < head) return false;
        const std::uint32_t nodes = element_type(stored_at<std::int32_t>(file, at + 4)).nodes;
        if (nodes == 0 || (file.size() - at - head) / 4 < nodes) return false;
        at += head + std::size_t{4} * nodes;
    }
    return true;
}

class Indexer {
public:
    explicit Indexer(std::string_view file) : file_(file) {}

    Result<Index> run() {
        while (at_ < file_.size()) {
            const std::size_t begin = at_;
            const std::string_view line = take_line(file_, at_);
            const std::string_view key = key_of(line);
            if (key == "9999") break;
            if (key == "2C" || key == "3C") {
                if (auto taken = take_mesh(line, key == "2C"); !taken) return taken.error();
            } else if (key == "100C") {
                take_values(line);
            } else if (!begins_block(key) && !without_spaces(line).empty()) {
                if (index_.unknown_lines++ == 0) index_.first_unknown = begin;
            }
        }
        return std::move(index_);
    }

private:
    static Block block_of(std::string_view line) {
        Block block;
        block.form = form_of(line);
        number_at(line, count_column, count_width, block.count);
        return block;
    }

    Result<void> take_mesh(std::string_view line, bool nodes) {
        const char* const what = nodes ? "nodes" : "elements";
        const std::size_t begin = at_ - line.size();
        Block block = block_of(line);
        block.begin = at_;
        bool ends = false;
        if (!is_binary(block.form)) {
            ends = skip_text(file_, at_, block.end);
        } else {
            ends = nodes ? skip_bytes(file_, at_, block.count, 4 + 3 * real_bytes(block.form))
                         : skip_binary_elements(file_, at_, block.count);
            block.end = at_;
        }
        if (!ends)
            return invalid_data(
                fmt::format("the block of {} at byte {} is cut short: it announces {}", what, begin, block.count));
        bool& has = nodes ? index_.has_nodes : index_.has_elements;
        if (has) ++index_.more_meshes;
        else (nodes ? index_.nodes : index_.elements) = block;
        has = true;
        return {};
    }

    /// "100C", "-4", some "-5", then the records.
    void take_values(std::string_view line) {
        const std::size_t begin = at_ - line.size();
        Values values;
        values.block = block_of(line);
        double value = 0;
        std::int64_t number = 0;
        number_at(line, 12, 12, value);
        number_at(line, 58, 5, number);
        for (std::size_t before = at_; at_ < file_.size(); before = at_) {
            const std::string_view next = take_line(file_, at_);
            const std::string_view key = key_of(next);
            if (key == "-4") {
                values.name = name_in(next);
            } else if (key == "-5") {
                int made = 0;
                number_at(next, 33, 5, made);
                if (made != 1) values.components.push_back(name_in(next));
            } else {
                at_ = before;
                break;
            }
        }
        values.block.begin = at_;
        bool ends = false;
        if (!is_binary(values.block.form)) {
            ends = skip_text(file_, at_, values.block.end);
        } else {
            ends = skip_bytes(file_, at_, values.block.count,
                              4 + values.components.size() * real_bytes(values.block.form));
            if (!ends) {
                index_.cut_at = begin;
                at_ = file_.size();
            }
            values.block.end = at_;
        }
        if (!ends) values.problem = "its values are cut short";
        else if (values.components.empty() || values.components.size() > max_components)
            values.problem = "it has no components";
        add(number, value, std::move(values));
    }

    /// A field that the step has already is one of another part of the result, or of a step that is not numbered.
    void add(std::int64_t number, double value, Values values) {
        if (index_.steps.empty() || index_.steps.back().number != number || index_.steps.back().value != value)
            index_.steps.push_back({number, value, {}});
        auto& all = index_.steps.back().values;
        const std::string name = values.name;
        for (int copy = 2; std::ranges::find(all, values.name, &Values::name) != all.end(); ++copy)
            values.name = fmt::format("{}_{}", name, copy);
        values.fields = fields_of_components(values.name, values.components);
        all.push_back(std::move(values));
    }

    static constexpr std::size_t max_components = 64;

    std::string_view file_;
    std::size_t at_ = 0;
    Index index_;
};

} // namespace

ElementType element_type(std::int64_t number) {
    static constexpr std::array<ElementType, 13> types{{{0, 0},
                                                        {8, 12},
                                                        {6, 13},
                                                        {4, 10},
                                                        {20, 25},
                                                        {15, 26},
                                                        {10, 24},
                                                        {3, 5},
                                                        {6, 22},
                                                        {4, 9},
                                                        {8, 23},
                                                        {2, 3},
                                                        {3, 21}}};
    return number > 0 && number < static_cast<std::int64_t>(types.size()) ? types[static_cast<std::size_t>(number)]
                                                                          : ElementType{};
}

std::string_view take_line(std::string_view file, std::size_t& at) {
    const std::size_t end = std::min(file.find('\n', at), file.size());
    std::string_view line = file.substr(at, end - at);
    at = std::min(end + 1, file.size());
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

Result<Index> index_of(std::string_view file) { return Indexer(file).run(); }

} // namespace isotet::io::frd
