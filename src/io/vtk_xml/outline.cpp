// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk_xml/outline.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "io/files/pace.hpp"
#include "io/files/text_scanner.hpp"

namespace isotet::io::vtk_xml {
namespace {

/// The first window mostly has all tags of a file whose data are appended; the others are for text between tags.
constexpr std::size_t first_window = std::size_t{1} << 16, later_windows = std::size_t{1} << 20;
constexpr std::size_t max_bytes = std::size_t{64} << 20; ///< of tags

/// Goes through the source window by window.
class Walk {
public:
    Walk(const ByteSource& source, const Progress& progress) : source_(source), progress_(progress) {}

    Result<Outline> run() {
        while (find('<')) {
            const std::size_t open = position_;
            close_text(open);
            if (auto taken = take_tag(open); !taken) return taken.error();
            if (outline_.appended) break;
        }
        if (error_) return *error_;
        return std::move(outline_);
    }

private:
    /// Moves to the next such character; false at the end, or when reading failed.
    bool find(char wanted) {
        while (fill()) {
            const auto at = window_.find(wanted, position_ - begin_);
            if (at != std::string_view::npos) {
                position_ = begin_ + at;
                return true;
            }
            position_ = begin_ + window_.size();
        }
        return false;
    }

    /// The window around the position; false at the end, or when reading failed.
    bool fill() {
        if (error_ || position_ >= source_.size()) return false;
        if (position_ >= begin_ && position_ - begin_ < window_.size()) return true;
        if (progress_.cancelled()) {
            error_ = Pace::cancelled();
            return false;
        }
        begin_ = position_;
        const std::size_t most = begin_ == 0 ? first_window : later_windows;
        const auto view = source_.view(begin_, std::min(most, source_.size() - begin_), scratch_);
        if (!view) error_ = view.error();
        else window_ = *view;
        return !error_;
    }

    bool next(char& c) {
        if (!fill()) return false;
        c = window_[position_++ - begin_];
        return true;
    }

    /// The text between the start tag before and this tag.
    void close_text(std::size_t end) {
        if (text_begin_) fmt::format_to(std::back_inserter(outline_.text), "{} {} ", *text_begin_, end);
        text_begin_.reset();
    }

    Result<void> failed(std::size_t open, std::string_view what) const {
        if (error_) return *error_;
        return invalid_data(fmt::format("the tag at byte {}: {}", open, what));
    }

    /// The tag at the cursor, whose closing > is the first one outside of quotes.
    Result<void> take_tag(std::size_t open) {
        const std::size_t begin = outline_.text.size();
        char c = 0, quote = 0;
        for (bool first = true;; first = false) {
            if (!next(c)) return failed(open, "it never ends");
            if (!first && !quote && c == '<') return failed(open, "a tag inside a tag");
            if (outline_.text.size() >= max_bytes)
                return invalid_data(fmt::format("there are more than {} bytes of tags", max_bytes));
            outline_.text += c;
            if (quote) quote = c == quote ? '\0' : quote;
            else if (c == '"' || c == '\'') quote = c;
            else if (c == '>') break;
            const auto start = std::string_view(outline_.text).substr(begin);
            if (start == "<!--") return skip_comment(open, begin);
            if (start == "<![CDATA[") return take_character_data(open, begin);
            if (start == "<!DOCTYPE") return skip_document_type(open, begin);
        }
        return sort_tag(open, begin);
    }

    /// Text of an array goes on behind what stands in it.
    void go_on_with_text() {
        if (in_array_) text_begin_ = position_;
    }

    /// Up to the > outside of quotes and of the brackets with its own declarations, none of which is used.
    Result<void> skip_document_type(std::size_t open, std::size_t begin) {
        outline_.text.resize(begin);
        char quote = 0;
        bool in_brackets = false;
        for (char c = 0; next(c);) {
            if (quote) quote = c == quote ? '\0' : quote;
            else if (c == '"' || c == '\'') quote = c;
            else if (c == '[' || c == ']') in_brackets = c == '[';
            else if (c == '>' && !in_brackets) return {};
        }
        return failed(open, "it never ends");
    }

    Result<void> take_character_data(std::size_t open, std::size_t begin) {
        outline_.text.resize(begin);
        const std::size_t text = position_;
        for (int brackets = 0;;) {
            char c = 0;
            if (!next(c)) return failed(open, "it never ends");
            if (c == '>' && brackets >= 2) break;
            brackets = c == ']' ? brackets + 1 : 0;
        }
        if (in_array_) fmt::format_to(std::back_inserter(outline_.text), "{} {} ", text, position_ - 3);
        go_on_with_text();
        return {};
    }

    Result<void> skip_comment(std::size_t open, std::size_t begin) {
        outline_.text.resize(begin);
        for (int hyphens = 0;;) {
            char c = 0;
            if (!next(c)) return failed(open, "the comment never ends");
            if (c == '>' && hyphens >= 2) break;
            hyphens = c == '-' ? hyphens + 1 : 0;
        }
        go_on_with_text();
        return {};
    }

    Result<void> sort_tag(std::size_t open, std::size_t begin) {
        const auto tag = std::string_view(outline_.text).substr(begin);
        if (tag.starts_with("<!")) return failed(open, "a declaration that is none of XML's");
        if (tag.starts_with("<?")) {
            outline_.text.resize(begin);
            return {};
        }
        outline_.tags.emplace_back(begin, open);
        if (tag.starts_with("</")) {
            outline_.ended = outline_.ended || tag.starts_with("</VTKFile");
            if (tag.starts_with("</DataArray") || tag.starts_with("</Array")) in_array_ = false;
            go_on_with_text();
            return {};
        }
        if (tag.ends_with("/>")) {
            go_on_with_text();
            return {};
        }
        constexpr std::string_view appended = "<AppendedData";
        if (tag.starts_with(appended) && (tag[appended.size()] == '>' || is_space(tag[appended.size()]))) {
            outline_.appended = position_;
            outline_.ended = true;
            outline_.text += "</AppendedData></VTKFile>";
            return {};
        }
        in_array_ = in_array_ || tag.starts_with("<DataArray") || tag.starts_with("<Array");
        text_begin_ = position_;
        return {};
    }

    const ByteSource& source_;
    const Progress& progress_;
    Outline outline_;
    Scratch scratch_;
    std::string_view window_;
    std::size_t begin_ = 0, position_ = 0;
    std::optional<std::size_t> text_begin_;
    bool in_array_ = false;
    std::optional<Error> error_;
};

} // namespace

std::size_t Outline::position_of(std::size_t in_text) const {
    auto behind = std::upper_bound(tags.begin(), tags.end(), in_text,
                                   [](std::size_t at, const auto& tag) { return at < tag.first; });
    return behind == tags.begin() ? 0 : std::prev(behind)->second;
}

Result<Outline> outline_of(const ByteSource& source, const Progress& progress) { return Walk(source, progress).run(); }

} // namespace isotet::io::vtk_xml
