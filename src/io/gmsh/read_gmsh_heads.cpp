// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// An MSH file without the most of its long sections, which is all that inspect_gmsh() looks at.
#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "io/files/byte_source.hpp"
#include "io/gmsh/read_gmsh.hpp"
#include "io/gmsh/read_gmsh_parts.hpp"

namespace isotet::io {

namespace {

using gmsh::Form;
using gmsh::Section;
using gmsh::Version;

/// Enough for the tags of a data section and the first elements.
constexpr std::size_t head_bytes = std::size_t{1} << 16;
/// What is searched for the end of a section at most where a search is not worth it.
constexpr std::size_t short_bytes = std::size_t{1} << 20;
constexpr std::size_t search_bytes = std::size_t{4} << 20;

class Heads {
public:
    Heads(const io::ByteSource& source, bool searches, const Progress& progress)
        : source_(source), searches_(searches), progress_(progress) {}

    /// Nothing where the whole file is needed.
    Result<std::optional<std::string>> find() {
        begin_ = view(0, utf_8_mark.size()) == utf_8_mark ? utf_8_mark.size() : 0;
        std::size_t at = begin_;
        bool goes_on = true;
        while (goes_on && find_header(at)) goes_on = take_section(at);
        if (failed_) return *failed_;
        if (progress_.cancelled()) return Error{ErrorCode::cancelled, "reading was cancelled"};
        if (needs_all_ || !format_) return std::optional<std::string>();
        return std::optional(std::move(text_));
    }

private:
    /// At most so many bytes from `at` on, good until the next call; empty where reading failed.
    std::string_view view(std::size_t at, std::size_t bytes) {
        at = std::min(at, source_.size());
        bytes = std::min(bytes, source_.size() - at);
        if (at < window_at_ || at + bytes > window_at_ + window_.size()) {
            const std::size_t wanted = std::min(std::max(bytes, head_bytes), source_.size() - at);
            window_.resize(wanted);
            window_at_ = at;
            const auto read = source_.read(at, std::as_writable_bytes(std::span(window_)));
            if (!read) {
                failed_ = read.error();
                window_.clear();
                return {};
            }
        }
        return std::string_view(window_).substr(at - window_at_, bytes);
    }

    /// Moves to where `is_it` holds for what stands from there on, `least` bytes or to the end of the file. False where
    /// it does not, or a search would be too long.
    template <class IsIt>
    bool search(std::size_t& at, char first, std::size_t least, const IsIt& is_it) {
        const std::size_t start = at;
        while (at < source_.size() && !failed_ && !progress_.cancelled()) {
            if (!searches_ && at - start > short_bytes) {
                needs_all_ = true;
                return false;
            }
            const std::string_view bytes = view(at, searches_ ? search_bytes : head_bytes);
            const bool is_last = at + bytes.size() >= source_.size();
            std::size_t i = bytes.find(first);
            for (; i != std::string_view::npos && (is_last || i + least <= bytes.size()); i = bytes.find(first, i + 1))
                if (is_it(bytes.substr(i))) {
                    at += i;
                    return true;
                }
            if (is_last) break;
            at += i == std::string_view::npos ? bytes.size() : i;
        }
        at = source_.size();
        return false;
    }

    /// The next $ that starts a line.
    bool find_header(std::size_t& at) {
        const std::size_t start = at;
        for (; search(at, '$', 1, [](std::string_view) { return true; }); ++at) {
            if (at == begin_) return true;
            const std::string_view before = view(at - 1, 1);
            if (before == "\n" || before == "\r") return true;
            needs_all_ = !searches_ && at - start > short_bytes;
            if (needs_all_) return false;
        }
        return false;
    }

    /// The section whose $ is at `at`, which moves behind it. False where the file ends.
    bool take_section(std::size_t& at) {
        const std::string_view head = view(at, head_bytes);
        const std::size_t line = head.find('\n');
        constexpr std::size_t long_line = 1024;
        if (line > long_line) return needs_all_ = true, false;
        const std::string name(head.substr(1, head.find_first_of(" \t\r\n") - 1));
        const std::string end_word = gmsh::end_of(name);
        const std::size_t start = at + line + 1;
        std::size_t end = end_by_counts(name, start, end_word);
        bool ended = end > start;
        if (!ended) {
            end = start;
            ended = search(end, '$', end_word.size() + 1, [&](std::string_view bytes) {
                return bytes.starts_with(end_word) &&
                       (bytes.size() == end_word.size() || is_space(bytes[end_word.size()]));
            });
        }
        if (failed_ || needs_all_) return false;
        append(name, start, end);
        if (ended) text_ += end_word + "\n";
        at = end + 1;
        return ended && (name != "MeshFormat" || read_format());
    }

    /// The name and the body, of long sections its beginning.
    void append(const std::string& name, std::size_t start, std::size_t end) {
        static const std::set<std::string_view> whole{"MeshFormat", "PhysicalNames", "Entities", "PartitionedEntities"};
        const std::size_t bytes = whole.contains(name) ? end - start : std::min(end - start, head_bytes);
        text_ += "$" + name + "\n";
        text_ += view(start, bytes);
        if (bytes < end - start) text_ += "\n";
    }

    /// Of what is there so far. What is wrong with it is told when the whole file is there.
    bool read_format() {
        const auto file = gmsh::open(text_);
        if (!file) return needs_all_ = true, false;
        version_ = file->version;
        format_ = file->sections.back().form;
        return true;
    }

