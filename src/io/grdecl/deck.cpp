// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/grdecl/deck.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/core.h>

#include "io/files/escape.hpp"
#include "io/files/pace.hpp"
#include "io/files/text_scanner.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::grdecl {

namespace {

constexpr std::size_t max_included = 1000, max_depth = 32;

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
    return std::ranges::find(words, word) != words.end();
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

/// The end of a line behind `at`.
std::size_t behind_line(std::string_view text, std::size_t at) {
    const std::size_t end = text.find('\n', at);
    return end == std::string_view::npos ? text.size() : end + 1;
}

/// Goes behind space and comments.
std::size_t skip_space(std::string_view text, std::size_t at) {
    while (at < text.size()) {
        if (is_space(text[at])) ++at;
        else if (text.substr(at, 2) == "--") at = behind_line(text, at);
        else break;
    }
    return at;
}

/// Where the '/' is that ends a record: neither in a comment nor between quotation marks. npos: there is none.
std::size_t end_of_record(std::string_view text, std::size_t from) {
    for (std::size_t at = from;;) {
        const std::size_t slash = text.find('/', at);
        if (slash == std::string_view::npos) return slash;
        // What opens before it on its line may hold it.
        const std::size_t line = std::max(text.rfind('\n', slash) + 1, at);
        std::size_t i = line;
        while (i < slash && text[i] != '\'' && text[i] != '"' && text.substr(i, 2) != "--") ++i;
        if (i == slash) return slash;
        const std::size_t closed = text[i] == '-' ? std::string_view::npos : text.find(text[i], i + 1);
        const std::size_t next = behind_line(text, i);
        at = closed < next ? closed + 1 : next;
    }
}

/// Goes behind several records, the last of which is empty.
std::size_t behind_records(std::string_view text, std::size_t at) {
    for (bool empty = false; at < text.size() && !empty;) {
        at = skip_space(text, at);
        const std::size_t end = end_of_record(text, at);
        empty = end == at;
        at = behind_line(text, end == std::string_view::npos ? text.size() : end);
    }
    return at;
}

/// The numbers of lists and their repeat counts begin so.
bool begins_number(std::string_view text, std::size_t at) {
    if (at < text.size() && (text[at] == '+' || text[at] == '-')) ++at;
    if (at < text.size() && text[at] == '.') ++at;
    return at < text.size() && text[at] >= '0' && text[at] <= '9';
}

/// The name of an included file: between quotation marks, else a word.
std::string_view included_name(std::string_view text, std::size_t& at) {
    if (at < text.size() && (text[at] == '\'' || text[at] == '"')) {
        const std::size_t end = std::min(text.find(text[at], at + 1), behind_line(text, at));
        const std::string_view name = text.substr(at + 1, end - at - 1);
        at = std::min(end + 1, text.size());
        return name;
    }
    const std::size_t begin = at;
    while (at < text.size() && !is_space(text[at])) ++at;
    return text.substr(begin, at - begin);
}

class DeckReader {
public:
    DeckReader(const OpenIncluded& open, const Progress& progress) : open_(open), progress_(progress) {}

    Result<void> read(const DeckText& file) {
        if (open_files_.size() >= max_depth || std::ranges::find(open_files_, file.path) != open_files_.end())
            return broken(file.path, "includes itself, or files too deep in one another");
        open_files_.push_back(file.path);
        auto result = read_text(file);
        open_files_.pop_back();
        return result;
    }

    Deck take() { return std::move(deck_); }

private:
    Result<void> read_text(const DeckText& file) {
        const std::string_view text = file.text;
        Pace pace(progress_, text.size());
        std::size_t at = skip_space(text, 0);
        while (at < text.size() && !ended_) {
            if (!pace.goes_on(at)) return Pace::cancelled();
            std::size_t end = at;
            while (end < text.size() && !is_space(text[end]) && text[end] != '/') ++end;
            if (!is_letter(text[at])) { // no keyword: a record of names, or what follows a '/'
                at = skip_space(text, behind_line(text, at));
                continue;
            }
            Record record{std::string(text.substr(at, end - at)), file, {}};
            std::ranges::transform(record.keyword, record.keyword.begin(),
                                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
            auto next = read_keyword(std::move(record), skip_space(text, end), behind_line(text, end));
            if (!next) return next.error();
            at = skip_space(text, *next);
        }
        return {};
    }

    /// `at`       behind the keyword   `line`   behind its line
    /// Returns    where the next keyword may begin
    Result<std::size_t> read_keyword(Record record, std::size_t at, std::size_t line) {
        const std::string_view keyword = record.keyword, text = record.file.text;
        if (enter_section(keyword)) return line;
        if (!skipped_until_.empty()) {
            if (keyword == skipped_until_) skipped_until_ = {};
            return line;
        }
        if (keyword == "INCLUDE") return include(record, at);
        if (is_one_of(keyword, {"BOX", "CARFIN", "RADFIN", "REFINE"})) {
            deck_.operations.insert(record.keyword);
            skipped_until_ = keyword == "BOX" ? "ENDBOX" : "ENDFIN";
            return line;
        }
        if (is_one_of(keyword, {"EQUALS", "ADD", "MULTIPLY", "COPY", "COPYBOX", "MINVALUE", "MAXVALUE", "OPERATE",
                                "EQUALREG", "ADDREG", "MULTIREG", "COPYREG", "OPERATER"})) {
            deck_.operations.insert(record.keyword);
            return behind_records(text, at);
        }
        const bool words = is_one_of(keyword, {"SPECGRID", "DIMENS", "GRIDUNIT", "MAPUNITS"});
        if (!words && (in_tables_ || !begins_number(text, at))) return line;
        const std::size_t end = end_of_record(text, at);
        record.body = text.substr(at, end == std::string_view::npos ? 0 : end - at);
        if (end == std::string_view::npos) return record.fail("has no '/' at its end: the file is cut short");
        deck_.records.push_back(std::move(record));
        return behind_line(text, end);
    }

    bool enter_section(std::string_view keyword) {
        if (is_one_of(keyword, {"SUMMARY", "SCHEDULE", "END"})) ended_ = true;
        else if (keyword == "PROPS") in_tables_ = true;
        else if (is_one_of(keyword, {"RUNSPEC", "GRID", "EDIT", "REGIONS", "SOLUTION"})) in_tables_ = false;
        else return false;
        return true;
    }

    Result<std::size_t> include(const Record& record, std::size_t at) {
        const std::string_view name = included_name(record.file.text, at);
        if (in_tables_) return at;
        if (++included_ > max_included) return record.fail(fmt::format("is more than {} files", max_included));
        const auto file = open_(name);
        if (!file) return file.error();
        if (auto done = read(*file); !done) return done.error();
        return behind_line(record.file.text, at);
    }

    const OpenIncluded& open_;
    const Progress& progress_;
    Deck deck_;
    std::vector<std::string> open_files_;
    std::size_t included_ = 0;
    std::string_view skipped_until_; ///< of a box, or a local refinement
    bool in_tables_ = false, ended_ = false;
};

} // namespace

Error Record::fail(std::string_view what) const {
    const auto line = body.data() ? 1 + std::count(file.text.data(), body.data(), '\n') : 0;
    if (!body.data()) return broken(file.path, fmt::format("{}: {}", escaped(keyword), what));
    return broken(file.path, fmt::format("line {}: {}: {}", line, escaped(keyword), what));
}

Result<Deck> read_deck(const DeckText& text, const OpenIncluded& open, const Progress& progress) {
    DeckReader reader(open, progress);
    if (auto read = reader.read(text); !read) return read.error();
    return reader.take();
}

} // namespace isotet::io::grdecl