    template <class Number>
    bool read(std::size_t& at, Number& number) {
        ByteReader reader(view(at, sizeof(Number)), format_->swapped);
        at += sizeof(Number);
        return reader.read(number);
    }
    bool read_count(std::size_t& at, std::int64_t& count) {
        if (format_->count_bytes == 8) return read(at, count);
        std::int32_t narrow = 0;
        const bool there = read(at, narrow);
        count = narrow;
        return there;
    }

    /// Moves behind so many records.
    bool jump(std::size_t& at, std::int64_t records, std::size_t bytes) const {
        const std::size_t left = source_.size() - std::min(at, source_.size());
        if (records < 0 || static_cast<std::uint64_t>(records) > left / bytes) return false;
        at += static_cast<std::size_t>(records) * bytes;
        return true;
    }

    /// Where $End... stands by the counts in a binary section; 0: they do not say.
    std::size_t end_by_counts(const std::string& name, std::size_t start, const std::string& end_word) {
        if (!format_ || !format_->binary) return 0;
        std::size_t at = start;
        const bool known = name == "Nodes" ? (version_ == Version::v2 ? pass_nodes_2(at) : pass_blocks_4(at, true))
                           : name == "Elements"
                               ? (version_ == Version::v2 ? pass_elements_2(at) : pass_blocks_4(at, false))
                               : (name == "NodeData" || name == "ElementData") && pass_data(name, at);
        if (!known) return 0;
        constexpr std::size_t line_end = 2; // \r\n
        const std::string_view there = view(at, line_end + end_word.size() + 1);
        const std::size_t spaces = std::min(there.find_first_not_of("\r\n"), line_end + 1);
        if (spaces > line_end || !there.substr(spaces).starts_with(end_word)) return 0;
        const std::string_view behind = there.substr(spaces + end_word.size());
        return behind.empty() || is_space(behind.front()) ? at + spaces : 0;
    }

    bool pass_count_line(std::size_t& at, std::int64_t& count) {
        TextScanner scanner(view(at, 64));
        if (!scanner.number(count)) return false;
        scanner.next_line();
        at += scanner.position();
        return true;
    }
    bool pass_nodes_2(std::size_t& at) {
        std::int64_t count = 0;
        return pass_count_line(at, count) && jump(at, count, 4 + 3 * 8);
    }
    bool pass_elements_2(std::size_t& at) {
        std::int64_t count = 0;
        if (!pass_count_line(at, count)) return false;
        while (count > 0 && !progress_.cancelled()) {
            std::int32_t kind = 0, in_block = 0, tags = 0;
            if (!read(at, kind) || !read(at, in_block) || !read(at, tags)) return false;
            const auto type = gmsh::element_type(kind);
            constexpr std::int32_t most_tags = 1 << 20;
            if (!type || in_block < 1 || in_block > count || tags < 0 || tags > most_tags) return false;
            if (!jump(at, in_block, 4 * (1 + static_cast<std::size_t>(tags) + type->nodes))) return false;
            count -= in_block;
        }
        return count == 0;
    }
    /// $Nodes or $Elements of version 4.
    bool pass_blocks_4(std::size_t& at, bool nodes) {
        std::int64_t blocks = 0, skipped = 0;
        if (!read_count(at, blocks)) return false;
        for (int i = 0; i < (version_ == Version::v41 ? 3 : 1); ++i)
            if (!read_count(at, skipped)) return false;
        for (; blocks > 0 && !progress_.cancelled(); --blocks) {
            std::int32_t first = 0, second = 0, kind = 0;
            std::int64_t count = 0;
            if (!read(at, first) || !read(at, second) || !read(at, kind) || !read_count(at, count)) return false;
            const std::int32_t dimension = version_ == Version::v40 ? second : first;
            const auto type = nodes ? std::nullopt : gmsh::element_type(kind);
            if (dimension < 0 || dimension > 3 || (!nodes && !type)) return false;
            const std::size_t parameters = kind != 0 ? static_cast<std::size_t>(dimension) : 0;
            const std::size_t bytes = nodes ? format_->number_bytes + 8 * (3 + parameters)
                                            : format_->number_bytes * (std::size_t{1} + type->nodes);
            if (!jump(at, count, bytes)) return false;
        }
        return blocks == 0;
    }
    bool pass_data(const std::string& name, std::size_t& at) {
        gmsh::File file;
        file.version = version_;
        const std::string head(view(at, head_bytes));
        file.sections.push_back({.name = name, .body = head, .start = at, .ended = true, .form = *format_});
        FileInfo info;
        const auto data = gmsh::data_sections(file, info);
        if (data.size() != 1) return false;
        at += data[0].values;
        return jump(at, data[0].count, 4 + 8 * static_cast<std::size_t>(data[0].components));
    }

    const io::ByteSource& source_;
    bool searches_;
    const Progress& progress_;
    std::size_t begin_ = 0; ///< behind a byte order mark
    std::string window_;    ///< bytes of the file from `window_at_` on
    std::size_t window_at_ = 0;
    std::string text_; ///< the result
    Version version_ = Version::v2;
    std::optional<Form> format_;
    std::optional<Error> failed_;
    bool needs_all_ = false;
};

} // namespace

Result<std::optional<std::string>> heads_of_gmsh(const io::ByteSource& source, bool searches,
                                                 const Progress& progress) {
    return Heads(source, searches, progress).find();
}

} // namespace isotet::io
